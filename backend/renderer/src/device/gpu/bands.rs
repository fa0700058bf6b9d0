//! Rows of tiles that are cast together by row planes, and what is sampled of them before views sweep it.

use layout::{PlaneBand, PlaneLayer, TILE_EDGE};
use std::ops::Range;

/// Slabs that are sampled at a time. A number of its own, whoever looks: where a sweep ends, so do the steps of rays.
const SLABS: usize = 8;

/// What is sampled alike of a band's planes.
pub(super) struct BandSlab {
    pub(super) layers: Vec<PlaneLayer>,
    /// The most that enhancers multiply an extinction by, block by block of a layer; empty where each pixel is not alone.
    pub(super) factors: Vec<f32>,
}

impl BandSlab {
    /// Columns that are kept of it.
    fn columns(&self) -> usize {
        TILE_EDGE as usize * self.layers.iter().map(|layer| layer.width as usize).sum::<usize>()
    }
}

/// A row of tiles, with its slabs from the front to the back.
pub(super) struct Band {
    pub(super) at: u32,
    slabs: Vec<BandSlab>,
    /// Which of them each sweep takes.
    sweeps: Vec<Range<usize>>,
}

impl Band {
    /// Sweeps take fewer slabs than they might where more have no room in so many columns.
    pub(super) fn new(at: u32, slabs: Vec<BandSlab>, room: usize) -> Self {
        let mut sweeps: Vec<Range<usize>> = Vec::new();
        let mut columns = 0;
        for (number, slab) in slabs.iter().enumerate() {
            let own = slab.columns();
            match sweeps.last_mut().filter(|sweep| sweep.len() < SLABS && columns + own <= room) {
                Some(sweep) => {
                    sweep.end = number + 1;
                    columns += own;
                }
                None => {
                    sweeps.push(number..number + 1);
                    columns = own;
                }
            }
        }
        Self { at, slabs, sweeps }
    }

    /// How often it is swept.
    pub(super) fn sweeps(&self) -> usize {
        self.sweeps.len()
    }

    /// What a sweep takes.
    fn slabs_of(&self, sweep: usize) -> &[BandSlab] {
        self.sweeps.get(sweep).map_or(&[], |range| &self.slabs[range.clone()])
    }

    /// The most columns that are kept of it at a time.
    pub(super) fn most_columns(&self) -> usize {
        let columns = |sweep| self.slabs_of(sweep).iter().map(BandSlab::columns).sum();
        (0..self.sweeps()).map(columns).max().unwrap_or(0)
    }
}

/// What is swept at a time: layers of bands, and how many columns and blocks that is.
#[derive(Default)]
pub(super) struct Slice {
    pub(super) bands: Vec<PlaneBand>,
    pub(super) layers: Vec<PlaneLayer>,
    /// Those of all its layers.
    pub(super) factors: Vec<f32>,
    pub(super) columns: usize,
    pub(super) blocks: usize,
    /// Columns of the widest layer, and layers of the deepest band.
    pub(super) widest: u32,
    pub(super) deepest: u32,
}

impl Slice {
    /// What some bands have for the `number`th sweep.
    pub(super) fn of(batch: &[Band], number: usize) -> Self {
        let mut slice = Self::default();
        for band in batch {
            let first_layer = slice.layers.len() as u32;
            let [mut at, mut block_at] = [0; 2];
            for slab in band.slabs_of(number) {
                for layer in &slab.layers {
                    slice.layers.push(PlaneLayer { at, block_at, ..*layer });
                    slice.factors.extend(&slab.factors);
                    at += layer.width;
                    block_at += layer.blocks();
                    slice.widest = slice.widest.max(layer.width);
                }
            }
            let layers = slice.layers.len() as u32 - first_layer;
            slice.bands.push(PlaneBand {
                at: band.at,
                first_layer,
                layers,
                first_column: slice.columns as u32,
                columns: at,
                first_block: slice.blocks as u32,
                blocks: block_at,
                padding: 0,
            });
            slice.deepest = slice.deepest.max(layers);
            slice.columns += (TILE_EDGE * at) as usize;
            slice.blocks += (TILE_EDGE * block_at) as usize;
        }
        slice
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn slab(width: u32, layers: usize) -> BandSlab {
        let layer = PlaneLayer { width, phases: 1.0, ..PlaneLayer::default() };
        BandSlab { layers: vec![layer; layers], factors: vec![1.0; layer.blocks() as usize] }
    }

    #[test]
    fn a_slice_keeps_all_columns_of_its_bands_side_by_side() {
        let wide = Band::new(3, vec![slab(16, 5), slab(24, 2)], usize::MAX);
        let deep = Band::new(7, (0..SLABS + 1).map(|_| slab(8, 5)).collect(), usize::MAX);
        assert_eq!((wide.sweeps(), deep.sweeps()), (1, 2));
        assert_eq!((wide.most_columns(), deep.most_columns()), (8 * (5 * 16 + 2 * 24), 8 * 5 * 8 * SLABS));
        let batch = [wide, deep];
        let slice = Slice::of(&batch, 0);
        let places: Vec<_> = slice.layers[..7].iter().map(|layer| (layer.at, layer.block_at)).collect();
        assert_eq!(places, [(0, 0), (16, 2), (32, 4), (48, 6), (64, 8), (80, 10), (104, 13)]);
        assert_eq!((slice.bands[1].first_layer, slice.bands[1].first_column), (7, 8 * 128));
        assert_eq!((slice.widest, slice.deepest), (24, 5 * SLABS as u32));
        assert_eq!(TILE_EDGE as usize * slice.factors.len(), slice.blocks);
        assert_eq!(slice.columns, batch[0].most_columns() + batch[1].most_columns());
        // The first has nothing left.
        let slice = Slice::of(&batch, 1);
        assert_eq!((slice.bands[0].layers, slice.bands[1].layers, slice.columns), (0, 5, 8 * 5 * 8));
    }

    #[test]
    fn sweeps_take_as_many_slabs_as_have_room() {
        let slabs = || (0..20).map(|_| slab(8, 5)).collect::<Vec<_>>();
        let own = slabs()[0].columns();
        let tight = Band::new(0, slabs(), 3 * own + own / 2);
        assert_eq!((tight.sweeps(), tight.most_columns()), (7, 3 * own));
        assert_eq!(tight.slabs_of(6).len(), 2);
        let wide = Band::new(0, slabs(), 100 * own);
        assert_eq!((wide.sweeps(), wide.most_columns()), (3, SLABS * own));
        // One that has no room by itself is taken alone: whoever makes room for it says so.
        let single = Band::new(0, slabs(), own / 2);
        assert_eq!((single.sweeps(), single.most_columns()), (20, own));
    }
}
