//! One screen row of all views, from the front to the back.

use crate::Fan;
use crate::fill::Grid;
use crate::fine::FineTable;
use crate::leaves::{Leaf, leaves, volume_from_display};
use crate::march::{March, Room, RowCast};
use crate::need::{SPACING_ERROR, halvings};
use crate::rough::{Roughness, Variation};
use crate::slab::Keeps;
use crate::steep::Steep;
use crate::view_row::ViewRow;
use glam::{DAffine3, DVec3};
use lanes::{Level, Simd, dispatch};
use needs::{Compositing, Needs, Shading, Way};
use optics::{DebugView, Enhancer};
use twin::Casting;
use twin::composite::Over;
use twin::kernel::{Blended, Full, Kernel, Lean};
use twin::shade::Plain;

/// As [`SPACING_ERROR`], of what means make.
pub(crate) const MEAN_ERROR: f32 = 300.0;
/// The same of the order of what a cell shows.
const ORDER_ERROR: f32 = 10.0;

/// A scene, ready to be cast row by row.
pub struct Planes<'a> {
    casting: &'a Casting<'a, f32>,
    fan: &'a Fan,
    enhancers: &'a [Enhancer],
    volume_from_display: DAffine3,
    leaves: Vec<Leaf>,
    roughness: Roughness,
    fine: FineTable,
    variation: Variation,
    level: Level,
}

/// What one thread keeps from row to row.
#[derive(Debug, Default)]
pub struct Scratch {
    leaves: Vec<Leaf>,
    views: Vec<ViewRow>,
    room: Room,
}

impl<'a> Planes<'a> {
    /// The scene of `casting`, with its enhancers, for the views of `fan`.
    pub fn new(casting: &'a Casting<'a, f32>, fan: &'a Fan, enhancers: &'a [Enhancer]) -> Self {
        Self {
            casting,
            fan,
            enhancers,
            volume_from_display: volume_from_display(casting.scene),
            leaves: leaves(casting.scene, casting.volume.nodes, fan),
            roughness: Roughness::of(casting.tables),
            fine: FineTable::of(casting.tables),
            variation: Variation::of(casting.tables),
            level: Level::new(),
        }
    }

    /// The same with the fewest instructions that this kind of processor has: the same bits, only later.
    #[must_use]
    pub fn plainly(self) -> Self {
        Self { level: Level::baseline(), ..self }
    }

    /// Why rays have to serve these needs instead.
    pub fn refusal(needs: &Needs) -> Option<&'static str> {
        match needs.debug {
            _ if needs.way != Way::Straight => Some("light is bent"),
            Some(DebugView::Samples) => Some("the samples of each ray are counted"),
            _ => None,
        }
    }

    /// Casts a row of all views into `out`: for each view RGBA, pixel by pixel.
    pub fn cast_row(&self, row: u32, scratch: &mut Scratch, out: &mut [&mut [f32]]) -> RowCast {
        dispatch!(self.level, simd => self.cast_row_on(simd, row, scratch, out))
    }

    #[inline(always)]
    fn cast_row_on<S: Simd>(
        &self,
        simd: S,
        row: u32,
        scratch: &mut Scratch,
        out: &mut [&mut [f32]],
    ) -> RowCast {
        let needs = self.casting.needs;
        let light = (needs.shading != Shading::Plain).then_some(self.casting.scene.toward_light.0);
        scratch.leaves.clear();
        scratch.leaves.extend(self.leaves.iter().filter(|leaf| leaf.rows[0] <= row && row < leaf.rows[1]));
        if scratch.leaves.is_empty() {
            out.iter_mut().for_each(|out| out.fill(0.0));
            return RowCast::default();
        }
        scratch.views.resize_with(self.fan.offsets.len(), ViewRow::default);
        for (view, state) in scratch.views.iter_mut().enumerate() {
            state.begin(self.fan, view, row, light);
        }
        let is_looked_at = scratch.views.iter().any(|view| !view.open.is_empty());
        let cast = if !is_looked_at {
            RowCast::default()
        } else if needs.reads_grandparents() {
            self.march::<S, Full<Plain, Over<false>>>(simd, row, scratch)
        } else if needs.blends || needs.spreads {
            self.march::<S, Blended<Plain, Over<false>>>(simd, row, scratch)
        } else {
            self.march::<S, Lean<Plain, Over<false>>>(simd, row, scratch)
        };
        for (state, out) in scratch.views.iter().zip(out) {
            for (i, pixel) in out.chunks_exact_mut(4).enumerate() {
                for (c, value) in pixel.iter_mut().enumerate() {
                    *value = state.rgba[c][i];
                }
            }
        }
        cast
    }

    #[inline(always)]
    fn march<S: Simd, K: Kernel>(&self, simd: S, row: u32, scratch: &mut Scratch) -> RowCast {
        let Scratch { leaves, views, room } = scratch;
        let scene = self.casting.scene;
        let along_ray = DVec3::new(0.0, self.fan.y_slope(row), 1.0);
        let needs = self.casting.needs;
        let gradient_levels = match needs.shading {
            Shading::Unsharp | Shading::Exaggerated => 3,
            Shading::Phong => 1,
            Shading::Plain => usize::from(needs.chain.needs_gradient()),
        };
        let is_by_pixel = needs.is_by_pixel();
        let march = March {
            grid: Grid {
                casting: self.casting,
                fan: self.fan,
                volume_from_display: &self.volume_from_display,
                row,
                enhancers: self.enhancers,
            },
            variation: &self.variation,
            steep: Steep {
                casting: self.casting,
                fine: &self.fine,
                roughness: &self.roughness,
                tolerance: scene.tolerance * ORDER_ERROR,
            },
            speed: (self.volume_from_display.matrix3 * along_ray).length(),
            keeps: Keeps {
                spreads: needs.spreads,
                gradient_levels,
                halvings: halvings(scene.tolerance),
                means: !is_by_pixel,
            },
            gamma: if needs.compositing == Compositing::Over { 0.0 } else { scene.gamma },
            is_by_pixel,
            is_alone: !(is_by_pixel || needs.blends || needs.reads_grandparents())
                && halvings(scene.tolerance) == 0,
            tolerances: [SPACING_ERROR, MEAN_ERROR].map(|error| scene.tolerance * error),
        };
        march.run::<S, K>(simd, leaves, views, room)
    }
}
