//! One view's row over a slab: shifted, composited, eight pixels at a time.

use crate::Fan;
use crate::around::Around;
use crate::blocks::Blocks;
use crate::fine::Looked;
use crate::means::MetMeans;
use crate::near::Near;
use crate::need::spacing_for;
use crate::places::{Place, Places};
use crate::slab::{LANES, MEANS, NOTHING, PLAIN_ROWS, Slab, between};
use crate::steep::{Cell, Pixels, Steep, middle_of};
use crate::thick;
use crate::view_row::ViewRow;
use lanes::*;

/// One row of one view.
pub(crate) struct Sweep<'a> {
    pub(crate) fan: &'a Fan,
    pub(crate) slab: &'a Slab,
    pub(crate) view: usize,
    pub(crate) row: u32,
    /// Optical depth of a cell where the table says 1.
    pub(crate) thickness: f32,
    pub(crate) steep: Steep<'a>,
    /// The largest error of a cell's light that means may make.
    pub(crate) tolerance: f32,
    /// Whether each pixel goes through the rays' own code.
    pub(crate) is_by_pixel: bool,
    /// What the volume holds off the grid; None where nothing may be asked for there.
    pub(crate) near: Option<&'a Near<'a>>,
    /// See [`Fan::lines`].
    pub(crate) lines: [[f64; 2]; 2],
    /// Whether the fine table tells all that lies between any scalars.
    pub(crate) is_fine: bool,
}

