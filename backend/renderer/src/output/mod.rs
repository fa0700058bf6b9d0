//! Files a person opens: PNG and EXR pictures, eye views, contact sheets.

mod atomic;
mod contact_sheet;
mod error;
mod exr;
mod eye;
mod picture;
mod png;
mod srgb;

pub use atomic::{can_write_into, write_atomically};
pub use contact_sheet::ContactSheet;
pub use error::OutputError;
pub use exr::write_exr;
pub use eye::{EyePlan, EyeView};
pub use picture::{Picture, PictureRef};
pub use png::{encode_png, write_codes, write_png};
pub use srgb::srgb_code;
#[cfg(feature = "gpu")]
pub(crate) use srgb::srgb_edges;
pub(crate) use srgb::{srgb_codes, srgb_light};
