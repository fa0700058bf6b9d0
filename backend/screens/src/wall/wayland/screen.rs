//! An output of a Wayland desktop.

use crate::{Mode, OutputInfo, Rectangle};
use wayland_client::WEnum;
use wayland_client::protocol::wl_output::{self, Transform, WlOutput};

/// What it tells of itself.
pub struct Screen {
    pub output: WlOutput,
    /// Its number on the desktop.
    pub global: u32,
    /// Its connector's.
    pub name: Option<String>,
    product: String,
    /// Where it is on the desktop.
    at: [i32; 2],
    /// Whether pictures are turned by a quarter on their way.
    is_upright: bool,
    now: Option<Mode>,
    modes: Vec<Mode>,
}

impl Screen {
    pub fn new(output: WlOutput, global: u32) -> Self {
        let (name, product, modes) = (None, String::new(), Vec::new());
        Self { output, global, name, product, at: [0; 2], is_upright: true, now: None, modes }
    }

    /// It is at a place on the desktop.
    pub fn place(&mut self, x: i32, y: i32) {
        self.at = [x, y];
    }

    /// It tells something of itself. Whether it has told all.
    pub fn take(&mut self, event: wl_output::Event) -> bool {
        match event {
            wl_output::Event::Geometry { make, model, transform, .. } => {
                self.product = [make, model].join(" ").replace("Unknown", "").trim().to_owned();
                self.is_upright = !matches!(
                    transform,
                    WEnum::Value(
                        Transform::_90 | Transform::_270 | Transform::Flipped90 | Transform::Flipped270
                    )
                );
            }
            wl_output::Event::Mode { flags, width, height, refresh } => {
                let pixels = |n: i32| u16::try_from(n).unwrap_or_default();
                let mode = Mode {
                    width: pixels(width),
                    height: pixels(height),
                    rate_hz: f64::from(refresh) / 1000.0,
                };
                if flags.into_result().is_ok_and(|flags| flags.contains(wl_output::Mode::Current)) {
                    self.now = Some(mode);
                }
                if !self.modes.contains(&mode) {
                    self.modes.push(mode);
                }
            }
            wl_output::Event::Name { name } => self.name = Some(name),
            wl_output::Event::Done => return true,
            _ => {}
        }
        false
    }

    /// Pixels along x and y, as they are seen. None where it does not say.
    pub fn size(&self) -> Option<[u16; 2]> {
        let Mode { width, height, .. } = self.now?;
        Some(if self.is_upright { [width, height] } else { [height, width] })
    }

    pub fn info(&self) -> OutputInfo {
        let [x, y] = self.at.map(|n| i16::try_from(n).unwrap_or(i16::MAX));
        let shows = self.now.zip(self.size());
        OutputInfo {
            connector: self.name.clone().unwrap_or_default(),
            is_connected: true,
            product: (!self.product.is_empty()).then(|| self.product.clone()),
            shows: shows.map(|(mode, [width, height])| (Rectangle { x, y, width, height }, mode)),
            modes: self.modes.clone(),
        }
    }
}
