//! The part of a video output that shows a projector's picture.

use glam::{IVec2, UVec2, Vec2Swizzles};
use serde::{Deserialize, Serialize};

/// Where a picture is shown.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Output {
    /// The connector's name, as the window system has it; None is the whole desktop, whatever its outputs.
    pub connector: Option<String>,
    /// The output's pixel at the top left of the picture.
    pub first_px: UVec2,
    /// How the picture lies there.
    pub turn: Turn,
}

/// How a picture lies on an output: mirrored first, then turned.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Turn {
    /// Left and right change places, as behind a mirror at the side.
    pub is_mirrored: bool,
    /// Quarter turns clockwise, from 0 to 3.
    pub quarters: u8,
}

impl Turn {
    /// The pixels of the output that a picture of so many takes.
    pub fn size(self, picture: UVec2) -> UVec2 {
        if self.quarters.is_multiple_of(2) { picture } else { picture.yx() }
    }

    /// The ways in a picture of a step to the right and of one down on the output.
    pub fn steps(self) -> [IVec2; 2] {
        let [right, down] = match self.quarters % 4 {
            0 => [IVec2::X, IVec2::Y],
            1 => [IVec2::NEG_Y, IVec2::X],
            2 => [IVec2::NEG_X, IVec2::NEG_Y],
            _ => [IVec2::Y, IVec2::NEG_X],
        };
        let mirror = if self.is_mirrored { IVec2::new(-1, 1) } else { IVec2::ONE };
        [mirror * right, mirror * down]
    }

    /// The pixel of a picture that is seen at the top left of its part of the output.
    pub fn corner(self, picture: UVec2) -> UVec2 {
        let [right, down] = self.steps();
        // Where a step leads to the left or up, the picture is entered from its far edge.
        let leads_back = (right + down).cmplt(IVec2::ZERO);
        UVec2::select(leads_back, picture - UVec2::ONE, UVec2::ZERO)
    }

    /// The pixel of a picture that is seen at a pixel of its part of the output.
    pub fn source(self, at: UVec2, picture: UVec2) -> UVec2 {
        let [right, down] = self.steps();
        let [x, y] = at.as_ivec2().to_array();
        (self.corner(picture).as_ivec2() + x * right + y * down).as_uvec2()
    }
}

impl Output {
    /// Whether pictures of these sizes in these two places share a pixel of an output.
    pub fn overlaps(&self, picture: UVec2, other: &Self, others_picture: UVec2) -> bool {
        let end = |output: &Self, picture: UVec2| output.first_px.saturating_add(output.turn.size(picture));
        self.connector == other.connector
            && self.first_px.cmplt(end(other, others_picture)).all()
            && other.first_px.cmplt(end(self, picture)).all()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What is seen of the picture `abc / def`, row by row.
    fn seen(is_mirrored: bool, quarters: u8) -> Vec<String> {
        let (turn, size) = (Turn { is_mirrored, quarters }, UVec2::new(3, 2));
        let picture = [b"abc", b"def"];
        let place = turn.size(size);
        let letter = |x, y| {
            let from = turn.source(UVec2::new(x, y), size);
            char::from(picture[from.y as usize][from.x as usize])
        };
        (0..place.y).map(|y| (0..place.x).map(|x| letter(x, y)).collect()).collect()
    }

    #[test]
    fn pictures_are_turned_clockwise() {
        assert_eq!(seen(false, 0), ["abc", "def"]);
        assert_eq!(seen(false, 1), ["da", "eb", "fc"]);
        assert_eq!(seen(false, 2), ["fed", "cba"]);
        assert_eq!(seen(false, 3), ["cf", "be", "ad"]);
    }

    #[test]
    fn mirrors_come_before_turns() {
        assert_eq!(seen(true, 0), ["cba", "fed"]);
        assert_eq!(seen(true, 1), ["fc", "eb", "da"]);
        assert_eq!(seen(true, 2), ["def", "abc"]);
        assert_eq!(seen(true, 3), ["ad", "be", "cf"]);
    }

    #[test]
    fn turned_pictures_take_other_pixels() {
        let output = |x, y, quarters| Output {
            connector: Some("DP-1".to_owned()),
            first_px: UVec2::new(x, y),
            turn: Turn { is_mirrored: false, quarters },
        };
        let size = UVec2::new(80, 60);
        assert!(!output(0, 0, 0).overlaps(size, &output(80, 0, 0), size));
        assert!(!output(0, 0, 1).overlaps(size, &output(60, 0, 0), size));
        assert!(output(0, 0, 0).overlaps(size, &output(60, 0, 1), size));
        let elsewhere = Output { connector: None, ..output(0, 0, 0) };
        assert!(!output(0, 0, 0).overlaps(size, &elsewhere, size));
    }
}
