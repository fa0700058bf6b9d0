//! What the fuzz targets share: formats of inputs, a limit of memory, and checksums made right.

pub mod budget;
pub mod format;
#[path = "../../../backend/bricks/src/store/resign.rs"]
pub mod resign;
