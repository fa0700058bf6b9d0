//! The parts of an exhibit file.

use crate::exhibit::{ItemWish, Looks, MarkWish, PresetWish, TapeWish};
use crate::raw::{
    RawFilter, RawIdle, RawItem, RawLimits, RawLooks, RawMarks, RawPreset, RawTape, RawTip, RawTool,
    RawVisitor,
};
use crate::read::Reader;
use display_config::text::{brief_text, did_you_mean};
use glam::{DQuat, DVec3};
use inputs::SourceId;
use std::collections::BTreeMap;
use std::time::Duration;
use toml::{Spanned, Value};
use tracking::{RigidTransform, TrackSettings};
use world::{Action, Attract, Button, Cast, Dial, Handling, Rules, Sensor, Tool, Visitor, VisitorId};

/// A day, seconds.
const LONGEST_S: f64 = 86_400.0;
/// Visitors, tools and items of an exhibit, at most.
const MOST_ENTRIES: usize = 64;
/// A megabyte.
const MB: u64 = 1_000_000;
/// What a tape has until the next one begins, megabytes, and how many are kept, where nothing else is said.
const PART_MB: u64 = 256;
const KEEP_PARTS: usize = 20;
/// Quaternions of other lengths are mistakes.
const LENGTHS: std::ops::RangeInclusive<f64> = 0.5..=2.0;

