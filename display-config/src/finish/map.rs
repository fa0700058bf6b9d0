//! A picture of numbers from 0 to 1, for the pixels of a raster.

use super::{MOST_MAP_PIXELS, MapFault};
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// Shares of light over a raster, linear: 65535 is 1. It lies over the raster edge to edge, whatever its own size. Messages
/// carry its numbers apart.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct LightMap {
    width: u32,
    height: u32,
    #[serde(skip)]
    shares: Arc<[u16]>,
}

impl LightMap {
    /// Rows from the top, x fastest.
    ///
    /// # Errors
    /// No pixel, too many pixels, or as many numbers as its size does not say.
    pub fn new(width: u32, height: u32, shares: Vec<u16>) -> Result<Self, MapFault> {
        match Self::pixels(width, height)? == shares.len() {
            true => Ok(Self { width, height, shares: shares.into() }),
            false => Err(MapFault::MapCount { found: shares.len(), width, height }),
        }
    }

    /// How many numbers a map of this size has, asked before anything of that size is made.
    pub(crate) fn pixels(width: u32, height: u32) -> Result<usize, MapFault> {
        let pixels = u64::from(width) * u64::from(height);
        let is_sensible = (1..=u64::from(MOST_MAP_PIXELS)).contains(&pixels);
        if is_sensible { Ok(pixels as usize) } else { Err(MapFault::MapSize { width, height }) }
    }

    /// Pixels along x and y.
    pub fn size(&self) -> [u32; 2] {
        [self.width, self.height]
    }

    /// All numbers.
    pub fn shares(&self) -> &[u16] {
        &self.shares
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_map_has_as_many_numbers_as_pixels_and_some() {
        let map = LightMap::new(2, 1, vec![7, 8]).unwrap();
        assert_eq!((map.size(), map.shares()), ([2, 1], &[7, 8][..]));
        let refused =
            |width, height, count| LightMap::new(width, height, vec![0; count]).unwrap_err().to_string();
        assert!(refused(0, 3, 0).starts_with("which has 0 × 3 pixels; give at least 1"));
        assert!(refused(4097, 4096, 0).contains("at most 16777216 of them"));
        assert!(refused(u32::MAX, u32::MAX, 0).contains("at most 16777216 of them"));
        assert_eq!(refused(2, 2, 3), "which has 3 numbers for 2 × 2 pixels; make it again");
    }
}
