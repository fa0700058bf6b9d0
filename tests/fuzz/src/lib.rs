//! What the fuzz targets share: formats and protocols of inputs, a limit of memory, and checksums made right.

pub mod budget;
pub mod format;
#[path = "../../../frontend/inputs/tests/protocols/mod.rs"]
pub mod protocols;
#[path = "../../../backend/bricks/src/store/resign.rs"]
pub mod resign;