impl Reader<'_> {
    fn limited<'v>(&mut self, kind: &str, entries: &'v [Spanned<Value>]) -> &'v [Spanned<Value>] {
        if let Some(extra) = entries.get(MOST_ENTRIES) {
            let line = self.line(extra.span().start);
            self.wrong(line, format!("there are more than {MOST_ENTRIES} [[{kind}]] entries; remove some"));
        }
        &entries[..entries.len().min(MOST_ENTRIES)]
    }

    pub(crate) fn items(&mut self, entries: &[Spanned<Value>]) -> Vec<ItemWish> {
        if entries.is_empty() {
            self.wrong_file("it shows nothing; add an [[item]] with a `scene`");
        }
        let mut items = Vec::new();
        for entry in self.limited("item", entries) {
            let Some((line, raw)) = self.entry::<RawItem>("[item]", entry) else { continue };
            let time_s = self.within(line, "time_s", raw.time_s, 1.0..=LONGEST_S);
            let looks = match raw.looks {
                None => Looks::Named(Vec::new()),
                Some(RawLooks::List(names)) => Looks::Named(names),
                Some(RawLooks::Word(word)) if word == "all" => Looks::All,
                Some(RawLooks::Word(word)) => {
                    let word = brief_text(&word).into_owned();
                    self.wrong(line, format!("`looks` is \"{word}\"; give \"all\", or a list of looks"));
                    Looks::All
                }
            };
            let presets =
                raw.preset.into_iter().zip(1..).map(|(preset, number)| self.preset(line, number, preset));
            items.push(ItemWish {
                line,
                title: raw.title,
                presets: presets.collect(),
                scene: self.path_or_preset(&raw.scene),
                looks,
                time: time_s.map(Duration::from_secs_f64),
            });
        }
        items
    }

    fn preset(&mut self, line: usize, number: usize, raw: RawPreset) -> PresetWish {
        let [right, down] = raw.turn_deg.unwrap_or_default();
        let shift_m = DVec3::from_array(raw.shift_m.unwrap_or_default());
        let scale = self.within(line, "preset.scale", raw.scale, 0.01..=100.0).unwrap_or(1.0);
        if !(right.is_finite() && down.is_finite() && shift_m.is_finite()) {
            self.wrong(line, format!("preset {number} has numbers that are not finite; give others"));
            return PresetWish { title: String::new(), handling: Handling::default(), look: None };
        }
        let handling = Handling::turned(right.to_radians(), down.to_radians());
        PresetWish {
            title: raw.title.unwrap_or_else(|| format!("preset {number}")),
            handling: Handling { shift_m, scale, ..handling },
            look: raw.look,
        }
    }

    pub(crate) fn cast(
        &mut self,
        visitors: &[Spanned<Value>],
        tools: &[Spanned<Value>],
        inputs: &[&str],
    ) -> Cast {
        let mut cast = Cast::default();
        for entry in self.limited("visitor", visitors) {
            let Some((line, raw)) = self.entry::<RawVisitor>("[visitor]", entry) else { continue };
            if cast.visitors.iter().any(|visitor| visitor.name == raw.name) {
                self.wrong(
                    line,
                    format!("two visitors are called {}; give each a name of its own", brief_text(&raw.name)),
                );
            }
            let colour = raw.colour.as_deref().map_or(Some([1.0; 3]), linear_colour);
            if colour.is_none() {
                self.wrong(line, "`colour` is no colour; give six hexadecimal digits as in \"#ff8800\"");
            }
            cast.visitors.push(Visitor { name: raw.name, colour: colour.unwrap_or([1.0; 3]) });
        }
        let mut lines: Vec<usize> = Vec::new();
        for entry in self.limited("tool", tools) {
            let Some((line, raw)) = self.entry::<RawTool>("[tool]", entry) else { continue };
            let tool = self.tool(line, raw, &cast, inputs);
            let clash = cast
                .tools
                .iter()
                .position(|other| other.sensor == tool.sensor && tool.sensor != Sensor::First);
            if let Some(clash) = clash {
                let (other, at) = (brief_text(&cast.tools[clash].name).into_owned(), lines[clash]);
                self.wrong(
                    line,
                    format!("its sensor is that of {other} (line {at}) already; give each tool its own"),
                );
            }
            lines.push(line);
            cast.tools.push(tool);
        }
        cast
    }

    fn tool(&mut self, line: usize, raw: RawTool, cast: &Cast, inputs: &[&str]) -> Tool {
        let holder = cast.visitors.iter().position(|visitor| visitor.name == raw.visitor);
        if holder.is_none() {
            let names = cast.visitors.iter().map(|visitor| visitor.name.as_str());
            let (name, suggestion) =
                (brief_text(&raw.visitor).into_owned(), did_you_mean(&raw.visitor, names));
            self.wrong(line, format!("no [[visitor]] is called {name}{suggestion}; name one of them"));
        }
        if raw.kinds.is_empty() {
            self.wrong(line, "`kinds` is empty; say what the tool can be, such as [\"pointer\"]");
        }
        for (place, kind) in raw.kinds.iter().enumerate() {
            if raw.kinds[..place].contains(kind) {
                self.wrong(line, "`kinds` names the same thing twice; remove one");
            }
        }
        let sensor = self.sensor(line, raw.input.as_deref(), raw.sensor, inputs);
        let buttons = self.buttons(line, &raw.buttons);
        let picks = buttons.iter().any(|button| button.action == Action::PickBand);
        if picks && !raw.kinds.iter().any(|kind| kind.picks_band()) {
            self.wrong(
                line,
                "`buttons` has \"pick-band\", and it picks none; add \"band-picker\" or \"layer-opacity\" to `kinds`",
            );
        }
        let dials = raw.dials.iter().map(|dial| {
            let per_s = self.within(line, "dials.per_s", Some(dial.per_s), -100.0..=100.0).unwrap_or(0.0);
            Dial { index: dial.axis, kind: dial.does, per_s }
        });
        Tool {
            dials: dials.collect(),
            name: raw.name,
            holder: VisitorId(holder.unwrap_or(0) as u16),
            sensor,
            sensor_from_tip: self.tip(line, raw.tip),
            kinds: raw.kinds,
            buttons,
            track: self.track(line, raw.filter),
        }
    }

    fn sensor(&mut self, line: usize, input: Option<&str>, sensor: Option<u8>, inputs: &[&str]) -> Sensor {
        let (input, sensor) = match (input, sensor) {
            (None, None) => return Sensor::First,
            (Some(input), sensor) => (input, sensor.unwrap_or(0)),
            (None, Some(_)) => {
                self.wrong(line, "it has a `sensor` and no `input`; name the input of that sensor");
                return Sensor::First;
            }
        };
        let Some(source) = inputs.iter().position(|&known| known == input) else {
            let name = brief_text(input).into_owned();
            let suggestion = did_you_mean(input, inputs.iter().copied());
            self.wrong(
                line,
                format!("no input is called {name}{suggestion}; name one of the file in `inputs`"),
            );
            return Sensor::First;
        };
        Sensor::Of { source: SourceId(source as u16), sensor }
    }

    fn buttons(&mut self, line: usize, raw: &BTreeMap<String, Action>) -> Vec<Button> {
        let mut buttons: Vec<Button> = Vec::new();
        for (number, &action) in raw {
            match number.parse() {
                Ok(index) if buttons.iter().all(|button| button.index != index) => {
                    buttons.push(Button { index, action })
                }
                Ok(index) => self.wrong(line, format!("button {index} has two actions; remove one")),
                Err(_) => {
                    let number = brief_text(number).into_owned();
                    self.wrong(
                        line,
                        format!("`buttons` has a button \"{number}\"; give numbers from 0 to 255"),
                    );
                }
            }
        }
        buttons.sort_by_key(|button| button.index);
        buttons
    }

    fn tip(&mut self, line: usize, raw: Option<RawTip>) -> RigidTransform {
        let RawTip { translation_m, rotation } =
            raw.unwrap_or(RawTip { translation_m: None, rotation: None });
        let translation_m = DVec3::from_array(translation_m.unwrap_or_default());
        let rotation = DQuat::from_array(rotation.unwrap_or([0.0, 0.0, 0.0, 1.0]));
        let is_good = translation_m.is_finite()
            && translation_m.length() <= 10.0
            && LENGTHS.contains(&rotation.length());
        if !is_good {
            self.wrong(
                line,
                "`tip` is no place on a tool; give a translation_m below 10 m and a unit quaternion x y z w",
            );
            return RigidTransform { rotation: DQuat::IDENTITY, translation_m: DVec3::ZERO };
        }
        RigidTransform { rotation: rotation.normalize(), translation_m }
    }

    fn track(&mut self, line: usize, raw: Option<RawFilter>) -> TrackSettings {
        let mut track = TrackSettings::default();
        let Some(raw) = raw else { return track };
        let mut set = |to: &mut f64, key: &str, number: Option<f64>, least: f64| {
            if let Some(number) = self.within(line, key, number, least..=1e4) {
                *to = number;
            }
        };
        set(&mut track.position.least_cutoff_hz, "filter.least_cutoff_hz", raw.least_cutoff_hz, 0.01);
        set(&mut track.position.cutoff_per_speed, "filter.cutoff_per_speed", raw.cutoff_per_speed, 0.0);
        set(
            &mut track.rotation.least_cutoff_hz,
            "filter.turn_least_cutoff_hz",
            raw.turn_least_cutoff_hz,
            0.01,
        );
        set(
            &mut track.rotation.cutoff_per_speed,
            "filter.turn_cutoff_per_speed",
            raw.turn_cutoff_per_speed,
            0.0,
        );
        let mut smoothing_ms = 1e3 * track.smoothing.as_secs_f64();
        set(&mut smoothing_ms, "filter.smoothing_ms", raw.smoothing_ms, 1.0);
        track.smoothing = Duration::from_secs_f64(1e-3 * smoothing_ms);
        track
    }

    pub(crate) fn rules(&mut self, idle: Option<&Spanned<Value>>, limits: Option<&Spanned<Value>>) -> Rules {
        let mut rules = Rules { scales: (0.25, 4.0), ..Rules::default() };
        if let Some((line, raw)) = limits.and_then(|entry| self.entry::<RawLimits>("limits", entry)) {
            let [least, most] = raw.scales.unwrap_or([rules.scales.0, rules.scales.1]);
            if least > 0.0 && least <= 1.0 && (1.0..=1e3).contains(&most) {
                rules.scales = (least, most);
            } else {
                self.wrong(line, "`scales` must be from above 0 to 1 and from 1 to 1000, such as [0.25, 4]");
            }
            let farthest_m = self.within(line, "farthest_m", raw.farthest_m, 0.0..=100.0);
            rules.farthest_m = farthest_m.unwrap_or(rules.farthest_m);
            rules.longest_hold = self.seconds(line, "longest_hold_s", raw.longest_hold_s);
        }
        if let Some((line, raw)) = idle.and_then(|entry| self.entry::<RawIdle>("idle", entry)) {
            rules.undone_after = self.seconds(line, "undone_after_s", raw.undone_after_s);
            let turn = self.within(line, "turn_deg_per_s", raw.turn_deg_per_s, -360.0..=360.0).unwrap_or(6.0);
            let caption = raw.caption.unwrap_or_default();
            let attract = |after| Attract { after, turn_per_s: turn.to_radians(), caption };
            rules.attract = self.seconds(line, "attract_after_s", raw.attract_after_s).map(attract);
        }
        rules
    }

    fn seconds(&mut self, line: usize, key: &str, seconds: Option<f64>) -> Option<Duration> {
        self.within(line, key, seconds, 1.0..=LONGEST_S).map(Duration::from_secs_f64)
    }

    pub(crate) fn marks(&mut self, entry: Option<&Spanned<Value>>) -> MarkWish {
        let raw = entry
            .and_then(|entry| self.entry::<RawMarks>("marks", entry))
            .map_or_else(RawMarks::default, |(_, raw)| raw);
        let on = |wish: Option<bool>| wish.unwrap_or(true);
        MarkWish {
            tools: on(raw.tools),
            names: on(raw.names),
            captions: on(raw.captions),
            depth_combined: raw.depth_combined.unwrap_or(false),
        }
    }

    pub(crate) fn tape(&mut self, entry: Option<&Spanned<Value>>) -> Option<TapeWish> {
        let (line, raw) = self.entry::<RawTape>("tape", entry?)?;
        let (part_mb, keep_parts) = (raw.part_mb.unwrap_or(PART_MB), raw.keep_parts.unwrap_or(KEEP_PARTS));
        if part_mb == 0 || part_mb > 100_000 || keep_parts == 0 {
            self.wrong(line, "`part_mb` must be from 1 to 100000, and `keep_parts` at least 1");
        }
        Some(TapeWish { folder: self.folder.join(raw.folder), part_bytes: part_mb * MB, keep_parts })
    }
}

/// Linear RGB of six hexadecimal digits of sRGB.
fn linear_colour(text: &str) -> Option<[f64; 3]> {
    let digits = text.strip_prefix('#').filter(|digits| digits.len() == 6 && digits.is_ascii())?;
    let mut colour = [0.0; 3];
    for (channel, i) in colour.iter_mut().zip([0, 2, 4]) {
        let code = f64::from(u8::from_str_radix(&digits[i..i + 2], 16).ok()?) / 255.0;
        *channel = if code <= 0.040_45 { code / 12.92 } else { libm::pow((code + 0.055) / 1.055, 2.4) };
    }
    Some(colour)
}
