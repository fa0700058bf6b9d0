//! All projectors' pictures side by side, as one picture for a desktop.

use display_config::Display;
use glam::UVec2;
use protocol::ScreenImage;
use screens::Picture;

/// A sheet is no larger than this, pixels, so that it fits a desktop.
const LARGEST: UVec2 = UVec2::new(1600, 900);
/// Between pictures and around them, pixels.
const GAP: u32 = 2;
/// The code of the gaps: dark grey.
const GAP_CODE: u8 = 32;

/// Where each projector's picture is, and what was put there.
#[derive(Clone, Debug)]
pub struct Sheet {
    columns: u32,
    /// Size of a cell, pixels of the sheet.
    cell: UVec2,
    /// Pixels of a picture along an edge that make one of the sheet.
    shrink: u32,
    picture: Picture,
}

impl Sheet {
    /// The sheet of a display: each picture as it is where they all fit, or shrunk by a whole number.
    pub fn new(display: &Display) -> Self {
        let largest = |size: UVec2, raster: UVec2| size.max(raster);
        let rasters = display.projectors.iter().map(|p| UVec2::new(p.raster.width, p.raster.height));
        let raster = rasters.fold(UVec2::ONE, largest);
        let count = display.projectors.len().max(1) as u32;
        let layouts = (1..).map(|shrink| (shrink, raster.map(|pixels| pixels.div_ceil(shrink))));
        let fitting = layouts.filter_map(|(shrink, cell)| Some((shrink, cell, columns(count, cell)?)));
        let (shrink, cell, columns) = fitting.take(1).next().unwrap_or((1, raster, count));
        let size = size(count, columns, cell);
        let mut picture = Picture::black(size.x, size.y);
        picture.rgb.fill(GAP_CODE);
        let mut sheet = Self { columns, cell, shrink, picture };
        for projector in 0..count {
            let [width, height] = raster.to_array();
            let rgb = vec![0; 3 * (width * height) as usize];
            sheet.put(&ScreenImage { projector, width, height, rgb });
        }
        sheet
    }

    /// The sheet as it is.
    pub fn picture(&self) -> &Picture {
        &self.picture
    }

    /// Pixels of a projector's picture that make one of the sheet, along an edge.
    pub fn shrink(&self) -> u32 {
        self.shrink
    }

    /// Puts a projector's picture into its place.
    pub fn put(&mut self, image: &ScreenImage) {
        let at = UVec2::new(image.projector % self.columns, image.projector / self.columns);
        let corner = at * (self.cell + GAP) + GAP;
        let shown =
            UVec2::new(image.width, image.height).map(|pixels| pixels.div_ceil(self.shrink)).min(self.cell);
        for y in 0..shown.y {
            for x in 0..shown.x {
                let to = 3 * ((corner.y + y) * self.picture.width + corner.x + x) as usize;
                let code = self.mean(image, UVec2::new(x, y));
                self.picture.rgb[to..to + 3].copy_from_slice(&code);
            }
        }
    }

    /// The mean of the codes that a pixel of the sheet stands for: of one, itself.
    fn mean(&self, image: &ScreenImage, at: UVec2) -> [u8; 3] {
        let (first, size) = (at * self.shrink, UVec2::new(image.width, image.height));
        let end = (first + self.shrink).min(size);
        let (mut sums, mut count) = ([0_u32; 3], 0);
        for y in first.y..end.y {
            for x in first.x..end.x {
                let from = 3 * (y * image.width + x) as usize;
                (0..3).for_each(|c| sums[c] += u32::from(image.rgb[from + c]));
                count += 1;
            }
        }
        sums.map(|sum| ((sum + count / 2) / count.max(1)) as u8)
    }
}

fn size(count: u32, columns: u32, cell: UVec2) -> UVec2 {
    UVec2::new(columns, count.div_ceil(columns)) * (cell + GAP) + GAP
}

/// The columns with which cells of that size fit, and make the largest use of the width that whole rows allow.
fn columns(count: u32, cell: UVec2) -> Option<u32> {
    let fits = |&columns: &u32| size(count, columns, cell).cmple(LARGEST).all();
    // Whole rows where there are any.
    let all = || (1..=count).filter(fits);
    let whole = all().rfind(|columns| count.is_multiple_of(*columns));
    whole.or_else(|| all().next_back()).or_else(|| {
        // One cell of a single pixel fits no desktop of so many: then it is as it is.
        (cell == UVec2::ONE).then_some(count)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn eight_small_pictures_are_shown_as_they_are() {
        let display = Display::load("desk8").unwrap();
        let mut sheet = Sheet::new(&display);
        assert_eq!((sheet.shrink, sheet.columns), (1, 4));
        assert_eq!((sheet.picture.width, sheet.picture.height), (4 * 322 + 2, 2 * 242 + 2));
        let rgb: Vec<u8> = (0..3 * 320 * 240).map(|i| (i % 251) as u8).collect();
        sheet.put(&ScreenImage { projector: 5, width: 320, height: 240, rgb: rgb.clone() });
        let row = |y: u32| {
            let at = 3 * ((2 + 242 + y) * sheet.picture.width + 2 + 322) as usize;
            &sheet.picture.rgb[at..at + 3 * 320]
        };
        for y in 0..240 {
            assert_eq!(row(y), &rgb[3 * 320 * y as usize..][..3 * 320]);
        }
    }

    #[test]
    fn seventy_two_large_ones_are_shrunk_to_fit() {
        let sheet = Sheet::new(&Display::load("holo72").unwrap());
        let Picture { width, height, .. } = *sheet.picture();
        assert!(width <= LARGEST.x && height <= LARGEST.y && width > LARGEST.x / 2, "{width} {height}");
        assert_eq!(72 % sheet.columns, 0);
    }

    #[test]
    fn a_shrunk_pixel_is_the_mean_of_those_it_stands_for() {
        let mut sheet = Sheet::new(&Display::load("holo72").unwrap());
        let rgb = [[10, 200, 255], [20, 100, 255]].concat().repeat(800 * 600 / 2);
        sheet.put(&ScreenImage { projector: 0, width: 800, height: 600, rgb });
        let at = 3 * (2 * sheet.picture.width + 2) as usize;
        let [r, g, b] = [0, 1, 2].map(|c| i32::from(sheet.picture.rgb[at + c]));
        assert!((r - 15).abs() <= 2 && (g - 150).abs() <= 20 && b == 255, "{r} {g} {b}");
    }
}
