//! Pixels whose scalars go through the rays' own code: importance, enhancers, materials, detail and debug views.

use crate::places::{Place, Places};
use crate::slab::{EMPTY, LANES};
use crate::sweep::Sweep;
use crate::view_row::ViewRow;
use lanes::*;
use twin::composite::Accumulated;
use twin::gradient::Gradients;
use twin::vector::Vec3;
use twin::{Cell, RayOnItsWay, add_cell, still_to_come};

/// What eight pixels meet at one end of a cell.
struct End {
    scalars: [f32; LANES],
    spreads: [f32; LANES],
    /// Three levels of three axes.
    gradients: [[f32; LANES]; 9],
}

impl End {
    fn gradients(&self, lane: usize) -> Gradients<f32> {
        let at = |level: usize| Vec3([0, 1, 2].map(|axis| self.gradients[3 * level + axis][lane]));
        Gradients { at: at(0), coarse: at(1), coarsest: at(2) }
    }
}

impl Sweep<'_> {
    /// Adds what the slab shows to a block of pixels, one by one. Whether nothing that follows shows there.
    #[inline(never)]
    pub(crate) fn add_pixels<S: Simd>(
        &self,
        simd: S,
        view: &mut ViewRow,
        places: &Places,
        block: usize,
    ) -> bool {
        outlined!(simd => {
        let (slab, casting) = (self.slab, self.steep.casting);
        let at = block * LANES;
        let mut fronts = [Accumulated::NOTHING; LANES];
        let mut ways: [Option<RayOnItsWay>; LANES] = [None; LANES];
        for (lane, front) in fronts.iter_mut().enumerate() {
            *front = front_of(view, at + lane);
        }
        let mut is_open = [true; LANES];
        let mut front_end: Option<(usize, End)> = None;
        for cell in 0..slab.cells() {
            let entry = places.middles[cell].entry + at as i64;
            let ends = [&places.depths[cell], &places.depths[cell + 1]];
            let is_within = |place: &Place| {
                let entry = place.entry + at as i64;
                entry >= 0 && entry as usize + LANES < slab.stride
            };
            if !(is_within(&places.middles[cell]) && ends.into_iter().all(is_within)) {
                continue;
            }
            let first = cell * slab.blocks_across() + entry as usize / LANES;
            let next = (first + 1).min(slab.errors.len() - 1);
            if slab.errors[first].max(slab.errors[next]) == EMPTY {
                continue;
            }
            let near = match front_end {
                Some((depth, end)) if depth == cell => end,
                _ => self.end_of(simd, ends[0], cell, at),
            };
            let far = self.end_of(simd, ends[1], cell + 1, at);
            for lane in 0..LANES {
                let z = self.passed(view, cell, at + lane);
                let is_met = (near.scalars[lane] + far.scalars[lane]).is_finite() && z[0] > z[1];
                is_open[lane] &= still_to_come(casting, fronts[lane]) >= casting.scene.termination;
                if !(is_met && is_open[lane]) {
                    continue;
                }
                let way = ways[lane].get_or_insert_with(|| {
                    let rays = &self.fan.rays[self.view];
                    RayOnItsWay::of_pixel(casting, rays, (at + lane) as u32, self.row)
                });
                let depths = [slab.depths[cell].z, slab.depths[cell + 1].z];
                let met = Cell {
                    t: depths.map(|z| way.t_at(z as f32)),
                    within: z.map(|z| way.t_at(z)),
                    scalars: [near.scalars[lane], far.scalars[lane]],
                    spreads: [near.spreads[lane], far.spreads[lane]],
                    gradients: [near.gradients(lane), far.gradients(lane)],
                };
                fronts[lane] = add_cell(casting, way, fronts[lane], &met);
            }
            front_end = Some((cell + 1, far));
        }
        let mut is_closed = true;
        for (lane, front) in fronts.into_iter().enumerate() {
            is_closed &= still_to_come(casting, front) < casting.scene.termination;
            keep(view, at + lane, front);
        }
        is_closed
        })
    }

    /// From where to where a pixel's ray is in the volume between two depths, z.
    fn passed(&self, view: &ViewRow, cell: usize, pixel: usize) -> [f32; 2] {
        let [front, back] = [cell, cell + 1].map(|depth| self.slab.depths[depth].z as f32);
        if !self.slab.is_outer {
            return [front, back];
        }
        [view.ends[0][pixel].min(front), view.ends[1][pixel].max(back)]
    }

    /// What eight pixels meet at a depth.
    #[inline(always)]
    fn end_of<S: Simd>(&self, simd: S, place: &Place, depth: usize, at: usize) -> End {
        let slab = self.slab;
        let entry = place.entry + at as i64;
        let mut end = End {
            scalars: self.fetch(simd, &slab.scalars, (depth, 0), place, entry, (1, 0)).to_array(),
            spreads: [0.0; LANES],
            gradients: [[0.0; LANES]; 9],
        };
        if !slab.spreads.is_empty() {
            end.spreads = self.fetch(simd, &slab.spreads, (depth, 0), place, entry, (1, 0)).to_array();
        }
        let rows = slab.gradient_rows;
        for row in 0..rows {
            end.gradients[row] =
                self.fetch(simd, &slab.gradients, (depth, 0), place, entry, (rows, row)).to_array();
        }
        end
    }
}

/// What a pixel has gathered.
fn front_of(view: &ViewRow, pixel: usize) -> Accumulated<f32> {
    let [r, g, b, alpha] = [0, 1, 2, 3].map(|c| view.rgba[c][pixel]);
    Accumulated { rgb: Vec3([r, g, b]), alpha, importance: view.importance[pixel] }
}

fn keep(view: &mut ViewRow, pixel: usize, front: Accumulated<f32>) {
    let [r, g, b] = front.rgb.0;
    for (channel, value) in view.rgba.iter_mut().zip([r, g, b, front.alpha]) {
        channel[pixel] = value;
    }
    view.importance[pixel] = front.importance;
}
