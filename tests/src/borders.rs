//! Whether the borders of bricks can be seen in a picture.
//!
//! Bricks of one level join without a seam. What could be seen is a border between levels, and only where it lies on
//! something visible. So a pixel is said to show the point at which its ray has lost half of its light, and two
//! neighbouring pixels lie across a border where their points lie in different leaves of the ideal cut. Where the
//! surface itself jumps (a silhouette) the pixels are left out. The step between the two would also have the slope of
//! the colour across them: so, of four pixels in a row, the excess of the middle step over the mean of its neighbours
//! counts. A jump leaves its whole height there, a slope nothing, and texture about as much across borders as inside
//! bricks: the measure is how much larger the excess is on borders.
//!
//! It is a measure of pictures of which nearly all detail is there. Leaves and surfaces are those of the ideal cut and of
//! the field itself: a live cut that is a little behind has its borders where the ideal one has some of its own. Where
//! only coarse levels have come, it shows other surfaces, and rims where the field is smooth; those would count as
//! borders wherever they happen to cross one of the ideal cut. For such pictures the law is tested where it is made: that
//! leaves which touch show the same blend of levels there, in every frame (`continuity_tests` of the working set).

use crate::motion::Spread;
use bricks::LodRule;
use bricks::procedural::Field;
use bricks::{NodeKey, OctreeShape};
use display_config::Display;
use glam::{DVec3, UVec3};
use protocol::{FrameState, ProjectorImage};
use rayon::prelude::*;

/// Points of neighbouring pixels farther apart than this many pixels do not lie on one piece of surface.
const FARTHEST_PX: f64 = 2.5;
/// Share of the light that is left at the point that a pixel shows.
const SHOWN_AT: f64 = 0.5;
/// From the first to the second share, light must fall within the same distance: what is thinner is haze, or a rim.
const STILL_CLEAR: f64 = 0.95;
const QUITE_DARK: f64 = 0.02;

/// What a pixel shows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shown {
    /// The point, display frame.
    pub point_in_display: DVec3,
    /// The leaf of the ideal cut that it lies in.
    pub leaf: NodeKey,
}

/// How the excess steps of a picture are spread.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BorderSteps {
    /// Inside leaves.
    pub inside: Spread,
    /// Across borders between leaves of one level.
    pub same_level: Spread,
    /// Across borders between levels.
    pub levels: Spread,
    /// Pairs of pixels of each kind.
    pub pairs: [usize; 3],
}

/// What the pixels of one projector show, row by row: by the field itself, so whatever levels a picture was made of.
/// None where a ray loses its light bit by bit or not at all.
pub fn shown(
    display: &Display,
    projector: u32,
    frame: &FrameState,
    field: &dyn Field,
    shape: &OctreeShape,
) -> Vec<Option<Shown>> {
    let raster = &display.projectors[projector as usize].raster;
    let law = display
        .beam_law(projector as usize, frame.observer_in_display, frame.eta)
        .expect("a test scene goes with its display");
    let rule = LodRule::new(display, frame.display_from_volume, frame.quality.lod_scale);
    let volume_from_display = frame.display_from_volume.inverse();
    let pixel_m = display.width_m / f64::from(raster.width);
    let unit = f64::from(shape.dims().max_element());
    // The display resolves no less on its screen.
    let step_m = 0.5 * display.pixel_size_m;
    let per_step = step_m * frame.optics.extinction_per_metre(frame.voxel_m());
    let of_pixel = |(x, y)| {
        let ray = law.ray(display.pixel_on_screen(projector as usize, x, y));
        let origin = volume_from_display.transform_point3(ray.origin_in_display);
        let direction = volume_from_display.transform_vector3(ray.direction_in_display);
        let (from, to) = passage(origin, direction, shape.dims().as_dvec3())?;
        let (mut depth, mut entered, mut halfway) = (0.0, from, None);
        for step in 0..((to - from) / step_m).ceil() as u32 {
            let distance = from + (f64::from(step) + 0.5) * step_m;
            let position = origin + direction * distance;
            let s = frame.optics.normalise(field.value(position / unit));
            let before = depth;
            depth += per_step * frame.optics.extinction.at(s);
            let passes = |left: f64| before < -left.ln() && depth >= -left.ln();
            if passes(STILL_CLEAR) {
                entered = distance;
            }
            if passes(SHOWN_AT) {
                let part = (-SHOWN_AT.ln() - before) / (depth - before);
                halfway = Some(distance + step_m * (part - 0.5));
            }
            if passes(QUITE_DARK) {
                let is_surface = distance - entered < FARTHEST_PX * pixel_m;
                return halfway.filter(|_| is_surface).map(|distance| {
                    let point = ray.at(distance);
                    let position = volume_from_display.transform_point3(point);
                    Shown { point_in_display: point, leaf: leaf_at(&rule, shape, position) }
                });
            }
        }
        None
    };
    let pixels: Vec<(u32, u32)> =
        (0..raster.height).flat_map(|y| (0..raster.width).map(move |x| (x, y))).collect();
    pixels.into_par_iter().map(of_pixel).collect()
}

