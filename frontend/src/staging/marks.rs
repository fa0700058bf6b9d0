//! What is drawn of tools, and written.

use super::carried::held;
use display_config::Display;
use exhibit::MarkWish;
use glam::{DQuat, DVec3};
use optics::Enhancer;
use protocol::{Mark, MarkShape, Paint};
use std::f64::consts::TAU;
use world::{Cast, Choice, Refusal, ShownTool, Stage, ToolKind, VisitorId};

/// Sizes, in hundredths of the screen's height: half a line's width, the length of a tool's body, its sign, the reach of a clip
/// plane's frame, and the em of what is written.
const LINE: f64 = 0.4;
const BODY: f64 = 20.0;
const SIGN: f64 = 6.0;
const FRAME: f64 = 25.0;
const EM: f64 = 6.0;
/// A text can be read while its em is this many times what the display resolves.
const READABLE: f64 = 8.0;
/// Corners of a circle.
const CORNERS: u32 = 48;
/// Behind what is written.
const BACKING: Paint = Paint { rgb: [0.0; 3], opacity: 0.6 };
/// What is written of nobody.
const WHITE: [f32; 3] = [0.9; 3];

/// Draws a stage.
pub(super) struct Artist<'a> {
    pub wish: MarkWish,
    pub display: &'a Display,
    pub cast: &'a Cast,
    pub stage: &'a Stage,
    /// What tools carry, in their places.
    pub carried: &'a [Enhancer],
    pub caption: &'a str,
    /// What visitors read of a choice.
    pub words: &'a dyn Fn(Choice) -> String,
}

