//! DTrack: bodies, Flysticks and measurement tools of ART trackers, as lines of text (DTrack2 user manual, appendix B.2).

use crate::Refusal;
use crate::pose::pose_of_matrix;
use crate::reading::{Parts, Reading, Said, Stamp};
use glam::{DMat3, DVec3};
use std::ops::Range;
use std::str::FromStr;
use std::time::Duration;

/// Sensors from here on are Flysticks, those before are bodies.
const FLYSTICKS: u8 = 100;
/// Sensors from here on are measurement tools.
const TOOLS: u8 = 200;
/// Buttons, and axes, of each Flystick; those of the first begin at 0. One code of 32 bits has all buttons.
const FLYSTICK_BUTTONS: u8 = 16;
const FLYSTICK_AXES: u8 = 8;
/// Flysticks whose buttons have numbers.
const MOST_FLYSTICKS: u8 = 8;
/// Buttons of each measurement tool, and where those of the first begin.
const TOOL_BUTTONS: u8 = 8;
const FIRST_TOOL_BUTTON: u8 = FLYSTICK_BUTTONS * MOST_FLYSTICKS;
const MOST_TOOLS: u8 = 16;
/// No frame's time is later, seconds since midnight.
const DAY_S: f64 = 86_400.0;

/// What the datagram of a frame says.
#[derive(Clone, Debug, PartialEq)]
pub struct Frame {
    /// All of it.
    pub parts: Parts,
    /// The bodies that are listed; absent if the datagram has no such list. A body that is not tracked is not listed.
    pub bodies: Option<Vec<u8>>,
}

/// The frame of a datagram. Lines of other kinds are passed over.
///
/// # Errors
/// Text that is no ASCII, or a line that does not have the form of its kind. A body that is out of bounds or has no pose
/// is refused by itself.
pub fn parse(datagram: &[u8]) -> Result<Frame, Refusal> {
    let text = std::str::from_utf8(datagram).ok().filter(|text| text.is_ascii()).ok_or(Refusal::Foreign)?;
    // Some senders end the text with a zero byte.
    let lines = text.trim_end_matches('\0').lines().map(str::trim).filter(|line| !line.is_empty());
    let mut frame = Frame { parts: Parts::new(), bodies: None };
    let (mut stamp, mut is_known) = (None, false);
    for line in lines {
        let (kind, rest) = line.split_once(' ').unwrap_or((line, ""));
        let parts = match kind {
            "fr" => Vec::new(),
            "ts" => {
                stamp = Some(time_of_day(rest)?);
                Vec::new()
            }
            "6d" => {
                let (ids, parts) = bodies(rest)?;
                frame.bodies = Some(ids);
                parts
            }
            "6df2" => each(counted::<2>(rest)?, flystick)?,
            "6dmt2" => each(counted::<2>(rest)?, tool)?,
            _ => continue,
        };
        is_known = true;
        frame.parts.extend(parts.into_iter().map(|part| part.map(|said| said.at(stamp))));
    }
    if is_known { Ok(frame) } else { Err(Refusal::Foreign) }
}

/// Seconds since midnight, UTC.
fn time_of_day(text: &str) -> Result<Stamp, Refusal> {
    let seconds = text.trim().parse().ok().filter(|seconds| (0.0..=DAY_S).contains(seconds));
    seconds.map(|seconds| Stamp::Own(Duration::from_secs_f64(seconds))).ok_or(Refusal::Form)
}

/// The groups in brackets of a line.
type Groups<'a> = Vec<&'a str>;
/// What a thing of a line says, or why that is refused.
type Sayings = Vec<Result<Said, Refusal>>;

/// The groups of a line that begins with N counts, the last of which is that of the things that follow.
fn counted<const N: usize>(line: &str) -> Result<(usize, Groups<'_>), Refusal> {
    let (counts, groups) = line.split_at(line.find('[').unwrap_or(line.len()));
    let counts: [usize; N] = exactly(counts)?;
    let mut found = Groups::new();
    for group in groups.split('[').skip(1) {
        found.push(group.trim_end().strip_suffix(']').ok_or(Refusal::Form)?);
    }
    Ok((counts[N - 1], found))
}

/// So many values with spaces between them, and no others.
fn exactly<T: FromStr + Copy + Default, const N: usize>(text: &str) -> Result<[T; N], Refusal> {
    let (mut values, mut words) = ([T::default(); N], text.split_ascii_whitespace());
    for value in &mut values {
        *value = words.next().and_then(|word| word.parse().ok()).ok_or(Refusal::Form)?;
    }
    if words.next().is_none() { Ok(values) } else { Err(Refusal::Form) }
}

