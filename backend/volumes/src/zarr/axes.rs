//! The axes of a Zarr array: which is x, y, z, channel and time, and how long their unit is.

use bricks::volume::VolumeError;
use serde_json::Value;
use std::path::Path;

/// Metres of a length whose unit is not given, or not known.
const UNKNOWN_UNIT_M: f64 = 1e-3;

/// Where the axes of an array are among its dimensions. A dimension is none or one of them.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Axes {
    pub count: usize,
    pub x: usize,
    pub y: usize,
    pub z: Option<usize>,
    pub channel: Option<usize>,
    pub time: Option<usize>,
    /// Metres of the unit of each dimension; 1 if it is not a length.
    pub unit_m: Vec<f64>,
    /// Whether the unit of a length is not given or not known, and taken as [`UNKNOWN_UNIT_M`].
    pub has_unknown_unit: bool,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Role {
    X,
    Y,
    Z,
    Channel,
    Time,
}

impl Axes {
    /// Axes as OME-Zarr lists them: objects with name, type and unit, or (before 0.4) names.
    pub fn from_json(path: &Path, json: &Value) -> Result<Self, VolumeError> {
        let wrong = || VolumeError::header(path, format!("`axes` is {json}, and must be a list"));
        let list = json.as_array().ok_or_else(wrong)?;
        let roles: Option<Vec<_>> = list.iter().map(role).collect();
        let roles = roles.ok_or_else(|| {
            VolumeError::unsupported(path, format!("its axes are {json}; only t, c, z, y and x are read"))
        })?;
        let unit = |(axis, role): (&Value, &Role)| match role {
            Role::Channel | Role::Time => Some(1.0),
            _ => axis["unit"].as_str().and_then(|unit| known_unit_m(unit.trim_end_matches('s'))),
        };
        Self::new(path, &roles, list.iter().zip(&roles).map(unit).collect())
    }

    /// Axes of an array that does not name them: z, y, x with the last as many as there are; five as OME-Zarr has them.
    pub fn of_unnamed(path: &Path, count: usize) -> Result<Self, VolumeError> {
        let all = [Role::Time, Role::Channel, Role::Z, Role::Y, Role::X];
        match count {
            2 | 3 | 5 => Self::new(path, &all[5 - count..], vec![None; count]),
            _ => Err(VolumeError::unsupported(
                path,
                format!("it is an array of {count} dimensions without names; give one of 2, 3 or 5"),
            )),
        }
    }

    fn new(path: &Path, roles: &[Role], units_m: Vec<Option<f64>>) -> Result<Self, VolumeError> {
        let place = |role| roles.iter().position(|&other| other == role);
        let twice = roles.iter().enumerate().any(|(at, &role)| place(role) != Some(at));
        match (place(Role::X), place(Role::Y), twice) {
            (Some(x), Some(y), false) => Ok(Self {
                count: roles.len(),
                x,
                y,
                z: place(Role::Z),
                channel: place(Role::Channel),
                time: place(Role::Time),
                has_unknown_unit: units_m.contains(&None),
                unit_m: units_m.into_iter().map(|unit_m| unit_m.unwrap_or(UNKNOWN_UNIT_M)).collect(),
            }),
            _ => Err(VolumeError::header(path, "its axes must have one x, one y and no axis twice")),
        }
    }
}

fn role(axis: &Value) -> Option<Role> {
    let name = axis.as_str().or_else(|| axis["name"].as_str()).unwrap_or_default().to_ascii_lowercase();
    match (axis["type"].as_str(), name.as_str()) {
        (Some("channel"), _) | (None, "c" | "channel") => Some(Role::Channel),
        (Some("time"), _) | (None, "t" | "time") => Some(Role::Time),
        (Some("space") | None, "x") => Some(Role::X),
        (Some("space") | None, "y") => Some(Role::Y),
        (Some("space") | None, "z") => Some(Role::Z),
        _ => None,
    }
}

/// Metres of a unit of length as UDUNITS names it, without an s at its end.
fn known_unit_m(unit: &str) -> Option<f64> {
    Some(match unit {
        "m" | "meter" | "metre" => 1.0,
        "yoctometer" => 1e-24,
        "zeptometer" => 1e-21,
        "attometer" => 1e-18,
        "femtometer" => 1e-15,
        "picometer" | "pm" => 1e-12,
        "angstrom" | "Å" => 1e-10,
        "nanometer" | "nanometre" | "nm" => 1e-9,
        "micrometer" | "micrometre" | "micron" | "um" | "µm" | "μm" => 1e-6,
        "millimeter" | "millimetre" | "mm" => 1e-3,
        "centimeter" | "centimetre" | "cm" => 1e-2,
        "decimeter" | "decimetre" | "dm" => 1e-1,
        "hectometer" => 1e2,
        "kilometer" | "kilometre" | "km" => 1e3,
        "megameter" => 1e6,
        "gigameter" => 1e9,
        "terameter" => 1e12,
        "petameter" => 1e15,
        "exameter" => 1e18,
        "zettameter" => 1e21,
        "yottameter" => 1e24,
        // The international inch, foot, yard and mile (1959); the parsec of the IAU (2015).
        "inch" | "inche" => 0.0254,
        "foot" => 0.3048,
        "yard" => 0.9144,
        "mile" => 1609.344,
        "parsec" => 3.085_677_581_491_367e16,
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    fn axes(json: Value) -> Result<Axes, String> {
        Axes::from_json(Path::new("a.zarr"), &json).map_err(|error| error.to_string())
    }

    #[test]
    fn axes_are_found_by_type_and_name() {
        let found = axes(json!([
            {"name": "t", "type": "time", "unit": "second"},
            {"name": "stain", "type": "channel"},
            {"name": "z", "type": "space", "unit": "micrometers"},
            {"name": "y", "type": "space", "unit": "nanometer"},
            {"name": "x", "type": "space"},
        ]));
        let found = found.unwrap();
        assert_eq!((found.time, found.channel, found.z, found.y, found.x), (Some(0), Some(1), Some(2), 3, 4));
        assert_eq!((&found.unit_m[..], found.has_unknown_unit), (&[1.0, 1.0, 1e-6, 1e-9, 1e-3][..], true));
        assert_eq!(axes(json!(["y", "x"])).unwrap().z, None);
    }

    #[test]
    fn strange_axes_are_refused() {
        assert!(axes(json!(["z", "y", "y", "x"])).unwrap_err().contains("twice"));
        assert!(axes(json!(["z", "y"])).unwrap_err().contains("one x"));
        assert!(axes(json!(["phi", "y", "x"])).unwrap_err().contains("only t, c, z, y and x"));
        assert!(axes(json!(7)).unwrap_err().contains("must be a list"));
        assert!(Axes::of_unnamed(Path::new("a"), 4).is_err());
    }
}
