//! When a driven display begins anew, shows what it has, and rests: by what its pictures err in space and in time, after
//! Frey, Sadlo, Ma and Ertl 2014 (STE). Pure: no clock, no picture, no message.
//!
//! | module | what it is |
//! | --- | --- |
//! | `rule` | what decides: errors, a rate, or a share of the rays |
//! | `control` | the course of one configuration after the other: begin, refine, show, rest |
//! | `budget` | how much of a picture fits into a tick |

mod budget;
mod control;
mod rule;

pub use budget::Budget;
pub use control::{Control, Found, News, Work};
pub use rule::{Rule, RuleError, Weights};
