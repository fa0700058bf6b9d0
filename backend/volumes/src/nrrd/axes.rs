//! The axes of an NRRD array: which three are the volume's, and what the others are.

use super::super::Selection;
use super::super::choice::{Several, choose};
use super::super::header_text::HeaderText;
use super::super::shape::Axis;
use bricks::volume::VolumeError;
use std::path::Path;

/// Axes that a file may have (NRRD_DIM_MAX of the format's library).
const MOST_AXES: usize = 16;

/// What an axis is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Role {
    Volume,
    Channel,
    Time,
}

/// The axes in the file's order, fastest first.
pub(super) struct Axes {
    /// Numbers along each.
    pub sizes: Vec<i64>,
    /// Vector along each, in the file's space and unit; None of an axis that is not in space.
    pub directions: Option<Vec<Option<Vec<f64>>>>,
    /// Which of them are x, y, z of the volume.
    pub volume: [usize; 3],
    roles: Vec<Role>,
}

impl Axes {
    pub fn read(path: &Path, header: &HeaderText) -> Result<Self, VolumeError> {
        let count: usize = header.number("dimension", header.need("dimension")?)?;
        if !(3..=MOST_AXES).contains(&count) {
            let what = format!("it has {count} axes, and a volume has three or a few more: save one volume");
            return Err(VolumeError::unsupported(path, what));
        }
        let sizes = header.exactly("sizes", header.need("sizes")?, count)?;
        let directions = directions(header, count)?;
        let kinds: Vec<String> = match header.get(&["kinds"]) {
            Some(value) => value.split_whitespace().map(str::to_ascii_lowercase).collect(),
            None => Vec::new(),
        };
        let kinds: Vec<&str> = (0..count).map(|axis| kinds.get(axis).map_or("???", String::as_str)).collect();
        let roles = match &directions {
            Some(directions) => roles_by_directions(directions, &kinds),
            None => roles_by_kinds(&sizes, &kinds),
        };
        let volume: Vec<usize> = (0..count).filter(|&axis| roles[axis] == Role::Volume).collect();
        let volume = volume.try_into().map_err(|volume: Vec<usize>| {
            let found = volume.len();
            let what =
                format!("{found} of its {count} axes are in space, and a volume needs three: save one");
            VolumeError::unsupported(path, what)
        })?;
        Ok(Self { sizes, directions, volume, roles })
    }

    /// Each axis with its size and what was chosen of it.
    pub fn choose(&self, path: &Path, selection: &Selection) -> Result<Vec<(i64, Axis)>, VolumeError> {
        let channel = choose(path, Several::Channels, self.count(path, Role::Channel)?, selection.channel)?;
        let time = choose(path, Several::Times, self.count(path, Role::Time)?, selection.time)?;
        let chosen = |(&size, &role): (&i64, &Role)| match role {
            Role::Volume => (size, Axis::Volume),
            // The others of that role have one place.
            _ if size == 1 => (size, Axis::At(0)),
            Role::Channel => (size, Axis::At(channel)),
            Role::Time => (size, Axis::At(time)),
        };
        Ok(self.sizes.iter().zip(&self.roles).map(chosen).collect())
    }

    /// How many there are of a role, whose axis is at most one.
    fn count(&self, path: &Path, role: Role) -> Result<i64, VolumeError> {
        let sizes = &self.sizes;
        let several = |&axis: &usize| self.roles[axis] == role && sizes[axis] != 1;
        let axes: Vec<usize> = (0..sizes.len()).filter(several).collect();
        match axes[..] {
            [] => Ok(1),
            [axis] => Ok(sizes[axis]),
            _ => {
                let what =
                    format!("{} of its {} axes are not in space: save one volume", axes.len(), sizes.len());
                Err(VolumeError::unsupported(path, what))
            }
        }
    }
}

/// `space directions`: a vector for each axis, or `none`, which a vector of NaN means too.
fn directions(header: &HeaderText, count: usize) -> Result<Option<Vec<Option<Vec<f64>>>>, VolumeError> {
    let key = "space directions";
    let Some(value) = header.get(&[key]) else { return Ok(None) };
    let mut vectors = Vec::new();
    let mut rest = value;
    while !rest.is_empty() {
        let (vector, after) = match rest.strip_prefix("none") {
            Some(after) => (None, after),
            None => {
                let (vector, after) = vector(header, key, rest)?;
                (Some(vector).filter(|vector| !vector[0].is_nan()), after)
            }
        };
        vectors.push(vector);
        rest = after.trim_start();
    }
    match vectors.len() == count {
        true => Ok(Some(vectors)),
        false => Err(header.wrong(format!("`{key}` is {value:?}, and {count} vectors are expected"))),
    }
}

