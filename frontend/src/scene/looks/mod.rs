//! The library of looks: which of them fits a volume, and what it shows of it.

mod choice;
mod ct;
mod draft;
mod fitted;
mod histogram;
mod labels;
mod made;
mod name;
mod reading;
mod values;
mod wish;

pub use choice::{LookChoice, Verdict, choose, verdict};
pub use made::{Grid, make};
pub use name::LookName;
pub use reading::read_values;
pub use values::Values;
pub use wish::{LookWish, WishedLook};

#[cfg(test)]
mod tests;
