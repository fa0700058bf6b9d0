//! Snell's law at a surface where the refraction index jumps.

use glam::DVec3;

/// Where light goes that meets a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Passed {
    /// Through it.
    Through(DVec3),
    /// Back: beyond the critical angle the surface is a mirror.
    Mirrored(DVec3),
}

/// Light along `direction` (unit) from the index `from` to the index `to`, through a surface with the gradient
/// `gradient`, of whichever sign; straight on where that has no direction.
pub fn pass(direction: DVec3, gradient: DVec3, from: f64, to: f64) -> Passed {
    let Some(normal) = gradient.try_normalize() else { return Passed::Through(direction) };
    let normal = if normal.dot(direction) < 0.0 { -normal } else { normal };
    let ratio = from / to;
    let along = normal.dot(direction);
    let tangent = ratio * (direction - along * normal);
    let square = 1.0 - tangent.length_squared();
    if square < 0.0 {
        return Passed::Mirrored((direction - 2.0 * along * normal).normalize());
    }
    Passed::Through((tangent + square.sqrt() * normal).normalize())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn light_comes_back_the_way_it_went_and_is_mirrored_beyond_the_critical_angle() {
        let (glass, normal) = (1.5, DVec3::new(0.6, 0.0, 0.8));
        let direction = DVec3::new(0.3, 0.4, 0.9).normalize();
        let Passed::Through(inside) = pass(direction, normal, 1.0, glass) else { panic!("it enters") };
        let [out, within] = [direction, inside].map(|v| v.cross(normal).length());
        assert!((out - glass * within).abs() < 1e-15);
        let Passed::Through(back) = pass(-inside, normal, glass, 1.0) else { panic!("it leaves again") };
        assert!((back + direction).length() < 1e-15);
        let grazing = DVec3::new(0.8, 0.05, -0.6).normalize();
        assert!(
            matches!(pass(grazing, normal, glass, 1.0), Passed::Mirrored(v) if (v.dot(normal) + grazing.dot(normal)).abs() < 1e-15)
        );
        assert_eq!(pass(direction, DVec3::ZERO, 1.0, glass), Passed::Through(direction));
    }
}