impl Sweep<'_> {
    /// Adds what the slab shows to some blocks of a view's row, which all meet something.
    #[inline(never)]
    pub(crate) fn add<S: Simd>(&self, simd: S, view: &mut ViewRow, pixels: &Blocks, places: &mut Places) {
        outlined!(simd => {
        if pixels.is_empty() {
            return;
        }
        places.find(self.slab, self.fan, self.view);
        for block in pixels.iter() {
            let is_closed = if self.is_by_pixel {
                self.add_pixels(simd, view, places, block)
            } else {
                self.add_block(simd, view, places, block)
            };
            if is_closed {
                view.open.remove(block);
            }
        }
        })
    }

    /// Whether none of its pixels sees any farther.
    #[inline(always)]
    fn add_block<S: Simd>(&self, simd: S, view: &mut ViewRow, places: &mut Places, block: usize) -> bool {
        let slab = self.slab;
        let at = block * LANES;
        let across = slab.blocks_across();
        // The cells that show anything, one by one in bits.
        let (mut kinds, mut cells) = (NOTHING, 0u32);
        for cell in 0..slab.cells() {
            let entry = places.middles[cell].entry + at as i64;
            if entry < 0 || entry as usize + LANES + 1 > slab.stride {
                continue;
            }
            let kind = slab.kinds[cell * across + entry as usize / LANES];
            kinds |= kind;
            cells |= u32::from(kind != NOTHING) << cell;
        }
        if cells == 0 {
            return false;
        }
        let is_outer = slab.is_outer && !self.are_inside(simd, view, at);
        if kinds == MEANS && slab.gradients.is_empty() && !is_outer {
            return self.add_means(simd, view, places, at, cells);
        }
        let mut pixels = view.pixels(simd, at);
        let length = load(simd, &view.lengths, at);
        let one = f32x8::splat(simd, 1.0);
        // What the scalars at a depth look up, from the cell in front of it.
        let mut known = None;
        let mut known_alone = None;
        while cells != 0 {
            let cell = cells.trailing_zeros() as usize;
            cells &= cells - 1;
            let first = cell * across + (places.middles[cell].entry + at as i64) as usize / LANES;
            let next = (first + 1).min(slab.errors.len() - 1);
            if slab.kinds[first] != MEANS {
                // What lies behind something shows less of it.
                let seen = largest(pixels[3]);
                let apart = slab.apart[first].max(slab.apart[next]) * seen;
                if self.near.is_some() && apart > 1.0 {
                    let front = match known_alone {
                        Some((behind, front)) if behind == cell => Some(front),
                        Some(_) | None => None,
                    };
                    let reach = slab.reaches[first % across].max(slab.reaches[next % across]);
                    let met = (cell, at, spacing_for(apart, 1.0), reach);
                    let mut held = pixels;
                    known_alone = self.add_alone(simd, &mut held, view, places, met, front);
                    pixels = held;
                    if self.steep.are_closed(simd, pixels[3]) {
                        break;
                    }
                    continue;
                }
                if slab.errors[first].max(slab.errors[next]) * seen > self.tolerance {
                    let looks = match known {
                        Some((behind, looks)) if behind == cell => Some(looks),
                        Some(_) | None => None,
                    };
                    let mut held = pixels;
                    known = self.add_steep(simd, &mut held, view, places, (cell, at), looks);
                    pixels = held;
                    continue;
                }
            }
            let met = MetMeans::of(simd, slab, places, cell, at);
            let opacity = met.row(simd, 3);
            if !opacity.simd_gt(f32x8::splat(simd, 0.0)).any_true() {
                continue;
            }
            let inside = if is_outer { self.share_inside(simd, view, cell, at) } else { one };
            let mut white = None;
            if !slab.gradients.is_empty() {
                let gradient = each!(axis of 3 => met.row(simd, PLAIN_ROWS + axis));
                white = Some(opacity * self.steep.highlight(simd, gradient, self.halfway(simd, view, at)));
            }
            met.add(simd, &mut pixels, opacity, length * inside, white);
        }
        view.keep(pixels, at);
        self.steep.are_closed(simd, pixels[3])
    }

    /// Adds some cells of which means say enough.
    #[inline(always)]
    fn add_means<S: Simd>(
        &self,
        simd: S,
        view: &mut ViewRow,
        places: &Places,
        at: usize,
        mut cells: u32,
    ) -> bool {
        let mut pixels = view.pixels(simd, at);
        let length = load(simd, &view.lengths, at);
        while cells != 0 {
            let cell = cells.trailing_zeros() as usize;
            cells &= cells - 1;
            let met = MetMeans::of(simd, self.slab, places, cell, at);
            met.add(simd, &mut pixels, met.row(simd, 3), length, None);
        }
        view.keep(pixels, at);
        self.steep.are_closed(simd, pixels[3])
    }

    /// Adds a cell that is too steep for means. What its back looks up, and the cell behind, if that was looked up.
    #[inline(never)]
    fn add_steep<S: Simd>(
        &self,
        simd: S,
        pixels: &mut Pixels<S>,
        view: &ViewRow,
        places: &Places,
        (cell, at): (usize, usize),
        looks: Option<Looked<S>>,
    ) -> Option<(usize, Looked<S>)> {
        outlined!(simd => {
        let (casting, slab) = (self.steep.casting, self.slab);
        let ends = [&places.depths[cell], &places.depths[cell + 1]];
        let entries = [ends[0].entry + at as i64, ends[1].entry + at as i64];
        if entries.iter().any(|&entry| entry < 0 || entry as usize + LANES + 1 > slab.stride) {
            return None;
        }
        let scalars = [
            self.fetch(simd, &slab.scalars, (cell, 0), ends[0], entries[0], (1, 0)),
            self.fetch(simd, &slab.scalars, (cell, 1), ends[1], entries[1], (1, 0)),
        ];
        let zero = f32x8::splat(simd, 0.0);
        let mut spread = zero;
        if !slab.spreads.is_empty() {
            let front = self.fetch(simd, &slab.spreads, (cell, 0), ends[0], entries[0], (1, 0));
            let back = self.fetch(simd, &slab.spreads, (cell, 1), ends[1], entries[1], (1, 0));
            spread = (front + back) * f32x8::splat(simd, 0.5);
        }
        let around = Around::between(simd, scalars, spread)?;
        if self.steep.is_vacant(&around) {
            return None;
        }
        let is_open = pixels[3].simd_ge(casting.scene.termination);
        let sum = scalars[0] + scalars[1];
        let is_met = sum.simd_eq(sum) & is_open;
        if !is_met.any_true() {
            return None;
        }
        let mut thickness = f32x8::splat(simd, self.thickness) * load(simd, &view.lengths, at);
        if slab.is_outer {
            thickness *= self.share_inside(simd, view, cell, at);
        }
        let gradient = if slab.gradients.is_empty() {
            None
        } else {
            Some(each!(axis of 3 => {
                let front = self.fetch(simd, &slab.gradients, (cell, 0), ends[0], entries[0], (3, axis));
                let back = self.fetch(simd, &slab.gradients, (cell, 1), ends[1], entries[1], (3, axis));
                [front, back]
            }))
        };
        if !self.steep.is_fine(&around, self.thickness) {
            self.add_each(simd, pixels, (scalars, spread, thickness), gradient, at);
            return None;
        }
        let lowest = f32x8::splat(simd, around.low);
        let cell_met = Cell {
            scalars: [is_met.select(scalars[0], lowest), is_met.select(scalars[1], lowest)],
            thickness: is_met.select(thickness, zero),
            gradient,
        };
        let halfway = self.halfway(simd, view, at);
        if around.spread > 0.0 {
            self.steep.add_spread(simd, pixels, &cell_met, spread, halfway);
            return None;
        }
        // What is looked up for rays that meet nothing is not theirs.
        let is_whole = is_met.all_true();
        let looks = if is_whole { looks } else { None };
        let front = match looks {
            Some(looks) => looks,
            None => self.steep.fine.look_up(simd, cell_met.scalars[0]),
        };
        let back = self.steep.fine.look_up(simd, cell_met.scalars[1]);
        self.steep.add(simd, pixels, &cell_met, [&front, &back], halfway);
        is_whole.then_some((cell + 1, back))
        })
    }

    /// Half-way between the light and eight rays, where light falls.
    #[inline(always)]
    pub(crate) fn halfway<S: Simd>(&self, simd: S, view: &ViewRow, at: usize) -> [f32x8<S>; 3] {
        if self.slab.gradients.is_empty() {
            return [splat(simd, 0.0); 3];
        }
        each!(axis of 3 => load(simd, &view.halfway[axis], at))
    }

    /// Whether eight rays are in the volume all the way through the slab.
    #[inline(always)]
    fn are_inside<S: Simd>(&self, simd: S, view: &ViewRow, at: usize) -> bool {
        let [front, back] = self.slab.ends();
        let enter = load(simd, &view.ends[0], at).simd_ge(splat(simd, front.z as f32));
        let leave = load(simd, &view.ends[1], at).simd_le(splat(simd, back.z as f32));
        (enter & leave).all_true()
    }

    /// The share of a cell within which rays are in the volume.
    #[inline(always)]
    fn share_inside<S: Simd>(&self, simd: S, view: &ViewRow, cell: usize, at: usize) -> f32x8<S> {
        self.share_between(simd, view, [self.slab.depths[cell].z, self.slab.depths[cell + 1].z], at)
    }

    /// The same between two depths.
    #[inline(always)]
    pub(crate) fn share_between<S: Simd>(
        &self,
        simd: S,
        view: &ViewRow,
        ends: [f64; 2],
        at: usize,
    ) -> f32x8<S> {
        let [front, back] = ends.map(|z| z as f32);
        let enter = load(simd, &view.ends[0], at).min(splat(simd, front));
        let leave = load(simd, &view.ends[1], at).max(splat(simd, back));
        ((enter - leave) * splat(simd, 1.0 / (front - back))).max(splat(simd, 0.0))
    }

    /// What a row of a list holds at an end of a cell, where the list has `rows` rows a depth and phase.
    #[inline(always)]
    pub(crate) fn fetch<S: Simd>(
        &self,
        simd: S,
        list: &[f32],
        (cell, end): (usize, usize),
        place: &Place,
        entry: i64,
        (rows, row): (usize, usize),
    ) -> f32x8<S> {
        let slab = self.slab;
        let first = entry as usize + row * slab.stride;
        let near = rows * slab.row_start(cell + end, place.phases[0]) + first;
        let far = rows * slab.row_start(cell + end, place.phases[1]) + first + place.further;
        between(simd, list, [near, far], f32x8::splat(simd, place.part))
    }

    /// Adds a cell pixel by pixel, by the whole table.
    #[inline(always)]
    pub(crate) fn add_each<S: Simd>(
        &self,
        simd: S,
        pixels: &mut Pixels<S>,
        (scalars, spread, thickness): ([f32x8<S>; 2], f32x8<S>, f32x8<S>),
        gradient: Option<[[f32x8<S>; 2]; 3]>,
        at: usize,
    ) {
        let [s0, s1] = [scalars[0].to_array(), scalars[1].to_array()];
        let (spread, thickness) = (spread.to_array(), thickness.to_array());
        let mut middle = None;
        if let Some(g) = gradient {
            let g = middle_of(simd, g);
            middle = Some(each!(axis of 3 => g[axis].to_array()));
        }
        let gradient = middle;
        let mut rgbv = each!(c of 4 => pixels[c].to_array());
        for lane in 0..LANES {
            let is_open = rgbv[3][lane] >= self.steep.casting.scene.termination;
            if !(s0[lane] + s1[lane]).is_finite() || !is_open {
                continue;
            }
            let met = thick::Met {
                scalars: (s0[lane], s1[lane]),
                spread: spread[lane],
                thickness: thickness[lane],
                gradient: gradient.map(|g| [g[0][lane], g[1][lane], g[2][lane]]),
            };
            let direction = if met.gradient.is_some() {
                self.fan.direction(self.view, self.row, at + lane)
            } else {
                [0.0; 3]
            };
            let mut pixel = each!(c of 4 => rgbv[c][lane]);
            thick::add(self.steep.casting, &mut pixel, &met, direction);
            for c in 0..4 {
                rgbv[c][lane] = pixel[c];
            }
        }
        for c in 0..4 {
            pixels[c] = f32x8::load_array(simd, rgbv[c]);
        }
    }
}
