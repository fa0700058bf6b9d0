//! What is drawn of menus that are open.

use super::marks::{Artist, kind_name};
use super::piece::Piece;
use display_config::Display;
use glam::{DVec2, DVec3};
use protocol::{Mark, MarkShape, Paint};
use world::{Choice, Menu, MenuSize, Programme};

/// The em of what is written, in parts of the screen's height, and at least in what the display resolves on its screen.
const EM: f64 = 0.03;
const EM_PIXELS: f64 = 10.0;
/// Width and height of an entry, in ems.
const ENTRY_EMS: DVec2 = DVec2::new(11.0, 1.4);
/// How much of the screen a list may take.
const MOST: f64 = 0.94;
/// Characters of an entry; a longer text is cut short. A letter of a text is 0.55 em wide in the mean.
const MOST_LETTERS: usize = 18;
/// The middle of small letters above their base line, in ems.
const MIDDLE_EM: f64 = 0.3;
/// The dot that goes with the tip, and half of the line between groups, in ems.
const DOT_EM: f64 = 0.2;
const LINE_EM: f64 = 0.04;
/// Behind an entry, and what is written on that which is marked.
const BLACK: [f32; 3] = [0.0; 3];
const BEHIND: f64 = 0.75;
/// The dot.
const WHITE: [f32; 3] = [1.0; 3];

/// The em of menus on a display, metres.
fn em_m(display: &Display) -> f64 {
    (EM * display.height_m).max(EM_PIXELS * display.pixel_size_m)
}

/// How large menus are on a display: no list is larger than its screen.
pub fn menu_size(display: &Display) -> MenuSize {
    let entry_m = (em_m(display) * ENTRY_EMS).max(DVec2::splat(MenuSize::LEAST_M));
    let most = |length_m: f64, entry_m: f64| (MOST * length_m / entry_m).max(1.0) as usize;
    let most_rows = most(display.height_m, entry_m.y);
    MenuSize { entry_m, most_rows, most_columns: most(display.width_m, entry_m.x) }
}

/// What visitors read of a choice.
pub(super) fn words(choice: Choice, piece: &Piece, programme: &Programme, item: usize) -> String {
    let item = programme.0.get(item);
    let text = match choice {
        Choice::Undo => Some("undo".to_owned()),
        Choice::Kind(kind) => Some(kind_name(kind).to_owned()),
        Choice::Look(None) => Some("its own look".to_owned()),
        Choice::Look(look) => piece.look_name(look).map(|name| name.to_string()),
        Choice::Preset(preset) => {
            item.and_then(|item| item.presets.get(preset)).map(|preset| preset.title.clone())
        }
        Choice::Item(item) => programme.0.get(item).map(|item| item.title.clone()),
        Choice::Band(band) => piece.band_name(band).map(str::to_owned),
    };
    cut_short(&text.unwrap_or_default())
}

fn cut_short(text: &str) -> String {
    if text.chars().count() <= MOST_LETTERS {
        return text.to_owned();
    }
    let start: String = text.chars().take(MOST_LETTERS - 1).collect();
    format!("{}…", start.trim_end())
}

/// Where the tip was when a menu opened, as it is drawn: as near to there as a text can be read, and so that the display's
/// observer sees the whole list on the screen.
fn drawn_from_m(menu: &Menu, readable_m: DVec3, display: &Display) -> DVec3 {
    let (screen_m, observer) = (DVec2::new(display.width_m, display.height_m), display.observer_in_display);
    let [least, most] = menu.corners_m();
    // Nearer than this, the screen is smaller than the list.
    let nearest_m = observer.z * (1.0 - ((most - least) / screen_m).max_element()).max(0.0);
    let z = readable_m.z.min(nearest_m);
    let (middle, half) = (observer.truncate() * (z / observer.z), 0.5 * screen_m * (1.0 - z / observer.z));
    let (lower, upper) = (middle - half - least, middle + half - most);
    readable_m.truncate().max(lower).min(upper.max(lower)).extend(z)
}

impl Artist<'_> {
    /// A menu: its entries, the marked one told apart, and below what is written there a dot that goes as the tip does.
    pub(super) fn menu(&self, menu: &Menu, marks: &mut Vec<Mark>) {
        let Some(tool) = self.stage.tools.iter().find(|tool| tool.tool == menu.tool) else { return };
        let em_m = em_m(self.display);
        let from = drawn_from_m(menu, self.readable(menu.from_m, em_m), self.display);
        let own = self.paint(tool, 1.0);
        let black = |opacity: f64| Paint { rgb: BLACK, opacity: (tool.presence * opacity) as f32 };
        let half = 0.5 * menu.entry_m.extend(0.0);
        let (mut last, mut labels) = (None, Vec::new());
        for (number, entry) in menu.entries.iter().enumerate() {
            let middle = from + entry.middle_m.extend(0.0);
            let (behind, written) = match menu.marked == Some(number) {
                true => (own, black(1.0)),
                false => (black(BEHIND), own),
            };
            let [left, right] = [-half.x, half.x].map(|x| DVec3::X * x);
            let [lower, upper] = [-half.y, half.y].map(|y| middle + DVec3::Y * y);
            let corners_in_display = vec![lower + left, lower + right, upper + right, upper + left];
            marks.push(over_all(MarkShape::Sheet { corners_in_display }, behind));
            let (text, base_in_display) = ((self.words)(entry.choice), middle - DVec3::Y * MIDDLE_EM * em_m);
            let shape = MarkShape::Label { text, base_in_display, em_m, backing: None };
            labels.push(over_all(shape, written));
            let group = std::mem::discriminant(&entry.choice);
            if last.replace(group).is_some_and(|last| last != group) {
                marks.push(stroke(vec![upper + left, upper + right], LINE_EM * em_m, own));
            }
        }
        let tip = from + (tool.tip_m - menu.from_m).truncate().extend(0.0);
        marks.push(stroke(vec![tip], DOT_EM * em_m, Paint { rgb: WHITE, ..own }));
        marks.append(&mut labels);
    }
}

fn stroke(points_in_display: Vec<DVec3>, radius_m: f64, paint: Paint) -> Mark {
    over_all(MarkShape::Stroke { points_in_display, radius_m }, paint)
}

/// What is to be read shines through whatever lies before it.
fn over_all(shape: MarkShape, paint: Paint) -> Mark {
    Mark { shape, paint, is_depth_combined: false }
}