impl Artist<'_> {
    /// The marks of a frame, the nearest last.
    pub(super) fn marks(&self) -> Vec<Mark> {
        let mut marks = Vec::new();
        if self.wish.captions && !self.caption.trim().is_empty() {
            marks.push(self.caption());
        }
        let mut tools: Vec<_> = self.stage.tools.iter().collect();
        tools.sort_by(|a, b| a.tip_m.z.total_cmp(&b.tip_m.z));
        for tool in tools {
            if self.wish.tools {
                self.tool(tool, &mut marks);
            }
            // Where a menu is open, its entries are what is to be read.
            if self.wish.names && self.stage.menus.iter().all(|menu| menu.tool != tool.tool) {
                self.names(tool, &mut marks);
            }
        }
        if self.wish.tools || self.wish.names || self.wish.captions {
            self.stage.menus.iter().for_each(|menu| self.menu(menu, &mut marks));
        }
        marks
    }

    fn caption(&self) -> Mark {
        let em_m = EM * self.unit_m();
        let base_in_display = DVec3::new(0.0, -0.5 * self.display.height_m + 0.8 * em_m, 0.0);
        let shape =
            MarkShape::Label { text: self.caption.to_owned(), base_in_display, em_m, backing: Some(BACKING) };
        Mark { shape, paint: Paint { rgb: WHITE, opacity: 1.0 }, is_depth_combined: false }
    }

    /// What sizes count in, metres.
    fn unit_m(&self) -> f64 {
        0.01 * self.display.height_m
    }

    /// Where a text of this em is written that belongs to a place: as near to that as it can be read, on the way to the screen as
    /// the display's observer sees it.
    pub(super) fn readable(&self, place: DVec3, em_m: f64) -> DVec3 {
        let (resolution, observer) = (self.display.resolution(), self.display.observer_in_display);
        let deepest_m = (em_m / READABLE - resolution.at(0.0)) / (resolution.at(1.0) - resolution.at(0.0));
        let z = place.z.clamp(-deepest_m.max(0.0), deepest_m.max(0.0));
        let along = (observer.z - z) / (observer.z - place.z);
        // At the observer's depth and behind it nothing is seen.
        if along.is_finite() && along > 0.0 { observer + along * (place - observer) } else { place }
    }

    pub(super) fn paint(&self, tool: &ShownTool, opacity: f64) -> Paint {
        let visitor = self.cast.visitor(self.cast.holder(tool.tool));
        Paint {
            rgb: visitor.colour.map(|part| part.clamp(0.0, 1.0) as f32),
            opacity: (tool.presence * opacity).clamp(0.0, 1.0) as f32,
        }
    }

    /// Its body, and a sign of what it does.
    fn tool(&self, tool: &ShownTool, marks: &mut Vec<Mark>) {
        let (tip, unit_m) = (tool.tip_m, self.unit_m());
        let axis = held(tool).axis();
        let width = if tool.grabs || tool.moves_window { 2.0 } else { 1.0 };
        let mut stroke = |points: Vec<DVec3>, radius: f64, opacity: f64| {
            let shape = MarkShape::Stroke { points_in_display: points, radius_m: radius * unit_m };
            let (paint, is_depth_combined) = (self.paint(tool, opacity), self.wish.depth_combined);
            marks.push(Mark { shape, paint, is_depth_combined });
        };
        stroke(vec![tip - BODY * unit_m * axis, tip], width * LINE, 0.9);
        stroke(vec![tip], 2.0 * width * LINE, 1.0);
        let across = |x: f64, y: f64| tip + tool.rotation * DVec3::new(x, y, 0.0);
        let circle = |radius_m: f64, turn: DQuat| -> Vec<DVec3> {
            (0..=CORNERS).map(|i| tip + turn * way(i % CORNERS, CORNERS) * radius_m).collect()
        };
        match tool.kind {
            ToolKind::Pointer => stroke(vec![tip, tip + 2.0 * BODY * unit_m * axis], 0.5 * LINE, 0.5),
            ToolKind::Light => {
                for i in 0..8 {
                    let way = way(i, 8);
                    stroke(vec![tip + SIGN * 0.5 * unit_m * way, tip + SIGN * unit_m * way], LINE, 1.0);
                }
            }
            ToolKind::ClipPlane => {
                let half = FRAME * unit_m;
                let corners =
                    [(-half, -half), (half, -half), (half, half), (-half, half)].map(|(x, y)| across(x, y));
                stroke(corners.iter().copied().chain([corners[0]]).collect(), LINE, 0.8);
            }
            ToolKind::Probe => {
                // What it opens is a ball: it looks the same from everywhere.
                stroke(circle(self.probe_radius_m(tip).unwrap_or(SIGN * unit_m), DQuat::IDENTITY), LINE, 0.8);
            }
            ToolKind::BandPicker => stroke(circle(SIGN * unit_m, tool.rotation), LINE, 0.9),
            ToolKind::LayerOpacity => {
                stroke(circle(SIGN * unit_m, tool.rotation), LINE, 0.9);
                stroke(circle(0.6 * SIGN * unit_m, tool.rotation), LINE, 0.9);
            }
        }
    }

    fn probe_radius_m(&self, tip: DVec3) -> Option<f64> {
        self.carried.iter().find_map(|enhancer| match enhancer {
            Enhancer::Probe(probe) if probe.centre_in_display == tip => Some(probe.radius_m),
            _ => None,
        })
    }

    /// Whose it is, and what; and what its holder is told.
    fn names(&self, tool: &ShownTool, marks: &mut Vec<Mark>) {
        let holder = self.cast.holder(tool.tool);
        let name = |visitor: VisitorId| self.cast.visitor(visitor).name.as_str();
        let mut lines = vec![format!("{}: {}", name(holder), kind_name(tool.kind))];
        lines.extend(self.stage.refusals.iter().filter_map(|refusal| match *refusal {
            Refusal::Held { wanted_by, held_by } => {
                (wanted_by == holder).then(|| format!("{} has it", name(held_by)))
            }
            Refusal::ChangedSince { wanted_by, changed_by } => {
                (wanted_by == holder).then(|| format!("{} has changed it since", name(changed_by)))
            }
        }));
        let em_m = EM * self.unit_m();
        let place = self.readable(tool.tip_m, em_m);
        let behind = Paint { opacity: BACKING.opacity * tool.presence as f32, ..BACKING };
        for (text, line) in lines.into_iter().rev().zip(0..) {
            let base_in_display = place + DVec3::Y * em_m * (1.2 + 1.3 * f64::from(line));
            let shape = MarkShape::Label { text, base_in_display, em_m, backing: Some(behind) };
            marks.push(Mark { shape, paint: self.paint(tool, 1.0), is_depth_combined: false });
        }
    }
}

/// The direction of a corner of a circle of so many, parallel to the screen.
fn way(corner: u32, of: u32) -> DVec3 {
    let (sin, cos) = libm::sincos(f64::from(corner) / f64::from(of) * TAU);
    DVec3::new(cos, sin, 0.0)
}

/// What visitors read of a kind of tool.
pub(super) fn kind_name(kind: ToolKind) -> &'static str {
    match kind {
        ToolKind::Pointer => "pointer",
        ToolKind::Light => "light",
        ToolKind::ClipPlane => "clip plane",
        ToolKind::Probe => "probe",
        ToolKind::BandPicker => "band picker",
        ToolKind::LayerOpacity => "layer opacity",
    }
}
