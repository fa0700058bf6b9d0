//! The pictures on the device, and what becomes of them.

use super::context::Context;
use super::finish::Finishing;
use super::layers::Laying;
use super::readback::Readback;
use super::show::Showing;
use super::storage::Storage;
use super::view::ViewBuffers;
use crate::device::{DeviceError, DevicePicture, FinishJob, ShowJob};

/// All of them, with the kernels that present.
#[derive(Debug)]
pub(super) struct Pictures {
    pub(super) views: Vec<ViewBuffers>,
    pixels_back: Readback,
    showing: Showing,
    laying: Laying,
    finishing: Finishing,
}

impl Pictures {
    pub(super) fn new(context: &Context) -> Self {
        Self {
            views: Vec::new(),
            pixels_back: Readback::new(),
            showing: Showing::new(context),
            laying: Laying::new(context),
            finishing: Finishing::new(context),
        }
    }

    /// Makes room for so many pictures.
    pub(super) fn make_room(&mut self, context: &Context, pictures: usize) {
        self.views.resize_with(self.views.len().max(pictures), || ViewBuffers::new(context));
    }

    /// Makes what is shown of what was cast. Whether any of it is behind.
    pub(super) fn show(&mut self, context: &Context, job: &ShowJob) -> Result<bool, DeviceError> {
        self.showing.show(context, &mut self.views[job.picture], job)
    }

    /// The colours of a picture.
    pub(super) fn read(
        &mut self,
        context: &Context,
        picture: DevicePicture,
    ) -> Result<Vec<f32>, DeviceError> {
        let (colours, pixels) = colours_of(&self.views, picture);
        let mut encoder = context.new_encoder();
        self.pixels_back.copy(context, &mut encoder, &colours.buffer, 16 * pixels as u64);
        context.run(encoder)?;
        self.pixels_back.read(context, 4 * pixels)
    }

    /// The codes of a picture.
    pub(super) fn codes(&mut self, context: &Context, job: &FinishJob) -> Result<Vec<u8>, DeviceError> {
        let (colours, _) = colours_of(&self.views, job.picture);
        let marked = (!job.layers.is_empty()).then(|| self.laying.lay(context, colours, job));
        self.finishing.codes(context, marked.unwrap_or(colours), job)
    }
}

/// The colours of a picture, and how many.
fn colours_of(views: &[ViewBuffers], picture: DevicePicture) -> (&Storage, usize) {
    match picture {
        DevicePicture::Cast(index) => (&views[index].pixels, views[index].pixel_count()),
        DevicePicture::Shown(index) => (&views[index].shown, views[index].pixel_count()),
    }
}
