//! What is kept of row planes on the device.

use super::bands::Slice;
use super::context::Context;
use super::storage::{Storage, entries_of};
use layout::{FanBlock, TILE_EDGE, binding};
use needs::{Needs, Shading};
use planes::Fan;
use shaders::compose::PlaneStep;

/// The buffers of row planes.
#[derive(Debug)]
pub(super) struct PlaneBuffers {
    fan: Storage,
    bands: Storage,
    layers: Storage,
    samples: Storage,
    means: Storage,
    errors: Storage,
    pub(super) open: Storage,
    pub(super) variation: Storage,
    /// What each row of tiles found, since a cast began.
    pub(super) found: Storage,
}

impl PlaneBuffers {
    pub(super) fn new(context: &Context) -> Self {
        let storage = |label| Storage::new(context, label);
        Self {
            fan: storage("the grid of planes"),
            bands: storage("bands of planes"),
            layers: storage("layers of planes"),
            samples: storage("samples of planes"),
            means: storage("means of planes"),
            errors: storage("errors of means"),
            open: storage("blocks that see farther"),
            variation: storage("variation of the tables"),
            found: storage("what planes found"),
        }
    }

    /// Writes what a slice is made of, and makes room for what is kept of it.
    pub(super) fn prepare(
        &mut self,
        context: &Context,
        needs: &Needs,
        (fan, block): (&Fan, &FanBlock),
        slice: &Slice,
    ) {
        let mut words: Vec<u32> = bytemuck::cast_slice(std::slice::from_ref(block)).to_vec();
        words.extend(fan.offsets().map(f32::to_bits));
        self.fan.write(context, &words);
        self.bands.write(context, &slice.bands);
        self.layers.write(context, &slice.layers);
        let gradient = if needs.shading == Shading::Plain { 0 } else { 3 };
        let columns = 4 * slice.columns as u64;
        self.samples.reserve(context, columns * (1 + u64::from(needs.spreads) + gradient));
        self.means.reserve(context, columns * (4 + gradient));
        self.errors.reserve(context, 4 * slice.blocks as u64);
        let blocks = u64::from(TILE_EDGE * block.bands * block.views * block.blocks);
        self.open.reserve(context, 4 * blocks);
    }

    /// What each step reads and writes of them.
    pub(super) fn entries(&self, step: PlaneStep) -> Vec<wgpu::BindGroupEntry<'_>> {
        let mut all = vec![
            (binding::FAN, &self.fan),
            (binding::BANDS, &self.bands),
            (binding::PLANE_LAYERS, &self.layers),
        ];
        all.extend(match step {
            PlaneStep::Fill => {
                vec![
                    (binding::SAMPLES, &self.samples),
                    (binding::ERRORS, &self.errors),
                    (binding::OPEN, &self.open),
                    (binding::FOUND, &self.found),
                ]
            }
            PlaneStep::Means => vec![(binding::SAMPLES, &self.samples), (binding::MEANS, &self.means)],
            PlaneStep::Errors => vec![
                (binding::SAMPLES, &self.samples),
                (binding::MEANS, &self.means),
                (binding::ERRORS, &self.errors),
                (binding::VARIATION, &self.variation),
            ],
            PlaneStep::Sweep => vec![
                (binding::MEANS, &self.means),
                (binding::ERRORS, &self.errors),
                (binding::OPEN, &self.open),
            ],
        });
        entries_of(all).collect()
    }
}