/// Where a ray is inside a box from the origin to `high`.
fn passage(origin: DVec3, direction: DVec3, high: DVec3) -> Option<(f64, f64)> {
    let (a, b) = (-origin / direction, (high - origin) / direction);
    let (from, to) = (a.min(b).max_element().max(0.0), a.max(b).min_element());
    (from < to).then_some((from, to))
}

/// The leaf of the ideal cut at a position in the volume, empty or not.
fn leaf_at(rule: &LodRule, shape: &OctreeShape, position: DVec3) -> NodeKey {
    let last = shape.dims() - 1;
    let voxel = position.max(DVec3::ZERO).as_uvec3().min(last);
    let node = |depth: u8| {
        let edge = (bricks::OWN_EDGE as u32) << shape.level(depth);
        NodeKey { depth, cell: voxel / UVec3::splat(edge) }
    };
    let found = (0..shape.finest_depth()).map(node).find(|&key| rule.is_fine_enough(shape, key));
    found.unwrap_or_else(|| node(shape.finest_depth()))
}

/// Whether points shown one after the other, in a row of pixels or by one pixel over time, lie on one piece of surface.
pub fn is_one_surface(shown: &[Shown], pixel_m: f64) -> bool {
    let apart = |pair: &[Shown]| pair[0].point_in_display.distance(pair[1].point_in_display);
    shown.windows(2).all(|pair| apart(pair) < FARTHEST_PX * pixel_m)
}

/// Measures a picture, along rows and along columns.
pub fn border_steps(image: &ProjectorImage, shown: &[Option<Shown>], pixel_m: f64) -> BorderSteps {
    let (width, height) = (image.width as usize, image.height as usize);
    let mut found: [Vec<f64>; 3] = Default::default();
    for (stride, columns, rows) in
        [(1, width.saturating_sub(3), height), (width, width, height.saturating_sub(3))]
    {
        for (x, y) in (0..rows).flat_map(|y| (0..columns).map(move |x| (x, y))) {
            let at: [usize; 4] = std::array::from_fn(|k| y * width + x + k * stride);
            let [Some(a), Some(b), Some(c), Some(d)] = at.map(|i| shown[i]) else { continue };
            let is_one_surface =
                |p: Shown, q: Shown| p.point_in_display.distance(q.point_in_display) < FARTHEST_PX * pixel_m;
            if !(is_one_surface(a, b) && is_one_surface(b, c) && is_one_surface(c, d)) {
                continue;
            }
            let kind = match (b.leaf == c.leaf, b.leaf.depth == c.leaf.depth) {
                // A border beside the middle would leave half of its height here.
                (true, _) if a.leaf == b.leaf && c.leaf == d.leaf => 0,
                (true, _) => continue,
                (false, true) => 1,
                (false, false) => 2,
            };
            found[kind].push(excess(image, at));
        }
    }
    let pairs = [0, 1, 2].map(|kind| found[kind].len());
    let [inside, same_level, levels] = found.map(Spread::of);
    BorderSteps { inside, same_level, levels, pairs }
}

/// The step between the middle two of four pixels, less the mean of the other two steps: the largest of a pixel's numbers.
fn excess(image: &ProjectorImage, at: [usize; 4]) -> f64 {
    let of = |channel: usize| {
        let [a, b, c, d] = at.map(|i| f64::from(image.rgba[4 * i + channel]));
        ((c - b) - 0.5 * ((b - a) + (d - c))).abs()
    };
    (0..4).map(of).fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A slope across two leaves, with a jump of `jump` between them.
    fn picture(jump: f32) -> (ProjectorImage, Vec<Option<Shown>>) {
        let (width, height) = (16, 4);
        let value = |x: u32| 0.03125 * x as f32 + if x < 8 { 0.0 } else { jump };
        let rgba = (0..width * height).flat_map(|i| [value(i % width), 0.0, 0.0, 1.0]).collect();
        let shown = (0..width * height).map(|i| {
            let leaf = match i % width {
                0..8 => NodeKey { depth: 3, cell: UVec3::ZERO },
                _ => NodeKey { depth: 4, cell: UVec3::X },
            };
            let point_in_display = DVec3::new(f64::from(i % width), f64::from(i / width), 0.0);
            Some(Shown { point_in_display, leaf })
        });
        (ProjectorImage { projector: 0, width, height, rgba }, shown.collect())
    }

    #[test]
    fn a_jump_between_levels_is_told_from_a_slope() {
        let (image, shown) = picture(0.25);
        let found = border_steps(&image, &shown, 1.0);
        assert_eq!((found.levels.max, found.inside.max), (0.25, 0.0));
        let (image, shown) = picture(0.0);
        assert_eq!(border_steps(&image, &shown, 1.0).levels.max, 0.0);
    }

    #[test]
    fn a_silhouette_is_no_border() {
        let (image, mut shown) = picture(0.25);
        for (i, shown) in shown.iter_mut().enumerate() {
            let shown = shown.as_mut().unwrap();
            shown.point_in_display.z = if i % 16 < 8 { 0.0 } else { 100.0 };
        }
        assert_eq!(border_steps(&image, &shown, 1.0).pairs[2], 0);
    }
}
