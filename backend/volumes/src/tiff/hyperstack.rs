//! Which page holds a slice of a channel at a point in time, and how large its voxels are.

use super::pages::INCH;
use crate::Selection;
use bricks::volume::VolumeError;
use glam::DVec3;
use std::path::Path;

/// Finest print, pixels per inch: programs that know no voxel size write 72, 96, 300 ... for the printer.
const FINEST_PRINT: f64 = 1200.0;
const CENTIMETRE: u16 = 3;
/// Edge of a voxel of which nothing is said, mm.
const UNKNOWN_MM: f64 = 1.0;

/// What a file says of its pages as a whole.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Hyperstack {
    /// Number of channels, slices, points in time.
    pub counts: [u32; 3],
    /// The page of channel c, slice z, time t is at `c + channels * (z + slices * t)`; None is not there.
    pub pages: Vec<Option<u32>>,
    /// Edges of a voxel in mm, as far as they are known.
    pub voxel_mm: [Option<f64>; 3],
}

impl Hyperstack {
    /// Pages that are just slices.
    pub fn of_slices(slices: u32) -> Self {
        Self::in_order([1, slices, 1], [0, 1, 2])
    }

    /// Pages one after the other, the axis `order[0]` fastest.
    pub fn in_order(counts: [u32; 3], order: [usize; 3]) -> Self {
        let mut strides = [1; 3];
        strides[order[1]] = counts[order[0]];
        strides[order[2]] = counts[order[0]].saturating_mul(counts[order[1]]);
        let [channels, slices, times] = counts;
        let page = |c: u32, z: u32, t: u32| Some(c * strides[0] + z * strides[1] + t * strides[2]);
        let pages = (0..times)
            .flat_map(|t| (0..slices).flat_map(move |z| (0..channels).map(move |c| page(c, z, t))))
            .collect();
        Self { counts, pages, voxel_mm: [None; 3] }
    }

    /// How many pages counts make; None if they are 0 or beyond all measure.
    pub fn page_count(counts: [u32; 3]) -> Option<u32> {
        let count = counts.iter().try_fold(1u32, |product, &count| product.checked_mul(count))?;
        (count > 0).then_some(count)
    }

    /// The pages of a volume in order and the sample within a page, where each page has `samples` channels.
    pub fn choose(
        &self,
        path: &Path,
        samples: u32,
        selection: &Selection,
    ) -> Result<(Vec<u32>, u32), VolumeError> {
        let [channels, slices, times] = self.counts;
        let channel = one_of("channels", "channel", channels.saturating_mul(samples), selection.channel);
        let time = one_of("points in time", "time", times, selection.time);
        let (channel, time) = match (channel, time) {
            (Ok(channel), Ok(time)) => (channel, time),
            (channel, time) => {
                let whats: Vec<String> = [channel.err(), time.err()].into_iter().flatten().collect();
                return Err(VolumeError::unsupported(path, whats.join("; ")));
            }
        };
        let page = |z: u32| {
            let place = channel / samples + channels * (z + slices * time);
            self.pages[place as usize].ok_or_else(|| {
                let what = format!("slice {z} of channel {channel} at time {time} is missing: save it again");
                VolumeError::unsupported(path, what)
            })
        };
        let pages: Result<Vec<u32>, VolumeError> = (0..slices).map(page).collect();
        Ok((pages?, channel % samples))
    }

    /// Edges of a voxel, mm.
    pub fn voxel_mm(&self, path: &Path) -> DVec3 {
        let [x, y, z] = self.voxel_mm.map(|mm| mm.filter(|mm| mm.is_finite() && *mm > 0.0));
        let plane = x.or(y).unwrap_or(UNKNOWN_MM);
        if x.is_none() || z.is_none() {
            let path = path.display();
            tracing::warn!(%path, "the file does not give all edges of a voxel: {plane} mm are assumed");
        }
        DVec3::new(x.unwrap_or(plane), y.unwrap_or(plane), z.unwrap_or(plane))
    }
}

fn one_of(things: &str, option: &str, count: u32, asked: Option<u32>) -> Result<u32, String> {
    match asked {
        None if count == 1 => Ok(0),
        None => Err(format!("it has {count} {things}: choose the {option}, 0 to {}", count - 1)),
        Some(asked) if asked < count => Ok(asked),
        Some(asked) => Err(format!("{option} {asked} is asked for, and there are {count}, from 0")),
    }
}

/// Millimetres in a unit of that name; None if it is not a length.
pub(super) fn unit_mm(name: &str) -> Option<f64> {
    Some(match name.trim() {
        "µm" | "μm" | "um" | "micron" | "microns" | "micrometer" | "micrometre" | "\\u00B5m" | "\\u00b5m" => {
            1e-3
        }
        "nm" | "nanometer" | "nanometre" => 1e-6,
        "\u{c5}" | "\u{212b}" | "angstrom" => 1e-7,
        "mm" | "millimeter" | "millimetre" => 1.0,
        "cm" | "centimeter" | "centimetre" => 10.0,
        "m" | "meter" | "metre" => 1e3,
        "in" | "inch" | "inches" => 25.4,
        _ => return None,
    })
}

/// Edges of a pixel in mm from the print resolution, unless that is a printer's default.
pub(super) fn printed_mm(resolution: Option<([f64; 2], u16)>) -> [Option<f64>; 2] {
    match resolution {
        Some((per_cm, CENTIMETRE)) if per_cm.iter().all(|&n| n > 1.0) => per_cm.map(|n| Some(10.0 / n)),
        Some((per_inch, INCH)) if per_inch.iter().all(|&n| n > FINEST_PRINT) => {
            per_inch.map(|n| Some(25.4 / n))
        }
        _ => [None; 2],
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_page_is_found_whatever_the_order() {
        let path = Path::new("a.tif");
        let choice = Selection { channel: Some(1), time: Some(1), ..Default::default() };
        let czt = Hyperstack::in_order([2, 3, 2], [0, 1, 2]);
        assert_eq!(czt.choose(path, 1, &choice).unwrap(), (vec![7, 9, 11], 0));
        let tzc = Hyperstack::in_order([2, 3, 2], [2, 1, 0]);
        assert_eq!(tzc.choose(path, 1, &choice).unwrap(), (vec![7, 9, 11], 0));
        let zct = Hyperstack::in_order([2, 3, 2], [1, 0, 2]);
        assert_eq!(zct.choose(path, 1, &choice).unwrap(), (vec![9, 10, 11], 0));
        let said = czt.choose(path, 1, &Selection::default()).unwrap_err().to_string();
        assert!(said.contains("2 channels") && said.contains("2 points in time"), "{said}");
    }

    #[test]
    fn samples_of_a_page_are_channels() {
        let rgb = Selection { channel: Some(2), ..Default::default() };
        assert_eq!(Hyperstack::of_slices(2).choose(Path::new("a"), 3, &rgb).unwrap(), (vec![0, 1], 2));
    }

    #[test]
    fn print_resolutions_are_no_voxel_sizes() {
        assert_eq!(printed_mm(Some(([300.0; 2], INCH))), [None; 2]);
        assert_eq!(printed_mm(Some(([1000.0; 2], CENTIMETRE))), [Some(0.01); 2]);
        assert_eq!(printed_mm(Some(([25400.0; 2], INCH))), [Some(1e-3); 2]);
    }
}
