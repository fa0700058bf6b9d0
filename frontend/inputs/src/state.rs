//! What a source said last, so that only changes become events, and nothing stays pressed when it goes.

use crate::event::What;
use crate::reading::Said;

/// Numbers of sensors, buttons and axes.
const NUMBERS: usize = 256;

/// The latest of each sensor, button and axis.
pub(crate) struct State {
    is_tracked: [bool; NUMBERS],
    is_down: [bool; NUMBERS],
    axes: [f64; NUMBERS],
}

impl State {
    /// No target, no button down, all axes at rest.
    pub const fn new() -> Self {
        Self { is_tracked: [false; NUMBERS], is_down: [false; NUMBERS], axes: [0.0; NUMBERS] }
    }

    /// What a saying changes. Poses always count: a target that rests is there.
    pub fn change(&mut self, said: Said) -> Option<What> {
        match said {
            Said::Pose(sensor, pose) => {
                let was_tracked =
                    std::mem::replace(&mut self.is_tracked[usize::from(sensor)], pose.is_some());
                (was_tracked || pose.is_some()).then_some(What::Pose { sensor, pose })
            }
            Said::Button(index, is_down) => {
                let was_down = std::mem::replace(&mut self.is_down[usize::from(index)], is_down);
                (was_down != is_down).then_some(What::Button { index, is_down })
            }
            Said::Axis(index, value) => {
                let before = std::mem::replace(&mut self.axes[usize::from(index)], value);
                (before != value).then_some(What::Axis { index, value })
            }
        }
    }

    /// All targets lost, all buttons up, all axes at rest: the changes that this takes.
    pub fn release(&mut self) -> Vec<What> {
        let rest =
            |number: u8| [Said::Pose(number, None), Said::Button(number, false), Said::Axis(number, 0.0)];
        (0..=u8::MAX).flat_map(rest).filter_map(|said| self.change(said)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Pose;
    use glam::{DQuat, DVec3};

    #[test]
    fn only_changes_count_and_all_is_let_go_in_the_end() {
        let pose = Some(Pose::new(DVec3::ONE, DQuat::IDENTITY).unwrap());
        let mut state = State::new();
        let changes = [
            (Said::Pose(0, None), false),
            (Said::Pose(3, pose), true),
            (Said::Pose(3, pose), true),
            (Said::Pose(3, None), true),
            (Said::Pose(3, None), false),
            (Said::Pose(3, pose), true),
            (Said::Button(7, false), false),
            (Said::Button(7, true), true),
            (Said::Button(7, true), false),
            (Said::Axis(1, 0.5), true),
            (Said::Axis(1, 0.5), false),
        ];
        for (said, is_change) in changes {
            assert_eq!(state.change(said).is_some(), is_change, "{said:?}");
        }
        let released = [
            What::Axis { index: 1, value: 0.0 },
            What::Pose { sensor: 3, pose: None },
            What::Button { index: 7, is_down: false },
        ];
        assert_eq!(state.release(), released);
        assert_eq!(state.release(), []);
    }
}