/// A vector of a space of three axes, or four with time, such as `(1,0,0)`, and the text after it.
pub(super) fn vector<'a>(
    header: &HeaderText,
    key: &str,
    text: &'a str,
) -> Result<(Vec<f64>, &'a str), VolumeError> {
    let (inside, after) = text.strip_prefix('(').and_then(|text| text.split_once(')')).ok_or_else(|| {
        header.wrong(format!("`{key}` has {text:?}, where a vector like (1,0,0) is expected"))
    })?;
    let vector: Vec<f64> = header.numbers(key, &inside.replace(',', " "))?;
    match vector.len() {
        3 | 4 => Ok((vector, after)),
        _ => {
            Err(header.wrong(format!("`{key}` has ({inside}), where a vector of three numbers is expected")))
        }
    }
}

fn roles_by_directions(directions: &[Option<Vec<f64>>], kinds: &[&str]) -> Vec<Role> {
    let role = |axis: usize| match &directions[axis] {
        // Of the fourth axis of a space with time.
        Some(vector) if vector.len() == 4 && vector[..3] == [0.0; 3] => Role::Time,
        Some(_) => Role::Volume,
        None => match (kinds[axis], axis) {
            ("time", _) => Role::Time,
            ("???" | "none" | "domain" | "space", 1..) => Role::Time,
            _ => Role::Channel,
        },
    };
    (0..kinds.len()).map(role).collect()
}

/// What the kinds say; where they leave four axes, one of them is not in space: the last where all are domains, as of
/// volumes one after the other, and else the shorter of first (as of channels) and last.
fn roles_by_kinds(sizes: &[i64], kinds: &[&str]) -> Vec<Role> {
    let role = |kind: &&str| match *kind {
        "time" => Role::Time,
        "domain" | "space" | "???" | "none" => Role::Volume,
        _ => Role::Channel,
    };
    let mut roles: Vec<Role> = kinds.iter().map(role).collect();
    let in_space: Vec<usize> = (0..roles.len()).filter(|&axis| roles[axis] == Role::Volume).collect();
    if let [first, .., last] = in_space[..]
        && in_space.len() == 4
    {
        let is_known = in_space.iter().all(|&axis| matches!(kinds[axis], "domain" | "space"));
        match is_known || sizes[last] < sizes[first] {
            true => roles[last] = Role::Time,
            false => roles[first] = Role::Channel,
        }
    }
    roles
}

#[cfg(test)]
mod tests {
    use super::Role::{Channel, Time, Volume};
    use super::*;

    #[test]
    fn kinds_tell_the_axes() {
        assert_eq!(roles_by_kinds(&[5, 6, 4], &["???"; 3]), [Volume; 3]);
        let vector = ["vector", "domain", "domain", "domain"];
        assert_eq!(roles_by_kinds(&[9, 5, 6, 4], &vector), [Channel, Volume, Volume, Volume]);
        assert_eq!(roles_by_kinds(&[5, 6, 4, 9], &["domain"; 4]), [Volume, Volume, Volume, Time]);
        assert_eq!(roles_by_kinds(&[3, 6, 4, 9], &["???"; 4]), [Channel, Volume, Volume, Volume]);
        assert_eq!(roles_by_kinds(&[5, 6, 4, 2], &["none"; 4]), [Volume, Volume, Volume, Time]);
        let both = ["list", "space", "space", "space", "time"];
        assert_eq!(roles_by_kinds(&[2, 5, 6, 4, 7], &both), [Channel, Volume, Volume, Volume, Time]);
    }

    #[test]
    fn directions_tell_the_axes() {
        let x = Some(vec![1.0, 0.0, 0.0]);
        let directions = [None, x.clone(), x.clone(), x.clone()];
        assert_eq!(roles_by_directions(&directions, &["???"; 4]), [Channel, Volume, Volume, Volume]);
        let directions = [x.clone(), x.clone(), x, None];
        assert_eq!(roles_by_directions(&directions, &["domain"; 4]), [Volume, Volume, Volume, Time]);
        let kinds = ["domain", "domain", "domain", "list"];
        assert_eq!(roles_by_directions(&directions, &kinds), [Volume, Volume, Volume, Channel]);
    }
}
