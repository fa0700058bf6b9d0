//! Volumes as instruments give them, for looking at: no real ones of these kinds may be passed on.

use crate::random::Random;
use glam::{DVec3, UVec3};
use rayon::prelude::*;
use std::path::{Path, PathBuf};

/// A volume.
pub struct Phantom {
    /// In a word.
    pub name: &'static str,
    /// Voxels along each axis.
    pub dims: UVec3,
    /// Edges of a voxel.
    pub spacing_mm: DVec3,
    /// x fastest.
    pub voxels: Vec<i16>,
}

impl Phantom {
    /// Writes its voxels as a raw file of its name.
    pub fn write_raw(&self, folder: &Path) -> PathBuf {
        let path = folder.join(self.name).with_extension("raw");
        let bytes: Vec<u8> = self.voxels.iter().flat_map(|voxel| voxel.to_le_bytes()).collect();
        std::fs::write(&path, bytes).expect("a temporary folder takes 20 MB");
        path
    }
}

/// What `import` has to be told of a raw file of 16-bit voxels.
pub fn layout_arguments(dims: UVec3, spacing_mm: DVec3) -> Vec<String> {
    let three = |[x, y, z]: [String; 3]| format!("{x},{y},{z}");
    let arguments = [
        ("--raw-dims", three(dims.to_array().map(|n| n.to_string()))),
        ("--raw-type", "int16".into()),
        ("--raw-endian", "little".into()),
        ("--raw-spacing-mm", three(spacing_mm.to_array().map(|n| n.to_string()))),
    ];
    arguments.into_iter().flat_map(|(name, value)| [name.to_owned(), value]).collect()
}

/// A ball-ended tube.
struct Tube {
    from: DVec3,
    to: DVec3,
    radius: f64,
}

impl Tube {
    fn contains(&self, p: DVec3) -> bool {
        let way = self.to - self.from;
        let share = ((p - self.from).dot(way) / way.length_squared()).clamp(0.0, 1.0);
        (p - self.from - way * share).length_squared() < self.radius * self.radius
    }
}

fn between(random: &mut Random, low: f64, high: f64) -> f64 {
    low + (high - low) * random.below(1 << 20) as f64 / f64::from(1 << 20)
}

fn direction(random: &mut Random) -> DVec3 {
    DVec3::from([0, 1, 2].map(|_| between(random, -1.0, 1.0))).try_normalize().unwrap_or(DVec3::X)
}

/// A tree of vessels: each tube parts into two thinner ones.
fn branch(tubes: &mut Vec<Tube>, random: &mut Random, from: DVec3, way: DVec3, radius: f64, depth: u32) {
    let to = from + way;
    tubes.push(Tube { from, to, radius });
    if depth == 0 {
        return;
    }
    for _ in 0..2 {
        let turned = (way.normalize() + 0.75 * direction(random)).normalize();
        branch(tubes, random, to, turned * way.length() * 0.78, radius * 0.74, depth - 1);
    }
}

fn in_ellipsoid(p: DVec3, centre: DVec3, radii: DVec3) -> f64 {
    ((p - centre) / radii).length()
}

/// Noise of a voxel, of this standard deviation.
fn noise(voxel: UVec3, deviation: f64) -> f64 {
    let mut random = Random(u64::from(voxel.x) | u64::from(voxel.y) << 20 | u64::from(voxel.z) << 40);
    random.below(2);
    // The sum of twelve even numbers is as good as normal.
    deviation * ((0..12).map(|_| between(&mut random, 0.0, 1.0)).sum::<f64>() - 6.0)
}

fn phantom(
    name: &'static str,
    dims: UVec3,
    spacing_mm: DVec3,
    value: impl Fn(UVec3) -> f64 + Sync,
) -> Phantom {
    let slab = |z: u32| {
        let value = &value;
        (0..dims.y).flat_map(move |y| (0..dims.x).map(move |x| value(UVec3::new(x, y, z)) as i16))
    };
    let voxels = (0..dims.z).into_par_iter().flat_map_iter(slab).collect();
    Phantom { name, dims, spacing_mm, voxels }
}

/// A chest in Hounsfield units, as a scanner with contrast agent gives it: skin, fat, muscle, ribs, spine, lungs with their
/// vessels, heart and aorta, on a couch.
pub fn chest() -> Phantom {
    let dims = UVec3::new(256, 208, 192);
    let mut random = Random(7);
    let mut vessels = Vec::new();
    for side in [-1.0, 1.0] {
        for _ in 0..4 {
            let way = DVec3::new(0.12 * side, 0.0, 0.0) + 0.09 * direction(&mut random);
            branch(&mut vessels, &mut random, DVec3::new(0.14 * side, 0.02, 0.0), way, 0.034, 5);
        }
    }
    let body = DVec3::new(0.92, 0.66, 9.0);
    let value = move |voxel: UVec3| {
        // Half the chest's width is 1; y to the back, z to the head.
        let p = ((voxel.as_dvec3() + 0.5) - dims.as_dvec3() / 2.0) / 128.0;
        tissue(p, body, &vessels) + noise(voxel, 22.0)
    };
    phantom("chest", dims, DVec3::splat(1.5), value)
}

