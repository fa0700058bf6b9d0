//! ImageJ's description of a stack: lines of `key=value` in the first page.

use super::hyperstack::{Hyperstack, unit_mm};

/// What ImageJ's description starts with.
const START: &str = "ImageJ=";

/// The numbers of channels, slices and points in time, all pages that may be there (one may be listed for all); None if
/// the description is not ImageJ's, or contradicts itself.
pub(super) fn counts(description: &str, pages: u32) -> Option<[u32; 3]> {
    if !description.starts_with(START) {
        return None;
    }
    let count = |key| value(description, key).and_then(|count| count.parse::<u32>().ok());
    let images = count("images").unwrap_or(pages);
    let channels = count("channels").unwrap_or(1);
    let frames = count("frames").unwrap_or(1);
    let others = channels.checked_mul(frames).filter(|&others| others > 0)?;
    let counts = [channels, count("slices").unwrap_or(images / others), frames];
    // A page that is listed stands for itself; beyond that only a single one may stand for many.
    (Hyperstack::page_count(counts)? == images && (pages == images || pages == 1)).then_some(counts)
}

/// The stack of so many channels, slices and points in time.
pub(super) fn hyperstack(
    description: &str,
    counts: [u32; 3],
    resolution: Option<([f64; 2], u16)>,
) -> Hyperstack {
    let mut stack = Hyperstack::in_order(counts, [0, 1, 2]);
    let unit = |key| value(description, key).and_then(unit_mm);
    if let Some(x_mm) = unit("unit") {
        let y_mm = unit("yunit").unwrap_or(x_mm);
        let z_mm = unit("zunit").unwrap_or(x_mm);
        let spacing = value(description, "spacing").and_then(|spacing| spacing.parse::<f64>().ok());
        let [x, y] = resolution.map_or([None; 2], |([x, y], _)| [Some(x_mm / x), Some(y_mm / y)]);
        stack.voxel_mm = [x, y, spacing.map(|spacing| spacing.abs() * z_mm)];
    }
    stack
}

/// What the line of a key says.
fn value<'a>(description: &'a str, key: &str) -> Option<&'a str> {
    description.lines().find_map(|line| Some(line.strip_prefix(key)?.strip_prefix('=')?.trim()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_and_units() {
        let text = "ImageJ=1.54f\nimages=12\nchannels=2\nslices=3\nframes=2\nunit=micron\nspacing=2.5\n";
        let counts = counts(text, 12).unwrap();
        let stack = hyperstack(text, counts, Some(([4.0, 2.0], 1)));
        assert_eq!((counts, stack.counts), ([2, 3, 2], [2, 3, 2]));
        assert_eq!(stack.voxel_mm, [Some(0.25e-3), Some(0.5e-3), Some(2.5e-3)]);
    }

    #[test]
    fn what_does_not_add_up_is_not_believed() {
        assert_eq!(counts("ImageJ=1\nimages=5\nslices=4\n", 5), None);
        assert_eq!(counts("ImageJ=1\nimages=5\nslices=5\n", 4), None);
        assert_eq!(counts("ImageJ=1\nimages=0\nslices=0\n", 1), None);
        assert_eq!(counts("ImageJ=1\nchannels=70000\nframes=70000\n", 1), None);
        assert_eq!(counts("other", 1), None);
    }
}
