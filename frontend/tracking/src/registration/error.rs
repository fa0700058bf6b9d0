//! Why point pairs make no registration.

use std::fmt;

/// A frame of reference.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Frame {
    /// The tracker's.
    Tracker,
    /// The display's.
    Display,
}

impl fmt::Display for Frame {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        out.write_str(match self {
            Self::Tracker => "tracker",
            Self::Display => "display",
        })
    }
}

/// A pair that does not fit to the others.
#[derive(Clone, Debug, PartialEq)]
pub struct Outlier {
    /// The pair's name.
    pub name: String,
    /// How far its points are apart when the others are registered without it, metres.
    pub distance_m: f64,
}

/// Each is one sentence that says what is wrong and what to do. Lengths are in metres.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[allow(missing_docs, reason = "the message beside each variant says what its fields are")]
pub enum RegistrationError {
    /// Fewer than three.
    #[error(
        "{count} point pairs do not fix a rotation; measure at least three points that are not on a line"
    )]
    TooFew { count: usize },
    /// More than anybody measures.
    #[error("{count} point pairs are too many; give at most {most}")]
    TooMany { count: usize, most: usize },
    /// NaN, infinite or very far.
    #[error(
        "pair `{name}` has a coordinate in the {frame} frame that is no number from -1000000 to 1000000; measure it again"
    )]
    NotAPoint { name: String, frame: Frame },
    /// One reading, twice.
    #[error(
        "pairs `{first}` and `{second}` have the same tracker point; remove one of them, or measure it again"
    )]
    Duplicate { first: String, second: String },
    /// On a line, or nearly.
    #[error(
        "in the {frame} frame all points lie within {width_m:.3} m of a line, along which they spread by {length_m:.3} m \
         (RMS), so nothing fixes the turn about it; add a point well away from the line"
    )]
    Collinear { frame: Frame, width_m: f64, length_m: f64 },
    /// Not metres.
    #[error(
        "the points are {scale:.4} times as far apart in the display frame as in the tracker frame, so {cause}; give both \
         in metres"
    )]
    Units { scale: f64, cause: &'static str },
    /// One frame is the mirror image of the other.
    #[error(
        "the tracker's axes are left-handed: mirrored, the points fit within {mirrored_rms_m:.4} m RMS, and as they are \
         within {rms_m:.4} m; negate one axis of the tracker, for instance z"
    )]
    LeftHanded { rms_m: f64, mirrored_rms_m: f64 },
    /// Some pairs are wrong.
    #[error(
        "{} from where the other pairs put {}, and these fit within {rms_without_m:.4} m RMS; measure {} again",
        listed(outliers),
        if outliers.len() == 1 { "it" } else { "them" },
        if outliers.len() == 1 { "it" } else { "them" }
    )]
    Outliers { outliers: Vec<Outlier>, rms_without_m: f64 },
    /// Nothing fits, and no few pairs are the cause.
    #[error(
        "the pairs do not fit together: {rms_m:.3} m RMS are left, most at `{worst}`, and the best scale is {scale:.3}; \
         check the order of the points and that nothing has moved, and measure them again"
    )]
    TooFarApart { rms_m: f64, worst: String, scale: f64 },
}

/// "pair `a` is 0.3 m", "pairs `a` and `b` are 0.3 m and 0.4 m", each at most so many.
fn listed(outliers: &[Outlier]) -> String {
    const MOST: usize = 5;
    let join = |mut parts: Vec<String>| {
        parts.truncate(MOST);
        if outliers.len() > MOST {
            parts.push("others".to_owned());
        }
        let last = parts.pop().unwrap_or_default();
        if parts.is_empty() { last } else { format!("{} and {last}", parts.join(", ")) }
    };
    let names = join(outliers.iter().map(|outlier| format!("`{}`", outlier.name)).collect());
    let distances = join(outliers.iter().map(|outlier| format!("{:.3} m", outlier.distance_m)).collect());
    match outliers.len() {
        1 => format!("pair {names} is {distances}"),
        _ => format!("pairs {names} are {distances}"),
    }
}
