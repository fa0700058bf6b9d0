//! A hand that holds the volume by a tool: both move as one.

use crate::scene::HeldTool;
use glam::{DQuat, DVec3};

/// Tool and volume as they were when the hand closed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Grip {
    tool: HeldTool,
    centre_m: DVec3,
    turn: DQuat,
}

impl Grip {
    /// A tool takes hold of a volume whose centre is there, metres, display frame, and which has been turned by so much.
    pub fn new(tool: HeldTool, centre_m: DVec3, turn: DQuat) -> Self {
        Self { tool, centre_m, turn }
    }

    /// The volume's centre and turn now that the tool is here.
    pub fn moved(&self, tool: &HeldTool) -> (DVec3, DQuat) {
        let turned = tool.rotation * self.tool.rotation.inverse();
        (tool.tip_m + turned * (self.centre_m - self.tool.tip_m), (turned * self.turn).normalize())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_volume_is_where_it_was_as_the_tool_sees_it() {
        let tool = |tip_m, rotation| HeldTool { tip_m, rotation, presence: 1.0 };
        let began = tool(DVec3::new(0.1, -0.2, 0.4), DQuat::from_rotation_x(0.3));
        let (centre_m, turn) = (DVec3::new(0.0, 0.05, -0.1), DQuat::from_rotation_z(0.2));
        let grip = Grip::new(began, centre_m, turn);
        let (same, same_turn) = grip.moved(&began);
        assert!(same.distance(centre_m) < 1e-12 && same_turn.angle_between(turn) < 1e-6);
        let now =
            tool(DVec3::new(-0.3, 0.1, 0.6), DQuat::from_rotation_y(1.1) * DQuat::from_rotation_x(-0.4));
        let (centre, now_turn) = grip.moved(&now);
        let seen = |tool: &HeldTool, point: DVec3| tool.rotation.inverse() * (point - tool.tip_m);
        assert!(seen(&now, centre).distance(seen(&began, centre_m)) < 1e-12);
        let turn_seen = |tool: &HeldTool, turn: DQuat| tool.rotation.inverse() * turn;
        assert!(turn_seen(&now, now_turn).angle_between(turn_seen(&began, turn)) < 1e-6);
    }
}
