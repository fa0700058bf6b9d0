//! Looks of computed tomography, in Hounsfield units: air -1000, lung -850 to -500, fat -100, water 0, soft tissue 20 to 80,
//! vessels with a contrast agent 150 to 450, bone above 250.

use super::draft::{Draft, Per};
use optics::Light;

/// Scanners of 12 bits write these.
const DOMAIN: (f64, f64) = (-1024.0, 3071.0);

fn light() -> Light {
    Light {
        ambient: 0.3,
        diffuse: 0.8,
        specular: 0.25,
        shininess: 32.0,
        gradient_half: 0.015,
        ..Light::default()
    }
}

fn draft(points: &[(f64, f64, [f64; 3])]) -> Draft {
    Draft { points: points.to_vec(), per: Per::Metre, domain: Some(DOMAIN), light: Some(light()) }
}

/// A veil where air turns into skin, nothing much in the soft tissue, bone solid.
pub(super) fn skin_and_bone() -> Draft {
    draft(&[
        (-600.0, 0.0, [0.80, 0.42, 0.30]),
        (-350.0, 45.0, [0.82, 0.44, 0.32]),
        (-150.0, 30.0, [0.85, 0.48, 0.35]),
        (-30.0, 8.0, [0.86, 0.48, 0.34]),
        (120.0, 8.0, [0.77, 0.26, 0.17]),
        (200.0, 40.0, [0.85, 0.55, 0.40]),
        (350.0, 700.0, [0.93, 0.82, 0.65]),
        (800.0, 3000.0, [0.98, 0.95, 0.87]),
        (1500.0, 3600.0, [1.0, 0.99, 0.96]),
        (3000.0, 5000.0, [1.0, 0.99, 0.96]),
    ])
}

/// From spongy bone on, solid.
pub(super) fn bone() -> Draft {
    draft(&[
        (150.0, 0.0, [0.75, 0.45, 0.32]),
        (250.0, 300.0, [0.91, 0.76, 0.56]),
        (450.0, 1500.0, [0.94, 0.85, 0.71]),
        (1000.0, 4000.0, [0.98, 0.95, 0.88]),
        (1500.0, 4000.0, [1.0, 0.99, 0.96]),
    ])
}

/// Lung and the walls of its airways, little of the body around, and ribs to find one's way.
pub(super) fn lung() -> Draft {
    draft(&[
        (-950.0, 0.0, [0.20, 0.30, 0.60]),
        (-850.0, 6.0, [0.35, 0.45, 0.72]),
        (-700.0, 25.0, [0.50, 0.60, 0.85]),
        (-550.0, 60.0, [0.80, 0.56, 0.60]),
        (-400.0, 40.0, [0.86, 0.48, 0.43]),
        (-250.0, 2.0, [0.80, 0.40, 0.30]),
        (100.0, 2.0, [0.86, 0.60, 0.50]),
        (250.0, 60.0, [0.95, 0.90, 0.80]),
        (600.0, 150.0, [0.95, 0.90, 0.80]),
    ])
}

/// What a contrast agent brightens, with bone less solid behind and before it.
pub(super) fn vessels() -> Draft {
    draft(&[
        (90.0, 0.0, [0.50, 0.05, 0.04]),
        (140.0, 40.0, [0.65, 0.06, 0.04]),
        (200.0, 500.0, [0.80, 0.08, 0.05]),
        (350.0, 1200.0, [0.95, 0.25, 0.12]),
        (500.0, 500.0, [0.95, 0.75, 0.55]),
        (700.0, 250.0, [0.95, 0.86, 0.72]),
        (1500.0, 250.0, [1.0, 0.98, 0.94]),
    ])
}
