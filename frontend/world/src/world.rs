//! The world: what has happened, and what a frame shows of it.

use crate::cast::{Cast, ToolId, VisitorId};
use crate::deed::{Change, Deed, Moment};
use crate::easing::Easing;
use crate::grip::Body;
use crate::history::History;
use crate::holding::{Holding, WindowHolding};
use crate::menu::MenuSize;
use crate::programme::{Item, Programme};
use crate::rules::Rules;
use crate::stage::{Handling, Phase, Refusal, ShownTool, Stage, Window};
use crate::tool_state::ToolState;
use crate::turn::{about_x, about_y};
use glam::DVec3;
use std::time::Duration;

/// How long somebody is told that something was refused.
const TOLD_FOR: Duration = Duration::from_millis(1500);
/// How long a volume takes to where it was before a deed.
pub(crate) const TO_BEFORE: Duration = Duration::from_millis(300);
/// The same to where its scene has it, when nobody is there.
const TO_REST: Duration = Duration::from_secs(2);

/// A world. The same deeds at the same moments give the same stage.
#[derive(Clone, Debug)]
pub struct World {
    pub(crate) cast: Cast,
    pub(crate) programme: Programme,
    pub(crate) rules: Rules,
    pub(crate) menu_size: MenuSize,
    pub(crate) tools: Vec<ToolState>,
    pub(crate) stage: Stage,
    /// Who holds the volume.
    pub(crate) holding: Option<Holding>,
    /// Who moves the window of values.
    pub(crate) window_holding: Option<WindowHolding>,
    /// Tools that want the volume while another visitor has it.
    pub(crate) waiting: Vec<ToolId>,
    pub(crate) history: History,
    pub(crate) easing: Option<Easing>,
    /// Whose dials move the volume, or with true the window of values, and when they last did.
    pub(crate) dialling: Option<((VisitorId, bool), Duration)>,
    refusals: Vec<(Refusal, Duration)>,
    pub(crate) is_paused: bool,
    /// The moment of the last step.
    pub(crate) moment: Option<Moment>,
    /// When somebody last did something.
    pub(crate) busy_at: Duration,
    /// Whether time has undone what was done until then.
    pub(crate) is_undone: bool,
    /// When the item began.
    pub(crate) item_began: Duration,
    /// Where the scene has the volume's centre, metres, display frame.
    pub(crate) home_m: DVec3,
}

impl World {
    /// A world in which nothing has happened yet. The programme has at least one item.
    pub fn new(cast: Cast, programme: Programme, rules: Rules, menu_size: MenuSize) -> Self {
        assert!(!programme.0.is_empty(), "a programme has at least one item");
        let stage = Stage {
            item: 0,
            script_s: 0.0,
            handling: Handling::default(),
            look: None,
            band: None,
            window: Window::default(),
            clip_m: None,
            tools: Vec::new(),
            menus: Vec::new(),
            held_by: None,
            phase: Phase::Open,
            refusals: Vec::new(),
        };
        Self {
            tools: cast.tools.iter().map(ToolState::new).collect(),
            cast,
            programme,
            rules,
            menu_size,
            stage,
            holding: None,
            window_holding: None,
            waiting: Vec::new(),
            history: History::default(),
            easing: None,
            dialling: None,
            refusals: Vec::new(),
            is_paused: false,
            moment: None,
            busy_at: Duration::ZERO,
            is_undone: true,
            item_began: Duration::ZERO,
            home_m: DVec3::ZERO,
        }
    }

    /// What this frame shows.
    pub fn stage(&self) -> &Stage {
        &self.stage
    }

    /// What visitors read of the item that is shown.
    pub fn title(&self) -> &str {
        &self.item().title
    }

    /// What is written below it: its title, or, while nobody is there, what asks for somebody.
    pub fn caption(&self) -> &str {
        let asks = self.rules.attract.as_ref().filter(|_| self.stage.phase == Phase::Attract);
        asks.map(|attract| attract.caption.as_str())
            .filter(|caption| !caption.is_empty())
            .unwrap_or(self.title())
    }

    /// What is shown, one item after the other.
    pub fn programme(&self) -> &Programme {
        &self.programme
    }

    /// Who takes part.
    pub fn cast(&self) -> &Cast {
        &self.cast
    }

    pub(crate) fn item(&self) -> &Item {
        &self.programme.0[self.stage.item]
    }

    pub(crate) fn now(&self) -> Duration {
        self.moment.map_or(Duration::ZERO, |moment| moment.now)
    }

    /// Something happens.
    pub fn apply(&mut self, deed: &Deed) {
        match deed {
            Deed::Event(event) => self.apply_event(event),
            Deed::Change(change) => {
                self.is_busy();
                self.apply_change(*change);
            }
        }
    }

    /// Whether a visitor may move the volume; if not, they are told who has it.
    pub(crate) fn may_move(&mut self, visitor: VisitorId) -> bool {
        match self.stage.held_by {
            Some(held_by) if held_by != visitor => {
                self.refuse(Refusal::Held { wanted_by: visitor, held_by });
                false
            }
            _ => true,
        }
    }