fn tissue(p: DVec3, body: DVec3, vessels: &[Tube]) -> f64 {
    let skin = in_ellipsoid(p.with_z(0.0), DVec3::ZERO, body);
    if skin > 1.0 {
        let is_couch = (p.y - 0.70 - 0.05 * p.x * p.x).abs() < 0.015;
        return if is_couch { -150.0 } else { -1000.0 };
    }
    if skin > 0.985 {
        return 20.0;
    }
    bone(p).or_else(|| blood(p, vessels)).unwrap_or_else(|| soft(p, skin))
}

fn bone(p: DVec3) -> Option<f64> {
    // Ribs fall to the front; between vertebrae lie discs.
    let ring = ((p.x / 0.74).powi(2) + (p.y / 0.52).powi(2)).sqrt();
    let along = (p.z + 0.35 * (0.52 - p.y)) / 0.17;
    let from_rib = DVec3::new((ring - 1.0) * 0.6, (along - along.round()) * 0.17, 0.0).length();
    if p.y > -0.42 && from_rib < 0.034 {
        return Some(if from_rib > 0.022 { 850.0 } else { 350.0 });
    }
    let spine = DVec3::new(p.x, p.y - 0.40, 0.0).length();
    let vertebra = (p.z / 0.19 - (p.z / 0.19).round()).abs();
    if spine < 0.115 {
        return Some(match (vertebra > 0.40, spine > 0.095) {
            (true, _) => 90.0,
            (false, true) => 620.0,
            (false, false) => 260.0,
        });
    }
    let is_process = p.x.abs() < 0.02 && (0.40..0.57).contains(&p.y) && vertebra < 0.3;
    let is_sternum = p.x.abs() < 0.09 && (p.y + 0.53).abs() < 0.025 && p.z.abs() < 0.6;
    (is_process || is_sternum).then_some(480.0)
}

fn blood(p: DVec3, vessels: &[Tube]) -> Option<f64> {
    let heart = in_ellipsoid(p, DVec3::new(0.10, -0.16, -0.16), DVec3::new(0.25, 0.25, 0.30));
    let aorta = DVec3::new(p.x - 0.09, p.y - 0.24, 0.0).length();
    if heart < 0.68 || aorta < 0.062 {
        return Some(320.0);
    }
    if heart < 1.0 {
        return Some(95.0);
    }
    vessels.iter().any(|tube| tube.contains(p)).then_some(240.0)
}

fn soft(p: DVec3, skin: f64) -> f64 {
    let lung = |side: f64| in_ellipsoid(p, DVec3::new(0.36 * side, 0.0, 0.05), DVec3::new(0.27, 0.42, 0.62));
    match (lung(-1.0).min(lung(1.0)), skin) {
        (lung, _) if lung < 1.0 => -860.0,
        (_, skin) if skin > 0.90 => -95.0,
        _ => 50.0,
    }
}

/// Cell nuclei under a confocal microscope: a camera's offset and noise, and a point spread function long in z.
pub fn nuclei() -> Phantom {
    let (dims, spacing_mm) = (UVec3::new(288, 288, 96), DVec3::new(2e-4, 2e-4, 6e-4));
    let mut random = Random(11);
    // Micrometres.
    let size = dims.as_dvec3() * spacing_mm * 1e3;
    let cells: Vec<(DVec3, DVec3, f64)> = (0..90)
        .map(|_| {
            let centre = DVec3::from([0, 1, 2].map(|axis| between(&mut random, 0.0, size[axis])));
            let radii = DVec3::from([0, 1, 2].map(|_| between(&mut random, 2.2, 4.2)));
            (centre, radii, between(&mut random, 500.0, 2200.0))
        })
        .collect();
    let value = move |voxel: UVec3| {
        let p = (voxel.as_dvec3() + 0.5) * spacing_mm * 1e3;
        let texture = 0.75 + 0.25 * (2.9 * p.x).sin() * (2.3 * p.y + p.z).cos() * (1.7 * p.z).sin();
        let light: f64 = cells
            .iter()
            .map(|&(centre, radii, bright)| {
                // What is out of focus shines along z.
                let r = in_ellipsoid(p, centre, radii);
                let halo = in_ellipsoid(p, centre, radii * DVec3::new(1.15, 1.15, 1.9));
                bright
                    * (texture / (1.0 + (14.0 * (r - 1.0)).exp()) + 0.09 / (1.0 + (6.0 * (halo - 1.0)).exp()))
            })
            .sum();
        let photons = 112.0 + light;
        (photons + noise(voxel, 3.0 + 0.6 * light.sqrt())).max(0.0)
    };
    phantom("nuclei", dims, spacing_mm, value)
}
