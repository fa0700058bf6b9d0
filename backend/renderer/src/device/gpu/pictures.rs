//! The pictures on the device, and what becomes of them.

use super::context::Context;
use super::finish::{Finishing, code_bytes, unpacked};
use super::layers::Laying;
use super::readback::Readback;
use super::show::Showing;
use super::storage::Storage;
use super::view::ViewBuffers;
use crate::device::{DeviceError, DevicePicture, FinishJob, ShowJob};
use rayon::prelude::*;

/// Bytes of codes on their way to the host together: those of 64 pictures of 800 × 600 pixels, or of two of 4K.
const MOST_CODE_BYTES: u64 = 1 << 27;

/// All of them, with the kernels that present.
#[derive(Debug)]
pub(super) struct Pictures {
    pub(super) views: Vec<ViewBuffers>,
    pixels_back: Readback,
    codes_back: Readback,
    showing: Showing,
    laying: Laying,
    finishing: Finishing,
}

impl Pictures {
    pub(super) fn new(context: &Context) -> Self {
        Self {
            views: Vec::new(),
            pixels_back: Readback::new(),
            codes_back: Readback::new(),
            showing: Showing::new(context),
            laying: Laying::new(context),
            finishing: Finishing::new(context),
        }
    }

    /// Makes room for so many pictures.
    pub(super) fn make_room(&mut self, context: &Context, pictures: usize) {
        self.views.resize_with(self.views.len().max(pictures), || ViewBuffers::new(context));
    }

    /// Makes what is shown of what was cast. Whether any of it is behind, picture by picture.
    pub(super) fn show(&mut self, context: &Context, jobs: &[ShowJob]) -> Result<Vec<bool>, DeviceError> {
        self.showing.show(context, &mut self.views, jobs)
    }

    /// The colours of a picture.
    pub(super) fn read(
        &mut self,
        context: &Context,
        picture: DevicePicture,
    ) -> Result<Vec<f32>, DeviceError> {
        let (colours, pixels) = colours_of(&self.views, picture);
        let mut encoder = context.new_encoder();
        let bytes = 16 * pixels as u64;
        self.pixels_back.begin(context, bytes);
        self.pixels_back.copy(&mut encoder, &colours.buffer, bytes);
        context.submit(encoder);
        self.pixels_back.items(context)
    }

    /// The codes of some pictures.
    pub(super) fn codes(
        &mut self,
        context: &Context,
        jobs: &[FinishJob],
    ) -> Result<Vec<Vec<u8>>, DeviceError> {
        let mut codes = Vec::with_capacity(jobs.len());
        let mut left = jobs;
        while !left.is_empty() {
            let (some, rest) = left.split_at(fitting(left));
            codes.extend(self.some_codes(context, some)?);
            left = rest;
        }
        Ok(codes)
    }

    /// Those of so many that there is room for all on the way.
    fn some_codes(&mut self, context: &Context, jobs: &[FinishJob]) -> Result<Vec<Vec<u8>>, DeviceError> {
        let Self { views, codes_back, laying, finishing, .. } = self;
        let mut encoder = context.new_encoder();
        codes_back.begin(context, jobs.iter().map(code_bytes).sum());
        for (place, job) in jobs.iter().enumerate() {
            let (colours, _) = colours_of(views, job.picture);
            let picture = match job.layers.is_empty() {
                true => colours,
                false => laying.note((context, &mut encoder), place, colours, job),
            };
            let words = finishing.note((context, &mut encoder), place, picture, job);
            codes_back.copy(&mut encoder, words, code_bytes(job));
        }
        context.submit(encoder);
        codes_back.read(context, |mut words| {
            let of_each: Vec<&[u8]> = jobs
                .iter()
                .map(|job| words.split_off(..code_bytes(job) as usize).expect("each has so many bytes"))
                .collect();
            of_each.into_par_iter().map(unpacked).collect()
        })
    }
}

/// How many of some pictures, at least one, have codes that fit on the way to the host together.
fn fitting(jobs: &[FinishJob]) -> usize {
    let mut room = MOST_CODE_BYTES;
    let fit = jobs.iter().take_while(|job| match room.checked_sub(code_bytes(job)) {
        Some(left) => {
            room = left;
            true
        }
        None => false,
    });
    fit.count().max(1)
}

/// The colours of a picture, and how many.
fn colours_of(views: &[ViewBuffers], picture: DevicePicture) -> (&Storage, usize) {
    match picture {
        DevicePicture::Cast(index) => (&views[index].pixels, views[index].pixel_count()),
        DevicePicture::Shown(index) => (&views[index].shown, views[index].pixel_count()),
    }
}