    pub(crate) fn may_change_look(&mut self, visitor: VisitorId) -> bool {
        match self.window_holding.map(|holding| self.cast.holder(holding.tool)) {
            Some(held_by) if held_by != visitor => {
                self.refuse(Refusal::Held { wanted_by: visitor, held_by });
                false
            }
            _ => true,
        }
    }

    pub(crate) fn refuse(&mut self, refusal: Refusal) {
        let until = self.now() + TOLD_FOR;
        self.refusals.retain(|known| known.0 != refusal);
        self.refusals.push((refusal, until));
    }

    /// Refusals that somebody is still told of.
    pub(crate) fn told_refusals(&mut self) -> Vec<Refusal> {
        let now = self.now();
        self.refusals.retain(|told| told.1 > now);
        self.refusals.iter().map(|told| told.0).collect()
    }

    /// What mouse and keys do. These give way to nobody, and what is held stays held from where it is then.
    fn apply_change(&mut self, change: Change) {
        let mut handling = self.stage.handling;
        match change {
            Change::Turn { right, down } => {
                handling.turn = (about_y(right) * about_x(down) * handling.turn).normalize();
            }
            Change::Move(by_m) => handling.shift_m += by_m,
            Change::Scale(factor) => handling.scale *= factor,
            Change::Clip => self.stage.clip_m = if self.stage.clip_m.is_some() { None } else { Some(0.0) },
            Change::MoveClip(by_m) => {
                let farthest_m = self.rules.farthest_m;
                let moved = |at_m: f64| (at_m + by_m).clamp(-farthest_m, farthest_m);
                self.stage.clip_m = self.stage.clip_m.map(moved);
            }
            Change::NextLook => {
                if let Some(look) = self.look_beside(true) {
                    self.take_look(Some(look));
                }
            }
            Change::NextItem => self.begin_item(self.next_item()),
            Change::Pause => self.is_paused = !self.is_paused,
            Change::Reset => {
                handling = Handling::default();
                self.forget_looks();
                (self.stage.clip_m, self.is_paused) = (None, false);
                self.holding = None;
            }
        }
        if handling != self.stage.handling && handling.shift_m.is_finite() && handling.scale.is_finite() {
            self.easing = None;
            self.stage.handling = self.limited(handling);
            self.regrip();
        }
    }

    pub(crate) fn forget_looks(&mut self) {
        self.end_trial();
        (self.stage.look, self.stage.band, self.stage.window) = (None, None, Window::default());
        self.window_holding = None;
    }

    /// The volume goes there within a time.
    pub(crate) fn ease(&mut self, to: Handling, length: Duration) {
        self.easing = Some(Easing::new(self.stage.handling, self.limited(to), self.now(), length));
        self.holding = None;
    }

    /// Where the volume is, or goes.
    pub(crate) fn aim(&self) -> Handling {
        self.easing.as_ref().map_or(self.stage.handling, Easing::aim)
    }

    /// A handling within the rules.
    pub(crate) fn limited(&self, handling: Handling) -> Handling {
        Handling {
            turn: handling.turn.normalize(),
            shift_m: handling.shift_m.clamp_length_max(self.rules.farthest_m),
            scale: handling.scale.clamp(self.rules.scales.0, self.rules.scales.1),
        }
    }

    pub(crate) fn body(&self) -> Body {
        Body::new(self.stage.handling, self.home_m)
    }

    /// Somebody does something.
    pub(crate) fn is_busy(&mut self) {
        (self.busy_at, self.is_undone) = (self.now(), false);
        self.stage.phase = Phase::Open;
    }

    /// The item that follows.
    pub(crate) fn next_item(&self) -> usize {
        (self.stage.item + 1) % self.programme.0.len()
    }

    /// An item begins, as its scene has it. What menus list is of the one before.
    pub(crate) fn begin_item(&mut self, item: usize) {
        self.close_menus();
        let stage = &mut self.stage;
        (stage.item, stage.script_s, stage.handling, stage.clip_m) = (item, 0.0, Handling::default(), None);
        self.forget_looks();
        (self.holding, self.easing, self.dialling) = (None, None, None);
        self.waiting.clear();
        self.history.clear();
        self.item_began = self.now();
    }

    /// Time undoes what visitors did.
    pub(crate) fn rest(&mut self) {
        self.close_menus();
        self.ease(Handling::default(), TO_REST);
        self.forget_looks();
        self.stage.clip_m = None;
        self.tools.iter_mut().for_each(|tool| tool.kind = 0);
        self.history.clear();
        self.is_undone = true;
    }

    /// The tools of this frame.
    pub(crate) fn shown_tools(&self) -> Vec<ShownTool> {
        let each = self.tools.iter().zip(&self.cast.tools).zip(0..);
        let shown = each.filter_map(|((state, tool), number)| {
            let (hand, presence) = state.shown?;
            let id = ToolId(number);
            Some(ShownTool {
                tool: id,
                kind: state.kind_of(tool),
                tip_m: hand.tip_m,
                rotation: hand.rotation,
                presence,
                grabs: self.holding.as_ref().is_some_and(|holding| holding.is_by(id)),
                moves_window: self.window_holding.is_some_and(|holding| holding.tool == id),
            })
        });
        shown.collect()
    }
}

#[cfg(test)]
#[path = "world_tests.rs"]
mod tests;
