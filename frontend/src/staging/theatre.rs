//! A world with its pieces: things that happen in, frames out.

use super::carried::{carried, held, light};
use super::marks::Artist;
use super::menu::{menu_size, words};
use super::piece::Piece;
use crate::scene::{CLIP_CONTEXT, Handled, HeldTool, LookName, Scene, SceneError, VolumeFacts};
use display_config::Display;
use exhibit::MarkWish;
use glam::DVec3;
use optics::{ClipPlane, Enhancer, MOST_ENHANCERS};
use protocol::{FrameState, Pace, SubFrame, VolumeRef};
use std::time::Duration;
use world::{Cast, Deed, Item, Moment, Programme, Rules, Stage, World};

/// Times that differ by less are the same, seconds: steps of a rate add up to a little less or more.
const LEAST_STEP_S: f64 = 1e-6;

/// How far a volume's centre may be from where its scene has it, in widths of the screen.
const FARTHEST: f64 = 5.0;

/// Who and what is on.
#[derive(Clone, Debug)]
pub struct Ensemble {
    /// Who takes part.
    pub cast: Cast,
    /// What they may do.
    pub rules: Rules,
    /// What is shown, with how long and what presets each has; at least one.
    pub pieces: Vec<(Piece, Item)>,
}

/// A display's world: what happens to it, and its frames. The same deeds at the same times give the same frames.
#[derive(Clone, Debug)]
pub struct Theatre {
    world: World,
    pieces: Vec<Piece>,
    display: Display,
    pace: Pace,
    has_sub_frames: bool,
    marks: MarkWish,
    /// Whether the first tool holds that of the scene.
    lends_tool: bool,
    /// Where that is, once anybody has ever held it.
    lent: Option<HeldTool>,
    /// When the last frame is seen.
    seen_at: Duration,
}

impl Theatre {
    /// One in which nothing has happened yet. Its frames get their detail at this pace.
    pub fn new(ensemble: Ensemble, display: Display, pace: Pace) -> Self {
        let Ensemble { cast, rules, pieces } = ensemble;
        let (pieces, items) = pieces.into_iter().unzip();
        let world = World::new(cast, Programme(items), rules, menu_size(&display));
        Self {
            world,
            pieces,
            display,
            pace,
            has_sub_frames: true,
            marks: MarkWish::NONE,
            lends_tool: false,
            lent: None,
            seen_at: Duration::ZERO,
        }
    }

    /// One piece, as its scene is, with one tool in one hand, which holds that of the scene.
    pub fn of_one(piece: Piece, cast: Cast, display: Display, pace: Pace) -> Self {
        let item = piece.item(Vec::new(), None);
        let rules = Rules { farthest_m: FARTHEST * display.width_m, ..Rules::default() };
        let ensemble = Ensemble { cast, rules, pieces: vec![(piece, item)] };
        Self { lends_tool: true, ..Self::new(ensemble, display, pace) }
    }

    /// Its frames cast all pixels, or a quarter of them.
    #[must_use]
    pub fn with_sub_frames(self, has_sub_frames: bool) -> Self {
        Self { has_sub_frames, ..self }
    }

    /// This is drawn over its frames, which without it are the volume alone.
    #[must_use]
    pub fn with_marks(self, marks: MarkWish) -> Self {
        Self { marks, ..self }
    }

    /// The display that it is shown on.
    pub fn display(&self) -> &Display {
        &self.display
    }

    /// What is shown now.
    pub fn stage(&self) -> &Stage {
        self.world.stage()
    }

    /// The laws that the world is against: none, unless this program has an error.
    pub fn faults(&self) -> Vec<&'static str> {
        self.world.faults()
    }

    fn piece(&self) -> &Piece {
        &self.pieces[self.world.stage().item]
    }

    /// What people call the scene that is shown.
    pub fn name(&self) -> &str {
        self.piece().name()
    }

    /// What visitors read of it.
    pub fn title(&self) -> &str {
        self.world.title()
    }

    /// The scene that is shown, in its look.
    pub fn scene(&self) -> &Scene {
        self.piece().scene(self.world.stage().look)
    }

    /// What its volume is.
    pub fn facts(&self) -> &VolumeFacts {
        self.piece().facts()
    }

    /// Its volume.
    pub fn volume_ref(&self) -> VolumeRef {
        self.piece().volume_ref()
    }

    /// The look that is shown, where it is one of the library.
    pub fn look(&self) -> Option<LookName> {
        self.piece().look_name(self.world.stage().look)
    }

    /// Something happens.
    pub fn apply(&mut self, deed: &Deed) {
        self.world.apply(deed);
    }

    /// Whether there is one piece whose script has come to its end. A scene in which nothing moves has none.
    pub fn is_over(&self) -> bool {
        let [piece] = &self.pieces[..] else { return false };
        let script_s = self.world.stage().script_s;
        piece.script_end_s().is_some_and(|end_s| script_s + LEAST_STEP_S >= end_s)
    }

    /// The frame of a moment: not before that of the frame that was made before it.
    ///
    /// # Errors
    /// The look does not fit the volume.
    pub fn frame(&mut self, index: u32, moment: Moment) -> Result<FrameState, SceneError> {
        let pieces = &self.pieces;
        self.world.step(moment, |item, script_s| pieces[item].centre_at(script_s));
        self.seen_at = self.seen_at.max(moment.seen_at);
        if self.lends_tool {
            let tool = self.world.stage().tools.first().map(held);
            // One that is gone leaves nothing of what it carries.
            self.lent = tool.or(self.lent.map(|lent| HeldTool { presence: 0.0, ..lent }));
        }
        let (stage, piece) = (self.world.stage(), self.piece());
        let scene = piece.scene(stage.look);
        let mut handled = Handled {
            handling: stage.handling,
            tool: self.lent,
            carried: Vec::new(),
            light: light(stage),
            window: stage.window,
            picked: stage.band.and(piece.band(stage.band)),
        };
        let room = MOST_ENHANCERS.saturating_sub(scene.enhancers.len());
        handled.carried.extend(self.clip_plane(stage).filter(|_| room > 0));
        let room = room - handled.carried.len();
        handled.carried.extend(carried(stage, piece, room));
        let artist = Artist {
            wish: self.marks,
            display: &self.display,
            cast: self.world.cast(),
            stage,
            carried: &handled.carried,
            caption: self.world.caption(),
            words: &|choice| words(choice, piece, self.world.programme(), stage.item),
        };
        let frame = scene.frame_at(index, stage.script_s, &handled, &self.display, piece.facts())?;
        Ok(FrameState {
            // The working set's clock goes on while the script stands still.
            time_s: self.seen_at.as_secs_f64(),
            volume: Some(piece.volume_ref()),
            pace: self.pace,
            sub_frame: self.has_sub_frames.then(|| SubFrame::of_frame(index)),
            marks: artist.marks(),
            ..frame
        })
    }

    /// The clip plane of mouse and keys.
    fn clip_plane(&self, stage: &Stage) -> Option<Enhancer> {
        let centre_m = self.piece().centre_at(stage.script_s) + stage.handling.shift_m;
        let plane = ClipPlane {
            point_in_display: centre_m + DVec3::Z * stage.clip_m?,
            normal_in_display: DVec3::Z,
            context: CLIP_CONTEXT,
            thickness_m: 0.0,
            boost: 1.0,
            strength: 1.0,
        };
        Some(Enhancer::ClipPlane(plane))
    }
}

#[cfg(test)]
#[path = "theatre_tests.rs"]
mod tests;
