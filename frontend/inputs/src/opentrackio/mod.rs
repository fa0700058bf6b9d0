//! OpenTrackIO 1.0.1: camera poses of SMPTE's RIS project, as JSON or CBOR in datagrams.

pub mod packet;
pub mod sample;
mod segments;

pub(crate) use segments::Segments;
