//! A window on a desktop: all projectors' pictures side by side, and the mouse and keys that handle the volume.

use super::{Input, Request, Sheet, Sink};
use crate::FrontendError;
use display_config::Display;
use glam::DVec3;
use protocol::ScreenImage;
use screens::{Act, Acts, Button, Window};
use std::time::{Duration, Instant};
use world::{Change, Moment};

/// A drag across this many pixels is a turn by a radian.
const PIXELS_PER_RADIAN: f64 = 150.0;
/// A notch of the wheel.
const PER_NOTCH: f64 = 1.1;
/// A step of the clip plane, in widths of the screen.
const CLIP_STEP: f64 = 0.02;

/// What a person can do, for the terminal.
pub const KEYS: &str = "\
drag            turn the volume
drag with Shift, or the right button
                move it
wheel           make it larger or smaller
c               cut it by a plane that faces the viewers, or no longer
[ and ]         move the plane
l               the next look that fits the volume
n               the next item of an exhibit
space           let the script stand still, or go on
r               as the scene has it
q, Esc          leave
?               this list";

/// The window of a display.
pub struct Desktop {
    window: Window,
    sheet: Sheet,
}

/// The mouse and the keys of its window.
pub struct Hands {
    acts: Acts,
    /// Metres on the screen for a pixel of the window.
    metres_per_pixel: f64,
    clip_step_m: f64,
}

impl Desktop {
    /// Shows a sheet in a window.
    pub fn new(window: Window, sheet: Sheet) -> Self {
        Self { window, sheet }
    }
}

impl Hands {
    /// The hands at a window that shows the sheet of a display.
    pub fn new(acts: Acts, display: &Display, sheet: &Sheet) -> Self {
        let raster = display.canonical_raster();
        Self {
            acts,
            metres_per_pixel: display.width_m / f64::from(raster.width) * f64::from(sheet.shrink()),
            clip_step_m: CLIP_STEP * display.width_m,
        }
    }

    fn request(&self, act: Act) -> Option<Request> {
        let change = match act {
            Act::Drag { button: Button::Left, right_px, down_px } => {
                Change::Turn { right: right_px / PIXELS_PER_RADIAN, down: down_px / PIXELS_PER_RADIAN }
            }
            Act::Drag { button: Button::Right, right_px, down_px } => {
                Change::Move(self.metres_per_pixel * DVec3::new(right_px, -down_px, 0.0))
            }
            Act::Wheel(notches) => Change::Scale(PER_NOTCH.powf(notches)),
            Act::Letter('c') => Change::Clip,
            Act::Letter('[') => Change::MoveClip(-self.clip_step_m),
            Act::Letter(']') => Change::MoveClip(self.clip_step_m),
            Act::Letter('l') => Change::NextLook,
            Act::Letter(' ') => Change::Pause,
            Act::Letter('r') => Change::Reset,
            Act::Letter('?') => return Some(Request::Help),
            Act::Letter('q') | Act::Leave => return Some(Request::Quit),
            Act::Letter('n') => Change::NextItem,
            Act::Letter(_) => return None,
        };
        Some(change.into())
    }
}

impl Input for Hands {
    fn poll(&mut self, _: Moment, requests: &mut Vec<Request>) {
        requests.extend(self.acts.take().into_iter().filter_map(|act| self.request(act)));
    }
}

impl Sink for Desktop {
    fn show(
        &mut self,
        _: u32,
        images: &[ScreenImage],
        at: Duration,
        now: Duration,
    ) -> Result<(), FrontendError> {
        images.iter().for_each(|image| self.sheet.put(image));
        if !images.is_empty() {
            self.window.show(self.sheet.picture().clone(), Instant::now() + at.saturating_sub(now));
        }
        Ok(())
    }
}
