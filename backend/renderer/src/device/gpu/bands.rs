//! Rows of tiles that are cast together by row planes, and what is sampled of them before views sweep it.

use layout::{PlaneBand, PlaneLayer, TILE_EDGE};

/// Slabs that are sampled at a time. A number of its own, whoever looks: where a sweep ends, so do the steps of rays.
const SLABS: usize = 8;

/// What is sampled alike of a band's planes.
#[derive(Clone)]
pub(super) struct BandSlab {
    pub(super) layers: Vec<PlaneLayer>,
    /// The most that enhancers multiply an extinction by, block by block of a layer; empty where each pixel is not alone.
    pub(super) factors: Vec<f32>,
}

/// A row of tiles, with its slabs from the front to the back.
pub(super) struct Band {
    pub(super) at: u32,
    pub(super) slabs: Vec<BandSlab>,
}

impl Band {
    /// How often it is swept.
    pub(super) fn sweeps(&self) -> usize {
        self.slabs.len().div_ceil(SLABS)
    }

    /// The most columns that are kept of it at a time.
    pub(super) fn most_columns(&self) -> usize {
        let columns = |slabs: &[BandSlab]| -> usize {
            slabs.iter().flat_map(|slab| &slab.layers).map(|layer| layer.width as usize).sum()
        };
        TILE_EDGE as usize * self.slabs.chunks(SLABS).map(columns).max().unwrap_or(0)
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
            let slabs = band.slabs.chunks(SLABS).nth(number).unwrap_or_default();
            let first_layer = slice.layers.len() as u32;
            let [mut at, mut block_at] = [0; 2];
            for (slab, layer) in
                slabs.iter().flat_map(|slab| slab.layers.iter().map(move |layer| (slab, layer)))
            {
                slice.layers.push(PlaneLayer { at, block_at, ..*layer });
                slice.factors.extend(&slab.factors);
                at += layer.width;
                block_at += layer.blocks();
                slice.widest = slice.widest.max(layer.width);
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
        let wide = Band { at: 3, slabs: vec![slab(16, 5), slab(24, 2)] };
        let deep = Band { at: 7, slabs: (0..SLABS + 1).map(|_| slab(8, 5)).collect() };
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
}
