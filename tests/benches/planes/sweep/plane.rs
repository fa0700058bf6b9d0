//! Planes parallel to the screen.

use super::content::{Content, Leaf};
use crate::scene::Scene;
use glam::DVec2;
use std::ops::Range;

/// Where the planes lie.
pub struct Frustum {
    /// Of the nearest plane to the observer, metres before the screen.
    front_m: f64,
    /// From a plane to the next, metres.
    pub spacing_m: f64,
    /// The left and lower end of all planes, metres.
    low: DVec2,
    /// Of a texel, along x and y, metres.
    pitch: DVec2,
    /// Texels along x and y.
    size: [usize; 2],
}

impl Frustum {
    /// So many planes around what is seen, with texels of the first projector's pixels.
    pub fn of(scene: &Scene, content: &Content, count: usize) -> Self {
        let [low, high] = content.bounds;
        let on_screen = |x, y| scene.display.pixel_on_screen(0, x, y);
        let pitch = (on_screen(1, 1) - on_screen(0, 0)).abs();
        let size = ((high - low).truncate() / pitch).ceil();
        let spacing_m = (high.z - low.z) / count as f64;
        Self {
            front_m: high.z - 0.5 * spacing_m,
            spacing_m,
            low: low.truncate(),
            pitch,
            size: [size.x as usize, size.y as usize],
        }
    }

    /// The depth of a plane.
    pub fn z(&self, at: usize) -> f64 {
        self.front_m - at as f64 * self.spacing_m
    }

    /// The place of a point of any plane, texels, centres at whole numbers.
    pub fn texel(&self, point: DVec2) -> DVec2 {
        (point - self.low) / self.pitch - 0.5
    }
}

/// What is seen at one depth.
pub struct Plane {
    pub z: f64,
    width: usize,
    /// Emission and extinction, times the spacing; rows from below.
    texels: Vec<[f32; 4]>,
    /// The texels of each row that show anything lie in these.
    filled: Vec<Range<usize>>,
}

impl Plane {
    pub fn new(frustum: &Frustum) -> Self {
        let [width, height] = frustum.size;
        Self { z: 0.0, width, texels: vec![[0.0; 4]; width * height], filled: vec![0..0; height] }
    }

    /// Samples and classifies what lies in it; returns how many samples.
    pub fn classify(&mut self, frustum: &Frustum, at: usize, content: &Content) -> u64 {
        let z = frustum.z(at);
        self.z = z;
        for (row, filled) in self.texels.chunks_exact_mut(self.width).zip(&mut self.filled) {
            row[std::mem::replace(filled, 0..0)].fill([0.0; 4]);
        }
        let meets = |leaf: &&Leaf| leaf.bounds[0].z <= z && z < leaf.bounds[1].z;
        content.leaves.iter().filter(meets).map(|leaf| self.fill(frustum, leaf, content)).sum()
    }

    fn fill(&mut self, frustum: &Frustum, leaf: &Leaf, content: &Content) -> u64 {
        let [first, past] =
            leaf.bounds.map(|corner| frustum.texel(corner.truncate()).ceil().max(DVec2::ZERO));
        let [first, past] = [first, past].map(|at| [at.x as usize, at.y as usize]);
        let (low, high) = leaf.region;
        let mut samples = 0;
        let step = content.volume_from_display.matrix3.x_axis * frustum.pitch.x;
        for y in first[1]..past[1].min(frustum.size[1]) {
            let start = frustum.low + frustum.pitch * DVec2::new(0.5, y as f64 + 0.5);
            let start = content.volume_from_display.transform_point3(start.extend(self.z));
            for x in first[0]..past[0].min(frustum.size[0]) {
                let point = start + step * x as f64;
                if !(point.cmpge(low).all() && point.cmplt(high).all()) {
                    continue;
                }
                samples += 1;
                let shown = leaf.shown(point, &content.look);
                if shown[3] > 0.0 {
                    self.texels[y * self.width + x] =
                        shown.map(|per_metre| per_metre * frustum.spacing_m as f32);
                    let filled = &mut self.filled[y];
                    *filled = if Range::is_empty(filled) {
                        x..x + 1
                    } else {
                        filled.start.min(x)..filled.end.max(x + 1)
                    };
                }
            }
        }
        samples
    }

    /// A row, and which of its texels show anything; nothing beyond the rim.
    pub fn row(&self, y: i64) -> (&[[f32; 4]], Range<usize>) {
        match usize::try_from(y).ok().filter(|&y| y < self.filled.len()) {
            Some(y) => (&self.texels[y * self.width..][..self.width], self.filled[y].clone()),
            None => (&[], 0..0),
        }
    }
}
