//! Why a frame could not be drawn, and what is checked before it is.

use crate::device::DeviceError;
use crate::working_set::TraceError;
use bricks::BrickError;
use needs::Way;
use protocol::{DrawError, FrameState, Pace};

/// Why a frame could not be drawn.
#[derive(Clone, Debug, thiserror::Error)]
pub enum RenderError {
    /// The root's brick cannot be read: any other is drawn from its parent.
    #[error(transparent)]
    Brick(#[from] BrickError),
    /// The device failed.
    #[error(transparent)]
    Device(#[from] DeviceError),
    /// The frame cannot be drawn on this display.
    #[error("projector {projector}: {why}")]
    Ray {
        /// Name of the projector.
        projector: String,
        /// What is wrong with its rays.
        why: String,
    },
    /// Row planes were asked for and cannot serve the frame.
    #[error("row planes cannot draw this frame: {0}; --caster rays can")]
    Planes(&'static str),
    /// The optical model is out of bounds.
    #[error(transparent)]
    Optics(#[from] optics::OpticsError),
    /// Marks are to be depth-combined, and light is refracted.
    #[error(
        "marks cannot be depth-combined where light is refracted: the ray of a pixel does not meet them where they seem to be; let them shine through"
    )]
    Marks,
    /// The light is out of bounds.
    #[error("the light's {0}")]
    Light(optics::OutOfBounds),
    /// The quality is out of bounds.
    #[error("the quality's {0}")]
    Quality(optics::OutOfBounds),
    /// The frame's clock is out of bounds.
    #[error("the frame's {what} is {seconds} s; give a finite number{}", if *.what == "fade" { " of at least 0" } else { "" })]
    Clock {
        /// `time` or `fade`.
        what: &'static str,
        /// What it is.
        seconds: f64,
    },
    /// The trace cannot be written; the sentence is the trace's.
    #[error("{0}")]
    Trace(String),
}

impl From<TraceError> for RenderError {
    fn from(error: TraceError) -> Self {
        Self::Trace(error.to_string())
    }
}

impl From<RenderError> for DrawError {
    fn from(error: RenderError) -> Self {
        Self(error.to_string())
    }
}

/// Refuses a frame whose numbers f32 cannot hold, or whose clock is none.
pub(super) fn check(frame: &FrameState) -> Result<(), RenderError> {
    frame.optics.check()?;
    frame.light.map_or(Ok(()), |light| light.check()).map_err(RenderError::Light)?;
    frame.quality.check().map_err(RenderError::Quality)?;
    if Way::for_optics(&frame.optics) == Way::Refracted
        && frame.marks.iter().any(|mark| mark.is_depth_combined)
    {
        return Err(RenderError::Marks);
    }
    let wrong = |what, seconds| Err(RenderError::Clock { what, seconds });
    match frame.pace {
        _ if !frame.time_s.is_finite() => wrong("time", frame.time_s),
        Pace::Live { fade_s, .. } if !(fade_s >= 0.0 && fade_s.is_finite()) => wrong("fade", fade_s),
        _ => Ok(()),
    }
}
