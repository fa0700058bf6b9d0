//! The pictures on the device, and what becomes of them.

use super::arena::{Arena, COLOUR_BYTES, Plan, Room};
use super::context::Context;
use super::finish::Finishing;
use super::kept::{CodeBuffers, KeptCodes, code_room, packed, unpacked};
use super::layers::Laying;
use super::readback::Readback;
use super::show::Showing;
use super::storage::Stretch;
use super::view::ViewBuffers;
use crate::device::{Codes, DeviceError, DevicePicture, FinishJob, ShowJob};
use crate::present::Raster;
use protocol::CodesAt;
use rayon::prelude::*;
use std::any::Any;
use std::sync::Arc;

/// Bytes of codes on their way to the host together: those of 93 pictures of 800 × 600 pixels, or of five of 4K.
const MOST_CODE_BYTES: u64 = 1 << 27;

/// All of them, with the kernels that present.
#[derive(Debug)]
pub(super) struct Pictures {
    pub(super) arenas: Vec<Arena>,
    plan: Plan,
    views: Vec<ViewBuffers>,
    pixels_back: Readback,
    code_buffers: CodeBuffers,
    codes_back: Readback,
    showing: Showing,
    laying: Laying,
    finishing: Finishing,
}

impl Pictures {
    pub(super) fn new(context: &Context) -> Self {
        Self {
            arenas: Vec::new(),
            plan: Plan::new(context.most_bound_bytes()),
            views: Vec::new(),
            pixels_back: Readback::new(),
            code_buffers: CodeBuffers::default(),
            codes_back: Readback::new(),
            showing: Showing::new(context),
            laying: Laying::new(context),
            finishing: Finishing::new(),
        }
    }

    /// Makes room for pictures of these rasters, the first at an index and the others behind it. What is there stays, but for
    /// pictures that grow.
    pub(super) fn make_room(
        &mut self,
        context: &Context,
        first: usize,
        rasters: impl ExactSizeIterator<Item = [u32; 2]>,
    ) {
        let count = self.views.len().max(first + rasters.len());
        self.views.resize_with(count, || ViewBuffers::new(context));
        for (view, raster) in self.views[first..].iter_mut().zip(rasters) {
            view.raster = raster;
            view.room = Some(self.plan.room(view.room, view.pixel_count()));
        }
        self.arenas.resize_with(self.plan.used.len(), || Arena::new(context));
        for (arena, &pixels) in self.arenas.iter_mut().zip(&self.plan.used) {
            arena.grow(context, pixels);
        }
    }

    /// Where a picture lies, for which room was made.
    pub(super) fn room(&self, picture: usize) -> Room {
        self.views[picture].room.expect("room is made before a picture is cast")
    }

    /// Makes what is shown of what was cast. Whether any of it is behind, picture by picture.
    pub(super) fn show(&mut self, context: &Context, jobs: &[ShowJob]) -> Result<Vec<bool>, DeviceError> {
        self.showing.show(context, &self.arenas, &mut self.views, jobs)
    }

    /// The colours of some pictures.
    pub(super) fn read(
        &mut self,
        context: &Context,
        pictures: &[DevicePicture],
    ) -> Result<Vec<Vec<f32>>, DeviceError> {
        let Self { arenas, views, pixels_back, .. } = self;
        let colours: Vec<Stretch> =
            pictures.iter().map(|&picture| colours_of(arenas, views, picture)).collect();
        let mut encoder = context.new_encoder();
        pixels_back.begin(context, colours.iter().map(|colours| colours.bytes).sum());
        colours.iter().for_each(|colours| pixels_back.copy(&mut encoder, colours));
        context.submit(encoder);
        pixels_back.read(context, |mut bytes| {
            let own = |of: &Stretch| bytes.split_off(..of.bytes as usize).expect("each has so many bytes");
            let of_each: Vec<&[u8]> = colours.iter().map(own).collect();
            of_each.into_par_iter().map(bytemuck::pod_collect_to_vec).collect()
        })
    }

