//! What is kept of row planes on the device.

use super::bands::Slice;
use super::context::Context;
use super::storage::{Storage, entries_of};
use layout::{FanBlock, TILE_EDGE, binding};
use needs::{Compositing, Needs};
use planes::Fan;
use shaders::compose::PlaneStep;

/// Bytes of gradients that are kept of a place.
fn bytes_of_gradients(needs: &Needs) -> u64 {
    match (needs.reads_gradients(), needs.shading.has_detail()) {
        (false, _) => 0,
        (true, false) => 12,
        (true, true) => 36,
    }
}

fn bytes_of_sample(needs: &Needs) -> u64 {
    4 * (1 + u64::from(needs.spreads)) + bytes_of_gradients(needs)
}

fn bytes_of_mean(needs: &Needs) -> u64 {
    16 + bytes_of_gradients(needs)
}

/// Bytes that the largest buffer keeps of a column.
pub(super) fn bytes_of_column(needs: &Needs) -> u64 {
    bytes_of_sample(needs).max(if needs.is_by_pixel() { 0 } else { bytes_of_mean(needs) })
}

/// The buffers of row planes.
#[derive(Debug)]
pub(super) struct PlaneBuffers {
    fan: Storage,
    bands: Storage,
    layers: Storage,
    samples: Storage,
    means: Storage,
    errors: Storage,
    factors: Storage,
    pub(super) open: Storage,
    most_important: Storage,
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
            factors: storage("what enhancers make of planes"),
            open: storage("blocks that see farther"),
            most_important: storage("the most important so far"),
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
        self.factors.write_if_any(context, &slice.factors);
        let columns = slice.columns as u64;
        self.samples.reserve(context, columns * bytes_of_sample(needs));
        if !needs.is_by_pixel() {
            self.means.reserve(context, columns * bytes_of_mean(needs));
        }
        self.errors.reserve(context, 4 * slice.blocks as u64);
        let blocks = u64::from(TILE_EDGE * block.bands * block.views * block.blocks);
        self.open.reserve(context, 4 * blocks);
        if needs.compositing != Compositing::Over && block.sweeps == 0 {
            self.most_important.reserve(context, 4 * blocks * u64::from(TILE_EDGE));
        }
    }

    /// What each step reads and writes of them.
    pub(super) fn entries(&self, step: PlaneStep, needs: &Needs) -> Vec<wgpu::BindGroupEntry<'_>> {
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
            PlaneStep::Errors if needs.is_by_pixel() => vec![
                (binding::SAMPLES, &self.samples),
                (binding::FACTORS, &self.factors),
                (binding::ERRORS, &self.errors),
                (binding::VARIATION, &self.variation),
            ],
            PlaneStep::Errors => vec![
                (binding::SAMPLES, &self.samples),
                (binding::MEANS, &self.means),
                (binding::ERRORS, &self.errors),
                (binding::VARIATION, &self.variation),
            ],
            PlaneStep::Sweep => {
                let kept = if needs.is_by_pixel() {
                    (binding::SAMPLES, &self.samples)
                } else {
                    (binding::MEANS, &self.means)
                };
                vec![kept, (binding::ERRORS, &self.errors), (binding::OPEN, &self.open)]
            }
        });
        if step == PlaneStep::Sweep && needs.compositing != Compositing::Over {
            all.push((binding::MOST_IMPORTANT, &self.most_important));
        }
        entries_of(all).collect()
    }
}
