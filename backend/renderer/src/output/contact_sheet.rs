//! All pictures of a frame, small, in one grid.

use super::{OutputError, Picture, PictureRef};

/// A sheet is about this wide, pixels.
const SHEET_WIDTH: u32 = 1920;
/// No cell is wider, pixels.
const WIDEST_CELL: u32 = 480;
/// Between cells and around them, pixels.
const GAP: u32 = 3;
/// Linear grey of the gaps.
const GAP_GREY: f32 = 0.012;

/// A grid of pictures, filled one at a time in any order; cells not filled stay as dark as the gaps.
#[derive(Clone, Debug)]
pub struct ContactSheet {
    columns: u32,
    count: u32,
    cell: (u32, u32),
    picture: Picture,
}

impl ContactSheet {
    /// A sheet for `count` pictures shown with `aspect` = width / height; 72 of them make 12 × 6.
    pub fn new(count: u32, aspect: f64) -> Self {
        let count = count.max(1);
        let columns = (2.0 * f64::from(count)).sqrt().ceil().clamp(1.0, f64::from(count)) as u32;
        let rows = count.div_ceil(columns);
        let cell_width = (SHEET_WIDTH / columns).clamp(8, WIDEST_CELL);
        let cell_height = (f64::from(cell_width) / aspect).round().clamp(1.0, 4096.0) as u32;
        let (width, height) = (columns * (cell_width + GAP) + GAP, rows * (cell_height + GAP) + GAP);
        let grey = [GAP_GREY, GAP_GREY, GAP_GREY, 1.0];
        let rgba = grey.repeat(width as usize * height as usize);
        Self { columns, count, cell: (cell_width, cell_height), picture: Picture { width, height, rgba } }
    }

    /// Columns and rows.
    pub fn grid(&self) -> (u32, u32) {
        (self.columns, self.count.div_ceil(self.columns))
    }

    /// Puts a picture into cell `index` (row by row from the top left), box-filtered in linear light.
    pub fn add(&mut self, index: u32, picture: PictureRef<'_>) {
        assert!(index < self.count, "the sheet was made for {} pictures", self.count);
        let left = (index % self.columns) * (self.cell.0 + GAP) + GAP;
        let top = (index / self.columns) * (self.cell.1 + GAP) + GAP;
        let (columns, rows) = (spans(picture.width(), self.cell.0), spans(picture.height(), self.cell.1));
        for (y, row_span) in rows.iter().enumerate() {
            let line = mean_of_rows(picture, row_span);
            for (x, column_span) in columns.iter().enumerate() {
                let at = 4 * ((top as usize + y) * self.picture.width as usize + left as usize + x);
                self.picture.rgba[at..at + 4].copy_from_slice(&mean_of_pixels(&line, column_span));
            }
        }
    }

    /// The sheet as it is now.
    pub fn view(&self) -> Result<PictureRef<'_>, OutputError> {
        self.picture.view()
    }
}

/// Which source pixels a small pixel covers: the first, and the share of each; shares add to 1.
struct Span {
    first: usize,
    shares: Vec<f32>,
}

/// The spans of `small` equal parts of `large` pixels.
fn spans(large: u32, small: u32) -> Vec<Span> {
    let scale = f64::from(large) / f64::from(small);
    let span = |i: u32| {
        let (low, high) = (f64::from(i) * scale, f64::from(i + 1) * scale);
        let first = (low.floor() as usize).min(large as usize - 1);
        let end = (high.ceil() as usize).clamp(first + 1, large as usize);
        let overlap = |p: usize| (high.min(p as f64 + 1.0) - low.max(p as f64)).max(0.0);
        let total: f64 = (first..end).map(overlap).sum();
        Span { first, shares: (first..end).map(|p| (overlap(p) / total) as f32).collect() }
    };
    (0..small).map(span).collect()
}

fn mean_of_rows(picture: PictureRef<'_>, span: &Span) -> Vec<f32> {
    let length = 4 * picture.width() as usize;
    let mut line = vec![0.0; length];
    for (i, share) in span.shares.iter().enumerate() {
        let row = &picture.rgba()[(span.first + i) * length..][..length];
        line.iter_mut().zip(row).for_each(|(sum, value)| *sum += share * value);
    }
    line
}

fn mean_of_pixels(line: &[f32], span: &Span) -> [f32; 4] {
    let mut mean = [0.0; 4];
    for (i, share) in span.shares.iter().enumerate() {
        let pixel = &line[4 * (span.first + i)..][..4];
        mean.iter_mut().zip(pixel).for_each(|(sum, value)| *sum += share * value);
    }
    mean
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn seventy_two_pictures_make_twelve_by_six() {
        assert_eq!(ContactSheet::new(72, 16.0 / 9.0).grid(), (12, 6));
        assert_eq!(ContactSheet::new(1, 1.0).grid(), (1, 1));
        assert_eq!(ContactSheet::new(7, 1.0).grid(), (4, 2));
    }

    #[test]
    fn a_constant_picture_stays_constant_in_its_cell() {
        let mut sheet = ContactSheet::new(2, 1.5);
        let rgba = [0.5f32, 0.25, 0.125, 1.0].repeat(601 * 401);
        sheet.add(1, PictureRef::new(601, 401, &rgba).unwrap());
        let (view, cell) = (sheet.view().unwrap(), sheet.cell);
        let (left, right) = ((cell.0 + 2 * GAP) as usize, (2 * cell.0 + 2 * GAP) as usize - 1);
        for x in [left, right] {
            assert!((view.pixel(x, GAP as usize)[0] - 0.5).abs() < 1e-5);
        }
        assert_eq!(view.pixel(left - 1, GAP as usize)[0], GAP_GREY);
        assert_eq!(view.pixel(GAP as usize, GAP as usize)[0], GAP_GREY);
    }

    #[test]
    fn the_box_filter_keeps_the_mean() {
        for (large, small) in [(800, 160), (7, 3), (3, 7), (1, 5)] {
            let mut share_of = vec![0.0f64; large as usize];
            for span in spans(large, small) {
                span.shares.iter().enumerate().for_each(|(i, s)| share_of[span.first + i] += f64::from(*s));
            }
            let expected = f64::from(small) / f64::from(large);
            assert!(share_of.iter().all(|s| (s - expected).abs() < 1e-6), "{large} to {small}: {share_of:?}");
        }
    }
}
