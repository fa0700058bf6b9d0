//! The keyframes of a scene file.

use crate::scene::edits::Edits;
use crate::scene::error::Checked;
use crate::scene::file::KeyframeTable;
use crate::scene::look::DataLook;
use crate::scene::motion::Direction;
use crate::scene::placement::rotation_from_deg;
use crate::scene::text::SceneText;
use crate::scene::{Band, Motion};
use std::ops::Range;

/// What of a scene its keyframes may change.
pub(super) struct Changeable<'a> {
    /// The look that the file gives.
    pub look: Option<&'a DataLook>,
    pub bands: &'a [Band],
    pub has_tool: bool,
    pub has_picker: bool,
}

impl SceneText {
    pub(super) fn motion(
        &self,
        keyframes: &[KeyframeTable],
        scene: &Changeable<'_>,
    ) -> Checked<(Motion, Edits)> {
        let (mut motion, mut edits) = (Motion::default(), Edits::default());
        let mut last = f64::NEG_INFINITY;
        for key in keyframes {
            let time_s = self.finite(&key.time_s)?;
            if time_s <= last {
                return Err(self.wrong(
                    key.time_s.span(),
                    "it is not after the previous keyframe; sort keyframes by time",
                ));
            }
            last = time_s;
            self.add_movement(&mut motion, key, time_s, scene.has_tool)?;
            self.check_edit(key, scene)?;
            self.add_edit(&mut edits, key, time_s, scene.bands)?;
        }
        Ok((motion, edits))
    }

    fn add_movement(
        &self,
        motion: &mut Motion,
        key: &KeyframeTable,
        time_s: f64,
        has_tool: bool,
    ) -> Checked<()> {
        if let (Some(moved), false) = (key.tool_tip_m.as_ref().or(key.tool_axis.as_ref()), has_tool) {
            return Err(self.wrong(moved.span(), "the scene has no tool; add a [tool] table"));
        }
        if let Some(observer) = &key.observer_m {
            motion.observer_m.push(time_s, self.before_screen(observer)?);
        }
        if let Some(centre) = &key.centre_m {
            motion.centre_m.push(time_s, self.point(centre)?);
        }
        if let Some(deg) = &key.rotation_deg {
            motion.rotation.push(time_s, rotation_from_deg(self.point(deg)?));
        }
        if let Some(tip) = &key.tool_tip_m {
            motion.tool_tip_m.push(time_s, self.point(tip)?);
        }
        if let Some(axis) = &key.tool_axis {
            motion.tool_axis.push(time_s, Direction(self.direction(axis)?));
        }
        Ok(())
    }

    /// Whether the scene has what the keyframe edits.
    fn check_edit(&self, key: &KeyframeTable, scene: &Changeable<'_>) -> Checked<()> {
        let missing = |span: Option<Range<usize>>, is_there: bool, message: &str| match span {
            Some(span) if !is_there => Err(self.wrong(span, message)),
            _ => Ok(()),
        };
        let curves = [&key.extinction, &key.colour, &key.refraction].into_iter().flatten().next();
        let optics = "it edits [optics], which the scene leaves to the volume; add that table";
        missing(curves.map(|points| points.span()), scene.look.is_some(), optics)?;
        let has_mimda = scene.look.is_some_and(|look| look.mimda.is_some());
        let mimda = "the scene accumulates no importance; add optics.importance and a [mimda] table";
        missing(key.importance.as_ref().map(|points| points.span()), has_mimda, mimda)?;
        missing(key.gamma.as_ref().map(|gamma| gamma.span()), has_mimda, mimda)?;
        let picker = "the scene has no band picker; add an [[enhancer]] of that kind";
        missing(key.pick.as_ref().map(|pick| pick.span()), scene.has_picker, picker)
    }

    fn add_edit(&self, edits: &mut Edits, key: &KeyframeTable, time_s: f64, bands: &[Band]) -> Checked<()> {
        if let Some(points) = &key.extinction {
            edits.extinction.push(time_s, self.extinction(points)?);
        }
        if let Some(points) = &key.colour {
            edits.colour.push(time_s, self.colour(points)?);
        }
        if let Some(points) = &key.importance {
            edits.importance.push(time_s, self.importance(points)?);
        }
        if let Some(points) = &key.refraction {
            edits.refraction.push(time_s, self.refraction(points)?);
        }
        if let Some(gamma) = &key.gamma {
            edits.gamma.push(time_s, self.within(gamma, 0.0..=1.0)?);
        }
        if let Some(name) = &key.pick {
            edits.pick.push(time_s, self.band(name, bands)?);
        }
        Ok(())
    }
}
