//! One step of the embedded Runge–Kutta pair of Dormand and Prince (1980), orders 5 and 4.

use glam::DVec3;

/// A point of a way, with the direction there (unit).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose {
    /// Metres, display frame.
    pub point: DVec3,
    /// Unit vector, display frame.
    pub direction: DVec3,
}

/// Where a step leads.
#[derive(Clone, Copy, Debug)]
pub struct Stepped {
    /// The end, by the method of order 5.
    pub end: Pose,
    /// How far the method of order 4 lies from it: metres, and length of the direction's difference.
    pub error: (f64, f64),
}

const MATRIX: [[f64; 6]; 6] = [
    [1.0 / 5.0, 0.0, 0.0, 0.0, 0.0, 0.0],
    [3.0 / 40.0, 9.0 / 40.0, 0.0, 0.0, 0.0, 0.0],
    [44.0 / 45.0, -56.0 / 15.0, 32.0 / 9.0, 0.0, 0.0, 0.0],
    [19372.0 / 6561.0, -25360.0 / 2187.0, 64448.0 / 6561.0, -212.0 / 729.0, 0.0, 0.0],
    [9017.0 / 3168.0, -355.0 / 33.0, 46732.0 / 5247.0, 49.0 / 176.0, -5103.0 / 18656.0, 0.0],
    [35.0 / 384.0, 0.0, 500.0 / 1113.0, 125.0 / 192.0, -2187.0 / 6784.0, 11.0 / 84.0],
];
/// The weights of order 5 less those of order 4.
const DIFFERENCE: [f64; 7] =
    [71.0 / 57600.0, 0.0, -71.0 / 16695.0, 71.0 / 1920.0, -17253.0 / 339200.0, 22.0 / 525.0, -1.0 / 40.0];

/// A step of `length` metres of dx/dt = v, dv/dt = `turning`(x, v).
pub fn step<E>(start: Pose, length: f64, turning: &impl Fn(Pose) -> Result<DVec3, E>) -> Result<Stepped, E> {
    let mut velocities = [DVec3::ZERO; 7];
    let mut turnings = [DVec3::ZERO; 7];
    let mut at = start;
    for stage in 0..7 {
        velocities[stage] = at.direction;
        turnings[stage] = turning(at)?;
        if let Some(row) = MATRIX.get(stage) {
            at.point = start.point + length * sum(row, &velocities);
            at.direction = start.direction + length * sum(row, &turnings);
        }
    }
    let error = (length * sum(&DIFFERENCE, &velocities)).length();
    let turn_error = (length * sum(&DIFFERENCE, &turnings)).length();
    // A way that nothing turns keeps its direction to the bit.
    let is_straight = turnings.iter().all(|turning| *turning == DVec3::ZERO);
    let direction = if is_straight { start.direction } else { at.direction.normalize() };
    Ok(Stepped { end: Pose { point: at.point, direction }, error: (error, turn_error) })
}

fn sum(weights: &[f64], vectors: &[DVec3; 7]) -> DVec3 {
    weights.iter().zip(vectors).map(|(weight, vector)| *weight * *vector).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A direction that turns evenly goes round a circle.
    fn miss(steps: u32) -> f64 {
        let turning = |pose: Pose| Ok::<_, ()>(DVec3::Z.cross(pose.direction));
        let mut pose = Pose { point: DVec3::ZERO, direction: DVec3::X };
        for _ in 0..steps {
            pose = step(pose, 1.0 / f64::from(steps), &turning).unwrap().end;
        }
        (pose.point - DVec3::new(1.0_f64.sin(), 1.0 - 1.0_f64.cos(), 0.0)).length()
    }

    #[test]
    fn a_circle_is_followed_to_order_five() {
        let (coarse, fine) = (miss(8), miss(16));
        assert!(coarse < 1e-6 && fine < coarse / 24.0, "{coarse:e} {fine:e}");
    }
}
