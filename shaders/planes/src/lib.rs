//! Row planes: every view of a display from one sampling of each screen row, on the CPU.
//!
//! A display with horizontal parallax only sends all rays of a screen row, whichever projector they come from, through
//! one plane. Where projectors differ in nothing but the place of their centres along x, a grid on that plane serves
//! them all: at each depth its columns are a screen pixel apart as seen by every view, so that a view's row there is the grid's,
//! shifted by a constant ([`Fan`]). So the volume is sampled once for all views ([`Slab`]), and each view only shifts
//! and composites, eight pixels at a time.

/// An expression as a function of its own, with the instructions of these lanes: what would otherwise be compiled anew wherever
/// it is called from. It stands in a function that is never inlined.
macro_rules! outlined {
    ($simd:ident => $value:expr) => {
        $simd.vectorize(
            #[inline(always)]
            || $value,
        )
    };
}

mod alone;
mod around;
mod blocks;
mod classify;
mod fan;
mod fans;
mod fill;
mod fine;
mod gradients;
mod leaves;
mod march;
mod means;
mod near;
mod need;
mod parts;
mod pixels;
mod places;
mod plan;
mod raster;
mod rough;
mod row;
mod sample;
mod slab;
mod steep;
mod sweep;
mod thick;
mod view_row;

pub use fan::Fan;
pub use fans::Fans;
pub use march::RowCast;
pub use need::samples_per_voxel;
pub use plan::Plan;
pub use raster::RasterWarp;
pub use row::{Planes, Scratch};
pub use slab::Slab;
