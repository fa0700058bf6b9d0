//! The state of one frame: all that a back-end must know to draw it.

use crate::{Mark, VolumeRef};
use glam::{DAffine3, DVec3};
use optics::{DebugView, Light, Optics, Quality};
use serde::{Deserialize, Serialize};

/// How a frame gets its detail.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Pace {
    /// It waits until nothing is missing.
    #[default]
    Complete,
    /// It shows what is there; detail comes with later frames.
    Live {
        /// Bytes of bricks that one frame may move to the device.
        upload_bytes: u64,
        /// Time in which detail appears or goes, seconds; 0 is at once.
        fade_s: f64,
    },
}

/// A quarter of a picture's pixels: those of one class of (x mod 2, y mod 2).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum SubFrame {
    /// Those at (0, 0).
    First,
    /// Their diagonal neighbours, at (1, 1).
    Diagonal,
    /// Those at (1, 0).
    Right,
    /// Those at (0, 1).
    Below,
}

impl SubFrame {
    /// In the order in which frames cast them.
    pub const ORDER: [Self; 4] = [Self::First, Self::Diagonal, Self::Right, Self::Below];

    /// That of a frame by its number: the same on all back-ends.
    pub fn of_frame(index: u32) -> Self {
        Self::ORDER[index as usize % Self::ORDER.len()]
    }

    /// Column and row of its first pixel.
    pub fn first_pixel(self) -> [u32; 2] {
        match self {
            Self::First => [0, 0],
            Self::Diagonal => [1, 1],
            Self::Right => [1, 0],
            Self::Below => [0, 1],
        }
    }
}

/// A part of the way to a complete picture, which is cast in [`Refinement::UNITS`] units of about the same number of rays:
/// first few all over the picture, then those between.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Refinement {
    /// Which picture: a new number begins it anew.
    pub configuration: u32,
    /// Units of it that are cast when the frame is done.
    pub to: u32,
}

impl Refinement {
    /// Units of a complete picture.
    pub const UNITS: u32 = 64;
}

/// One frame, the same for every back-end.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct FrameState {
    /// Frame number, from 0.
    pub index: u32,
    /// Time of the frame on the scene's clock, seconds.
    pub time_s: f64,
    /// The virtual observer V, display frame, metres; z > 0.
    pub observer_in_display: DVec3,
    /// η in [0, 1]: 0 one perspective view, 1 full horizontal parallax.
    pub eta: f64,
    /// Volume frame (finest voxels) to display frame (metres).
    pub display_from_volume: DAffine3,
    /// What scalars look like.
    pub optics: Optics,
    /// Gradient shading; None shows the plain colours.
    pub light: Option<Light>,
    /// How closely the continuous model is followed.
    pub quality: Quality,
    /// The volume; None is that of the setup. Another one than in the frame before is opened first.
    pub volume: Option<VolumeRef>,
    /// How it gets its detail.
    pub pace: Pace,
    /// The pixels that it casts, if it is live: the others are reconstructed from these and from the frames before. None
    /// casts them all, as a complete frame does.
    pub sub_frame: Option<SubFrame>,
    /// How far its pictures are cast: the frame goes on with those of the frame before if that was of the same configuration.
    /// None casts them as `sub_frame` says, which is None where this is not.
    pub refinement: Option<Refinement>,
    /// Whether row planes are welcome for a display of any size, where nobody chose the caster.
    pub welcomes_planes: bool,
    /// What is shown of the working set instead of the pictures.
    pub debug: Option<DebugView>,
    /// What is drawn over the pictures, one after the other.
    pub marks: Vec<Mark>,
}

impl FrameState {
    /// Frame 0 of a scene that stands still: unlit, at default quality, complete, at η = 1.
    ///
    /// `observer_in_display` is in metres; `display_from_volume` leads from finest voxels to metres.
    pub fn still(observer_in_display: DVec3, display_from_volume: DAffine3, optics: Optics) -> Self {
        Self {
            index: 0,
            time_s: 0.0,
            observer_in_display,
            eta: 1.0,
            display_from_volume,
            optics,
            light: None,
            quality: Quality::default(),
            volume: None,
            pace: Pace::Complete,
            sub_frame: None,
            refinement: None,
            welcomes_planes: false,
            debug: None,
            marks: Vec::new(),
        }
    }

    /// Whether rays see the same in another frame: numbers and times do not matter, nor which pixels are cast and by what, nor
    /// what is drawn over them.
    pub fn is_seen_as(&self, other: &Self) -> bool {
        let seen = |frame: &Self| Self {
            index: 0,
            time_s: 0.0,
            sub_frame: None,
            refinement: None,
            welcomes_planes: false,
            marks: Vec::new(),
            ..frame.clone()
        };
        seen(self) == seen(other)
    }

    /// Edge of the finest voxel in the display frame: the cube root of its volume, metres.
    pub fn voxel_m(&self) -> f64 {
        self.display_from_volume.matrix3.determinant().abs().cbrt()
    }
}
