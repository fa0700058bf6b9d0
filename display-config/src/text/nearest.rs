//! Suggestions for names that are not known.

use super::brief_text;

/// Names less alike than this mean different things. It is what the command line's options are suggested by.
const ALIKE: f64 = 0.7;

/// What to put behind a name that is not known: the one of the known names that is most like it, as a question in
/// brackets; nothing where none is like it.
pub fn did_you_mean<'a>(name: &str, known: impl IntoIterator<Item = &'a str>) -> String {
    let name = name.to_lowercase();
    let alike = |known: &str| strsim::jaro_winkler(&name, &known.to_lowercase());
    let nearest = known.into_iter().map(|known| (alike(known), known));
    let nearest = nearest.filter(|(alike, _)| *alike > ALIKE).max_by(|a, b| a.0.total_cmp(&b.0));
    nearest.map_or(String::new(), |(_, known)| format!(" (did you mean `{known}`?)"))
}

/// The message of a reader about an unknown key or an unknown choice, with a suggestion; any other as it is. What it quotes
/// is cut short.
pub fn with_suggestion(message: &str) -> String {
    let message = message.lines().next().unwrap_or_default();
    let parts: Vec<&str> = message.split('`').collect();
    let [what @ ("unknown field " | "unknown variant "), name, rest @ ..] = parts.as_slice() else {
        return brief_text(message).into_owned();
    };
    let known = rest.iter().skip(1).step_by(2).copied();
    format!("{what}`{}`{}{}", brief_text(name), did_you_mean(name, known), rest.join("`"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_nearest_name_is_suggested() {
        let known = ["screen_width_m", "screen_height_m", "eta", "holo72", "desk8", "+x", "-x"];
        for (name, nearest) in [
            ("screen_width", "screen_width_m"),
            ("scren_hieght_m", "screen_height_m"),
            ("holo", "holo72"),
            ("DESK8", "desk8"),
            ("+X", "+x"),
        ] {
            assert_eq!(did_you_mean(name, known), format!(" (did you mean `{nearest}`?)"), "{name}");
        }
        for name in ["", "colour", "pixels"] {
            assert_eq!(did_you_mean(name, known), "", "{name}");
        }
    }

    #[test]
    fn messages_about_names_carry_a_suggestion() {
        for (message, expected) in [
            (
                "unknown field `toler`, expected one of `preset`, `tolerance`",
                "unknown field `toler` (did you mean `tolerance`?), expected one of `preset`, `tolerance`",
            ),
            (
                "unknown variant `prob`, expected `probe` or `clip_plane`",
                "unknown variant `prob` (did you mean `probe`?), expected `probe` or `clip_plane`",
            ),
            ("unknown field `a`, there are no fields", "unknown field `a`, there are no fields"),
            ("missing field `source`\nbelow", "missing field `source`"),
        ] {
            assert_eq!(with_suggestion(message), expected);
        }
        let long = format!("unknown field `{}`, expected `a`", "x".repeat(200_000));
        assert!(with_suggestion(&long).len() < 300);
    }
}