    /// The codes of some pictures, where they are wanted.
    pub(super) fn codes(
        &mut self,
        context: &Context,
        jobs: &[FinishJob],
        at: CodesAt,
    ) -> Result<Vec<Codes>, DeviceError> {
        let mut codes = Vec::with_capacity(jobs.len());
        let mut left = jobs;
        while !left.is_empty() {
            let (some, rest) = left.split_at(fitting(left));
            codes.extend(self.some_codes(context, some, at)?);
            left = rest;
        }
        Ok(codes)
    }

    /// Those of so many that there is room for all on the way to the host.
    fn some_codes(
        &mut self,
        context: &Context,
        jobs: &[FinishJob],
        at: CodesAt,
    ) -> Result<Vec<Codes>, DeviceError> {
        let Self { arenas, views, code_buffers, codes_back, laying, finishing, .. } = self;
        let mut encoder = context.new_encoder();
        let kept = code_buffers.room(context, jobs.iter().map(|job| job.raster));
        for (place, (job, codes)) in jobs.iter().zip(&kept).enumerate() {
            let colours = colours_of(arenas, views, job.picture);
            let picture = match job.layers.is_empty() {
                true => colours,
                false => laying.note((context, &mut encoder), place, &colours, job),
            };
            finishing.note((context, &mut encoder), place, (&picture, codes), job);
        }
        let on_host = match at.host {
            true => Some(to_host(context, codes_back, encoder, &kept)?),
            false => {
                context.submit(encoder);
                None
            }
        };
        let mut on_host = on_host.into_iter().flatten();
        let both = |kept| Codes { host: on_host.next(), device: at.device.then(|| shared(kept)) };
        Ok(kept.into_iter().map(both).collect())
    }

    /// The codes of a picture that the host has made, where they are wanted.
    pub(super) fn codes_of_host(
        &mut self,
        context: &Context,
        codes: Vec<u8>,
        raster: Raster,
        at: CodesAt,
    ) -> Codes {
        let host = at.host.then(|| codes.clone());
        let device = at.device.then(|| {
            let kept = self.code_buffers.room(context, std::iter::once(raster)).remove(0);
            let Stretch { buffer, offset, .. } = kept.stretch();
            context.queue.write_buffer(buffer, offset, &packed(codes, raster));
            shared(kept)
        });
        Codes { host, device }
    }
}

/// What leaves this module as codes on the device.
fn shared(kept: KeptCodes) -> Arc<dyn Any + Send + Sync> {
    Arc::new(kept)
}

/// Submits what makes some codes, and brings them to the host.
fn to_host(
    context: &Context,
    codes_back: &mut Readback,
    mut encoder: wgpu::CommandEncoder,
    kept: &[KeptCodes],
) -> Result<Vec<Vec<u8>>, DeviceError> {
    codes_back.begin(context, kept.iter().map(|codes| codes.stretch().bytes).sum());
    kept.iter().for_each(|codes| codes_back.copy(&mut encoder, &codes.stretch()));
    context.submit(encoder);
    codes_back.read(context, |mut bytes| {
        let own = |of: &KeptCodes| {
            let bytes = bytes.split_off(..of.stretch().bytes as usize);
            (bytes.expect("each has so many bytes"), of.raster)
        };
        let of_each: Vec<(&[u8], Raster)> = kept.iter().map(own).collect();
        of_each.into_par_iter().map(|(bytes, raster)| unpacked(bytes, raster)).collect()
    })
}

/// How many of some pictures, at least one, have codes that fit on the way to the host together.
fn fitting(jobs: &[FinishJob]) -> usize {
    let mut room = MOST_CODE_BYTES;
    let fit = jobs.iter().take_while(|job| match room.checked_sub(code_room(job.raster)) {
        Some(left) => {
            room = left;
            true
        }
        None => false,
    });
    fit.count().max(1)
}

/// The colours of a picture.
fn colours_of<'a>(arenas: &'a [Arena], views: &'a [ViewBuffers], picture: DevicePicture) -> Stretch<'a> {
    match picture {
        DevicePicture::Cast(index) => views[index].cast_colours(arenas),
        DevicePicture::Shown(index) => {
            views[index].shown.stretch(0, COLOUR_BYTES * views[index].pixel_count())
        }
    }
}
