//! Exhibits: their files meet displays, scenes and volumes.

use super::{load_display, looks_of, meet_volume};
use crate::scene::{LookName, QualityPreset, Scene};
use crate::staging::{Ensemble, Piece, carries, menu_size, needs_band};
use ::exhibit::{Exhibit, Fault, ItemWish, Looks};
use clap::ValueEnum;
use display_config::Display;
use display_config::text::{brief_text, did_you_mean};
use optics::MOST_ENHANCERS;
use overlay::unknown_characters;
use world::{Action, Item, Preset};

/// What finds out what is wrong with an exhibit besides its text.
struct Opening<'a> {
    exhibit: &'a Exhibit,
    display: Option<Display>,
    faults: Vec<Fault>,
}

/// Whether a file is an exhibit's, and not a scene's: it has items.
pub fn is_exhibit(path: &str) -> bool {
    path.ends_with(".toml") && std::fs::read_to_string(path).is_ok_and(|text| Exhibit::is_one(&text))
}

/// Opens all that an exhibit names.
///
/// # Errors
/// All that is wrong with it.
pub fn open_exhibit(exhibit: &Exhibit) -> Result<(Ensemble, Display), Vec<Fault>> {
    let mut opening = Opening { exhibit, display: None, faults: Vec::new() };
    match load_display(&exhibit.display) {
        Ok(display) => opening.display = Some(display),
        Err(error) => opening.wrong(None, format!("`display` cannot be used: {error}")),
    }
    opening.check_texts();
    let quality = exhibit.quality.as_deref().and_then(|name| opening.quality(name));
    let pieces: Vec<_> = exhibit
        .items
        .iter()
        .filter_map(|item| opening.piece(item, quality).map(|piece| (piece, item)))
        .collect();
    let pieces: Vec<(Piece, Item)> =
        pieces.into_iter().map(|(piece, item)| opening.item(piece, item)).collect();
    pieces
        .iter()
        .zip(&exhibit.items)
        .for_each(|((piece, item), wish)| opening.check_menus(wish, piece, item));
    let Opening { display, faults, .. } = opening;
    match display {
        Some(display) if faults.is_empty() => {
            let (cast, rules) = (exhibit.cast.clone(), exhibit.rules.clone());
            Ok((Ensemble { cast, rules, pieces }, display))
        }
        _ => Err(faults),
    }
}