/// What each thing of a line says, from the N groups that it has.
fn each<const N: usize>(
    (count, groups): (usize, Groups<'_>),
    thing: impl Fn(&[&str; N]) -> Result<Sayings, Refusal>,
) -> Result<Sayings, Refusal> {
    let (things, rest) = groups.as_chunks::<N>();
    if things.len() != count || !rest.is_empty() {
        return Err(Refusal::Form);
    }
    things.iter().try_fold(Sayings::new(), |mut said, groups| {
        said.extend(thing(groups)?);
        Ok(said)
    })
}

fn bodies(line: &str) -> Result<(Vec<u8>, Sayings), Refusal> {
    let (count, groups) = counted::<1>(line)?;
    let ids = groups.iter().step_by(3).map(|head| Ok(exactly::<f64, 2>(head)?[0]));
    let ids = ids.collect::<Result<Vec<f64>, Refusal>>()?;
    let ids = ids.into_iter().filter_map(|id| number(id, 0..FLYSTICKS).ok()).collect();
    let said = each::<3>((count, groups), |[head, place, matrix]| {
        let ([id, quality], [x, y, z, ..]) = (exactly(head)?, exactly::<f64, 6>(place)?);
        let (sensor, matrix) = (number(id, 0..FLYSTICKS), exactly(matrix)?);
        Ok(vec![sensor.and_then(|sensor| target(sensor, quality, [x, y, z], matrix))])
    })?;
    Ok((ids, said))
}

fn flystick([head, place, matrix, control]: &[&str; 4]) -> Result<Sayings, Refusal> {
    let [id, quality, buttons, axes]: [f64; 4] = exactly(head)?;
    let (place, matrix) = (exactly(place)?, exactly(matrix)?);
    let Ok(id) = number(id, 0..MOST_FLYSTICKS) else { return Ok(vec![Err(Refusal::Index)]) };
    let (buttons, axes) = (counts(buttons, FLYSTICK_BUTTONS)?, counts(axes, FLYSTICK_AXES)?);
    let mut words = control.split_ascii_whitespace();
    let mut said = vec![target(FLYSTICKS + id, quality, place, matrix)];
    if buttons > 0 {
        let code = words.next().and_then(|word| word.parse().ok()).ok_or(Refusal::Form)?;
        said.extend(down(code, id * FLYSTICK_BUTTONS, buttons));
    }
    for axis in 0..axes {
        let value = words.next().and_then(|word| word.parse().ok()).ok_or(Refusal::Form)?;
        said.push(Said::axis(id * FLYSTICK_AXES + axis, value));
    }
    if words.next().is_none() { Ok(said) } else { Err(Refusal::Form) }
}

fn tool([head, place, matrix, button, covariance]: &[&str; 5]) -> Result<Sayings, Refusal> {
    let [id, quality, buttons, _radius]: [f64; 4] = exactly(head)?;
    let (place, matrix) = (exactly(place)?, exactly(matrix)?);
    let ([code], [..]) = (exactly::<u32, 1>(button)?, exactly::<f64, 6>(covariance)?);
    let Ok(id) = number(id, 0..MOST_TOOLS) else { return Ok(vec![Err(Refusal::Index)]) };
    let buttons = counts(buttons, TOOL_BUTTONS)?;
    let mut said = vec![target(TOOLS + id, quality, place, matrix)];
    said.extend(down(code, FIRST_TOOL_BUTTON + id * TOOL_BUTTONS, buttons));
    Ok(said)
}

/// Where a target is, in millimetres, and how it is turned, column by column. A lost one comes with quality −1, and zeros.
fn target(sensor: u8, quality: f64, [x, y, z]: [f64; 3], matrix: [f64; 9]) -> Result<Said, Refusal> {
    if quality < 0.0 {
        return Ok(Said::Pose(sensor, None));
    }
    let pose = pose_of_matrix(DVec3::new(x, y, z) * 1e-3, DMat3::from_cols_array(&matrix))?;
    Ok(Said::Pose(sensor, Some(pose)))
}

/// Which of some buttons a code says are down, the lowest bit first.
fn down(code: u32, first: u8, count: u8) -> impl Iterator<Item = Result<Said, Refusal>> {
    (0..count).map(move |button| Ok(Said::Button(first + button, code >> button & 1 == 1)))
}

fn number(number: f64, range: Range<u8>) -> Result<u8, Refusal> {
    let is_whole = number.fract() == 0.0 && (0.0..f64::from(range.end)).contains(&number);
    if is_whole { Ok(number as u8) } else { Err(Refusal::Index) }
}

fn counts(count: f64, most: u8) -> Result<u8, Refusal> {
    number(count, 0..most + 1)
}

/// What a tracker's frames say one after the other: also that a body is lost, which no frame says by itself.
#[derive(Default)]
pub(crate) struct Dtrack {
    tracked: Vec<u8>,
}

impl Dtrack {
    /// What a datagram says.
    pub fn decode(&mut self, datagram: &[u8]) -> Result<Parts, Refusal> {
        let Frame { mut parts, bodies } = parse(datagram)?;
        let Some(mut bodies) = bodies else { return Ok(parts) };
        bodies.sort_unstable();
        let gone = self.tracked.iter().filter(|body| bodies.binary_search(body).is_err());
        parts.extend(gone.map(|&body| Ok(Reading { stamp: None, said: Said::Pose(body, None) })));
        bodies.dedup();
        self.tracked = bodies;
        Ok(parts)
    }
}

#[cfg(test)]
#[path = "dtrack_tests.rs"]
mod tests;
