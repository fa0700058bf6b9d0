//! What a device is asked on the way from what was cast to what is shown.

use crate::present::{Classes, Finisher, Layers, Raster};
use std::any::Any;
use std::sync::Arc;

/// A picture that a device has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DevicePicture {
    /// What was cast into this picture.
    Cast(usize),
    /// What is shown of it.
    Shown(usize),
}

/// How what is shown is made of what was cast.
#[derive(Clone, Copy, Debug)]
pub struct ShowJob {
    /// The picture; what is shown of it is kept beside it.
    pub picture: usize,
    /// Its size.
    pub raster: Raster,
    /// Its pixels that are as rays see them now; the others are reconstructed.
    pub known: Classes,
    /// Whether what was shown of it before is of the same view.
    pub has_before: bool,
    /// What any number of a pixel may change by, at most; None if it may by all.
    pub most_change: Option<f32>,
}

/// A picture as codes.
#[derive(Clone, Copy)]
pub struct FinishJob<'a> {
    /// The picture.
    pub picture: DevicePicture,
    /// Its size.
    pub raster: Raster,
    /// What is laid over it first.
    pub layers: &'a Layers,
    /// The view that it is of: each has a finisher of its own, always the same.
    pub view: usize,
    /// What makes codes of it.
    pub finisher: &'a Finisher,
}

/// The codes of a picture: red, green and blue of each pixel, rows from the top.
pub struct Codes {
    /// In main memory, where they are wanted there.
    pub host: Option<Vec<u8>>,
    /// On the device, where they are wanted there and it can keep them.
    pub device: Option<Arc<dyn Any + Send + Sync>>,
}

impl Codes {
    /// Those in main memory alone.
    pub(super) fn on_host(codes: Vec<u8>) -> Self {
        Self { host: Some(codes), device: None }
    }
}