impl Opening<'_> {
    fn wrong(&mut self, line: Option<usize>, what: String) {
        self.faults.push(Fault { file: self.exhibit.file.clone(), line, what });
    }

    /// Whether all that is written over the volume can be.
    fn check_texts(&mut self) {
        let exhibit = self.exhibit;
        let mut texts: Vec<&str> = Vec::new();
        if exhibit.marks.captions {
            texts.extend(exhibit.items.iter().filter_map(|item| item.title.as_deref()));
            texts.extend(exhibit.rules.attract.iter().map(|attract| attract.caption.as_str()));
        }
        if exhibit.marks.names {
            texts.extend(exhibit.cast.visitors.iter().map(|visitor| visitor.name.as_str()));
        }
        self.check_letters(
            None,
            texts,
            "leave it out with `names = false` or `captions = false` under [marks]",
        );
    }

    /// Whether there are letters for all texts; what else can be done where there are not.
    fn check_letters(&mut self, line: Option<usize>, texts: Vec<&str>, otherwise: &str) {
        for (text, unknown) in unknown_characters(texts) {
            let unknown: String = unknown.into_iter().take(8).collect();
            let text = brief_text(text).into_owned();
            self.wrong(line, format!(
                    "{text} cannot be written over the volume: there are no letters for \"{unknown}\"; use Latin, Greek or \
                     Cyrillic ones, or {otherwise}"
                ));
        }
    }

    /// Whether what tools' menus list of an item can be written, and all at once.
    fn check_menus(&mut self, wish: &ItemWish, piece: &Piece, item: &Item) {
        let exhibit = self.exhibit;
        let tools = &exhibit.cast.tools;
        let has = |action: Action| {
            tools.iter().any(|tool| tool.buttons.iter().any(|button| button.action == action))
        };
        let mut texts = Vec::new();
        if has(Action::Menu) {
            texts.push(item.title.as_str());
            texts.extend(item.presets.iter().map(|preset| preset.title.as_str()));
        }
        if has(Action::PickBand) {
            texts.extend((0..item.bands).filter_map(|band| piece.band_name(band)));
        }
        self.check_letters(Some(wish.line), texts, "take the buttons away that list it");
        let Some(size) = self.display.as_ref().map(menu_size) else { return };
        let opens = |action| matches!(action, Action::Menu | Action::PickBand);
        let items = exhibit.items.len();
        let full = tools.iter().find(|tool| {
            tool.buttons.iter().any(|button| opens(button.action)) && !size.has_room(tool, item, items)
        });
        if let Some(tool) = full {
            let name = brief_text(&tool.name).into_owned();
            self.wrong(Some(wish.line), format!(
                "the menu of {name} has no room on the display for all that it lists of this item, {} columns of {} entries; take \
                 looks, presets, bands or items away",
                size.most_columns, size.most_rows
            ));
        }
    }

    fn quality(&mut self, name: &str) -> Option<QualityPreset> {
        let found = QualityPreset::from_str(name, false).ok();
        if found.is_none() {
            let names: Vec<String> = QualityPreset::value_variants()
                .iter()
                .filter_map(|preset| Some(preset.to_possible_value()?.get_name().to_owned()))
                .collect();
            let (name, suggestion) =
                (brief_text(name).into_owned(), did_you_mean(name, names.iter().map(String::as_str)));
            self.wrong(None, format!("`quality` is {name}{suggestion}; give one of {}", names.join(", ")));
        }
        found
    }

    fn look(&mut self, line: usize, name: &str) -> Option<LookName> {
        let found = LookName::from_str(name, false).ok();
        if found.is_none() {
            let names: Vec<String> = LookName::ALL.iter().map(ToString::to_string).collect();
            let (name, suggestion) =
                (brief_text(name).into_owned(), did_you_mean(name, names.iter().map(String::as_str)));
            self.wrong(
                Some(line),
                format!("no look is called {name}{suggestion}; name one of {}", names.join(", ")),
            );
        }
        found
    }

    /// The scene of an item, with its volume and its looks.
    fn piece(&mut self, item: &ItemWish, quality: Option<QualityPreset>) -> Option<Piece> {
        let opened = Scene::load(&item.scene).map_err(crate::FrontendError::from).and_then(|mut scene| {
            scene.quality = quality.map_or(scene.quality, |preset| preset.quality());
            let (facts, look) = meet_volume(&mut scene)?;
            let looks = looks_of(&scene, look.as_ref())?;
            if let Some(display) = &self.display {
                scene.check_frames(0..scene.frame_count.max(1), display, &facts)?;
            }
            Ok((scene, facts, looks))
        });
        let (scene, facts, mut looks) = match opened {
            Ok(opened) => opened,
            Err(error) => {
                self.wrong(Some(item.line), format!("its scene cannot be shown: {error}"));
                return None;
            }
        };
        if let Looks::Named(names) = &item.looks {
            let wanted: Vec<LookName> = names.iter().filter_map(|name| self.look(item.line, name)).collect();
            let misfit = wanted.iter().find(|&name| !looks.names.contains(name));
            if let Some(misfit) = misfit {
                let fitting: Vec<String> = looks.names.iter().map(ToString::to_string).collect();
                let fitting = if fitting.is_empty() { "none".to_owned() } else { fitting.join(", ") };
                self.wrong(
                    Some(item.line),
                    format!("the look {misfit} does not fit its scene; those that do: {fitting}"),
                );
            }
            looks.names = wanted;
        }
        let piece = Piece::new(scene, facts, &looks).for_tools();
        self.check_tools(item.line, &piece);
        if self.exhibit.marks.depth_combined && piece.scene(None).look.refracts() {
            self.wrong(Some(item.line), "its scene refracts light, so tools cannot be depth-combined with it; take `depth_combined` out of [marks]".into());
        }
        Some(piece)
    }

    /// Whether all tools can be at work in a scene at once.
    fn check_tools(&mut self, line: usize, piece: &Piece) {
        let tools = &self.exhibit.cast.tools;
        let carrying = tools.iter().filter(|tool| tool.kinds.iter().any(|&kind| carries(kind))).count();
        // The last one is the clip plane of mouse and keys.
        let links = piece.scene(None).enhancers.len() + carrying + 1;
        if links > MOST_ENHANCERS {
            let own = piece.scene(None).enhancers.len();
            self.wrong(Some(line), format!(
                "its scene has {own} enhancers of its own, {carrying} tools carry one each, and mouse and keys a clip plane: \
                 at most {MOST_ENHANCERS} can act at once; take some away"
            ));
        }
        let without = tools.iter().find(|tool| tool.kinds.iter().any(|&kind| needs_band(kind)));
        if let (Some(tool), None) = (without, piece.band(None)) {
            let name = brief_text(&tool.name).into_owned();
            self.wrong(
                Some(line),
                format!(
                    "{name} brings out bands of values, and its scene has none; add a [[band]] to the scene"
                ),
            );
        }
    }

    fn item(&mut self, piece: Piece, wish: &ItemWish) -> (Piece, Item) {
        let presets = wish.presets.iter().map(|preset| {
            let look = preset.look.as_deref().and_then(|name| self.look(wish.line, name));
            let place = look.and_then(|name| piece.look_at(name));
            if let (Some(name), None) = (look, place) {
                self.wrong(
                    Some(wish.line),
                    format!("the look {name} of a preset is not among the item's `looks`; add it"),
                );
            }
            Preset { title: preset.title.clone(), handling: preset.handling, look: place }
        });
        let presets = presets.collect();
        let item = piece.item(presets, wish.time);
        let title = wish.title.clone().unwrap_or_else(|| item.title.clone());
        (piece, Item { title, ..item })
    }
}
