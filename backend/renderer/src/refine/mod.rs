//! A picture that becomes finer: in which order its pixels are cast, what is shown before all are, and what that errs.
//!
//! Rays go through centres of pixels from the first on, at full quality. So none is thrown away, and the last of them
//! completes the picture that is cast without any order, to the bit.

mod around;
mod fill;
mod order;
mod temporal;

pub use fill::{Filled, fill};
pub use order::{Grain, Order, UNITS};
pub use temporal::{change_at, sparse};

use protocol::Refined;

/// Errors are added up as whole numbers of this part of a colour's 1, so that sums do not depend on their order.
pub const ERROR_UNIT: f64 = 1.0 / Refined::UNIT as f64;

/// An error of a pixel as such a number; what is no number counts as 1.
fn whole(error: f32) -> u64 {
    if error.is_finite() { (f64::from(error.max(0.0)) / ERROR_UNIT).round() as u64 } else { Refined::UNIT }
}
