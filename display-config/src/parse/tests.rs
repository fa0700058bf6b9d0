//! Each way a display file can be wrong; each gets one sentence.

use super::*;
use proptest::prelude::*;

pub(super) const HEAD: &str = r#"name = "two"
screen_width_m = 1.6
screen_height_m = 0.9
pixel_size_m = 0.0015
angular_accuracy_deg = 0.8
observer_m = [0.0, 0.0, 3.0]
eta = 1
"#;

pub(super) const PROJECTORS: &str = r#"
[[projector]]
name = "left"
centre_m = [-1.0, 0.0, -6.0]
width_px = 800
height_px = 600
screen_rect_m = [-0.8, -0.45, 1.6, 0.9]
backend = 0

[[projector]]
name = "right"
centre_m = [1.0, 0.0, -6.0]
width_px = 800
height_px = 600
corners_m = [[-0.8, 0.45], [0.8, 0.45], [0.8, -0.45], [-0.8, -0.45]]
backend = 1
output = { name = "DP-1", x_px = 0, y_px = 600 }
"#;

pub(super) const LINE: &str = r#"
[projector_line]
count = 3
from_m = [-1.0, 0.0, -6.0]
to_m = [1.0, 0.0, -6.0]
width_px = 800
height_px = 600
covers = "screen"
backends = 2
"#;

pub(super) fn listed() -> String {
    format!("{HEAD}{PROJECTORS}")
}

fn backends_of(display: &Display) -> Vec<u32> {
    display.projectors.iter().map(|projector| projector.backend).collect()
}

/// The message about the listed display with one piece of its text changed.
pub(super) fn message(from: &str, to: &str) -> String {
    message_of(&listed(), from, to)
}

pub(super) fn message_of(text: &str, from: &str, to: &str) -> String {
    assert!(text.contains(from), "the test changes nothing: {from}");
    let message = Display::from_toml(&text.replacen(from, to, 1), "two.toml").unwrap_err().to_string();
    assert!(message.starts_with("two.toml, line "), "{message}");
    assert!(!message.contains('\n'), "{message}");
    message
}

#[test]
fn a_list_of_projectors_becomes_a_display() {
    let display = Display::from_toml(&listed(), "two.toml").unwrap();
    assert_eq!((display.eta, display.rate_hz), (1.0, 60.0));
    assert_eq!(backends_of(&display), [0, 1]);
    let [left, right] = &display.projectors[..] else { panic!("two projectors") };
    // A rectangle and its own four corners are one map.
    for pixel in [DVec2::ZERO, DVec2::new(800.0, 600.0), DVec2::new(123.0, 456.0)] {
        let difference =
            left.raster.screen_from_pixel.apply(pixel) - right.raster.screen_from_pixel.apply(pixel);
        assert!(difference.length() < 1e-12);
    }
}

#[test]
fn a_homography_is_read_by_rows() {
    let rows = "homography = [[0.002, 0, -0.8],\n [0, -0.0015, 0.45],\n [0, 0, 1]]";
    let text = listed().replace("screen_rect_m = [-0.8, -0.45, 1.6, 0.9]", rows);
    let display = Display::from_toml(&text, "two.toml").unwrap();
    let raster = &display.projectors[0].raster;
    assert!((raster.pixel_on_screen(0, 0) - DVec2::new(-0.799, 0.44925)).length() < 1e-12);
}

#[test]
fn a_line_of_projectors_is_even_and_shared() {
    let display = Display::from_toml(&format!("{HEAD}{LINE}"), "line.toml").unwrap();
    let xs: Vec<f64> = display.projectors.iter().map(|p| p.centre_in_display.x).collect();
    assert_eq!(xs, [-1.0, 0.0, 1.0]);
    assert_eq!(backends_of(&display), [0, 1, 1]);
    assert_eq!(display.projectors[2].name, "projector-2");
}

#[test]
fn wrong_keys_are_named_with_their_line() {
    assert_eq!(
        message("width_px = 800", "width_px = 800\ncolour = 1"),
        "two.toml, line 13: `colour` is not a key of this table; remove it, or use `name`, `centre_m`, `width_px`, \
         `height_px`, `screen_rect_m`, `homography`, `corners_m`, `backend`, `output`, `finish`"
    );
    assert_eq!(
        message("backend = 1\n", ""),
        "two.toml, line 17: `backend` is missing from the table that starts here; add it"
    );
    let missing = message("eta = 1\n", "");
    assert_eq!(missing, "two.toml, line 1: `eta` is missing from the table that starts here; add it");
    let inner = message("x_px = 0, ", "");
    assert!(inner.starts_with("two.toml, line 24: `x_px` is missing"), "{inner}");
    let line = message_of(&format!("{HEAD}{LINE}"), "covers = \"screen\"\n", "");
    assert!(line.starts_with("two.toml, line 9: `covers` is missing"), "{line}");
}

#[test]
fn wrong_types_are_named_with_their_line_and_key() {
    assert_eq!(
        message("screen_height_m = 0.9", "screen_height_m = \"0.9\""),
        "two.toml, line 3: `screen_height_m` cannot have this value (invalid type: string \"0.9\", expected a \
         number); give what it expects"
    );
    for (from, to, start) in [
        ("width_px = 800", "width_px = -1", "two.toml, line 12: `width_px` cannot have this value"),
        ("width_px = 800", "width_px = 80.5", "two.toml, line 12: `width_px` cannot have this value"),
        ("[0.0, 0.0, 3.0]", "[0.0, 3.0]", "two.toml, line 6: `observer_m` cannot have this value"),
        ("[0.0, 0.0, 3.0]", "[0.0, 0.0, 3.0, nan]", "two.toml, line 6: `observer_m` cannot have this value"),
        ("x_px = 0", "x_px = true", "two.toml, line 24: `x_px` cannot have this value"),
    ] {
        let message = message(from, to);
        assert!(message.starts_with(start), "{message}");
    }
    let choice = message_of(&format!("{HEAD}{LINE}"), "\"screen\"", "\"wall\"");
    assert!(choice.contains("line 15: `covers` cannot have this value (unknown variant `wall`"), "{choice}");
    let table = message("eta = 1\n", "[eta]\n");
    assert!(table.starts_with("two.toml, line 7: `eta` cannot have this value"), "{table}");
    let lines = message_of(&format!("{HEAD}{LINE}"), "[projector_line]", "[[projector_line]]");
    assert!(lines.contains("line 9: `projector_line` cannot have this value"), "{lines}");
    let empty = Display::from_toml(&format!("{HEAD}projector = []"), "two.toml").unwrap_err().to_string();
    assert!(empty.starts_with("two.toml, line 8: `projector` is absent or empty"), "{empty}");
}

#[test]
fn lists_have_as_many_numbers_as_their_keys_take() {
    for (text, key) in [
        (format!("{HEAD}{LINE}").replace("from_m = [", "from_m = [1, "), "from_m"),
        (one_placed("screen_rect_m = [0.0, 0.0, 1.0, 1.0, 1.0]"), "screen_rect_m"),
        (one_placed("homography = [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]"), "homography"),
        (one_placed("homography = [[1, 0, 0], [0, 1, 0], [0, 0, 1], [0, 0, 1]]"), "homography"),
        (one_placed("corners_m = [[0, 1], [1, 1], [1, 0], [0, 0], [0, 1]]"), "corners_m"),
        (one_placed("corners_m = [[0, 1, 2], [1, 1], [1, 0], [0, 0]]"), "corners_m"),
    ] {
        let error = Display::from_toml(&text, "two.toml").unwrap_err().to_string();
        let place = format!("`{key}` cannot have this value (invalid length");
        assert!(error.contains(&place), "{key}: {error}");
    }
}

/// A display of one projector, placed like this.
fn one_placed(placement: &str) -> String {
    format!(
        "{HEAD}[[projector]]\nname = 'a'\ncentre_m = [0, 0, -3]\nwidth_px = 8\nheight_px = 6\n{placement}\nbackend = 0\n"
    )
}

#[test]
fn rasters_that_no_machine_holds_are_refused() {
    for (width, height, place) in [
        (0, 8, "`width_px` is 0; give a number of pixels from 1 to 16384"),
        (4_294_967_295_u32, 8, "`width_px` is 4294967295; give"),
        (8, 16_385, "`height_px` is 16385; give"),
        (
            16_384,
            16_384,
            "`height_px` makes a picture of 16384 × 16384 pixels; give at most 67108864 of them",
        ),
    ] {
        let pixels = |text: &str| {
            let text = text.replace("width_px = 8\n", &format!("width_px = {width}\n"));
            text.replace("height_px = 6\n", &format!("height_px = {height}\n"))
        };
        let text = pixels(&one_placed("screen_rect_m = [0, 0, 1, 1]"));
        let error = Display::from_toml(&text, "two.toml").unwrap_err().to_string();
        assert!(error.contains(place), "{error}");
    }
}

#[test]
fn what_is_nearly_known_is_suggested() {
    let told = message("screen_width_m", "screen_width");
    assert!(
        told.contains("`screen_width` is not a key of this table (did you mean `screen_width_m`?); remove"),
        "{told}"
    );
    let told = message_of(&format!("{HEAD}{LINE}"), "\"screen\"", "\"Screens\"");
    assert!(told.contains("unknown variant `Screens` (did you mean `screen`?)"), "{told}");
}

#[test]
fn long_keys_and_numbers_are_told_in_few_letters() {
    let long = "x".repeat(200_000);
    let told = message("eta = 1\n", &format!("eta = 1\n{long} = 1\n"));
    assert!(told.len() < 1000, "{}", told.len());
    let told = message("eta = 1\n", "eta = 1e300\n");
    assert!(told.contains("`eta` is 1e300; give"), "{told}");
    let told = message("[0.0, 0.0, 3.0]", "[0.0, -1e300, 3.0]");
    assert!(told.contains("`observer_m` is -1e300; give coordinates"), "{told}");
    let told = message("screen_width_m = 1.6", "screen_width_m = 1e300");
    assert!(told.contains("`screen_width_m` is 1e300; give a length"), "{told}");
}

#[test]
fn broken_toml_is_told_apart() {
    let text = message("eta = 1", "eta = = 1");
    assert!(text.starts_with("two.toml, line 7: this is not TOML"), "{text}");
    let text = message("eta = 1", "eta = 1\neta = 1");
    assert!(text.starts_with("two.toml, line 8: this is not TOML (duplicate key"), "{text}");
}

#[test]
fn a_display_without_projectors_is_refused() {
    let none = Display::from_toml(HEAD, "two.toml").unwrap_err().to_string();
    assert!(none.starts_with("two.toml, line 1: `projector` is absent or empty"), "{none}");
    let zero = message_of(&format!("{HEAD}{LINE}"), "count = 3", "count = 0");
    assert_eq!(zero, "two.toml, line 10: `count` is 0; give a number of projectors from 1 to 65536");
    let both = Display::from_toml(&format!("{HEAD}{LINE}{PROJECTORS}"), "two.toml").unwrap_err().to_string();
    assert!(both.starts_with("two.toml, line 9: `projector_line` and [[projector]]"), "{both}");
}

#[test]
fn numbers_outside_their_range_are_refused() {
    for (from, to, start) in [
        ("1.6", "-1.6", "line 2: `screen_width_m` is -1.6; give a length in metres, above 0"),
        ("0.9\n", "0\n", "line 3: `screen_height_m` is 0; give a length"),
        ("0.0015", "0", "line 4: `pixel_size_m` is 0; give a length"),
        ("0.8\n", "0\n", "line 5: `angular_accuracy_deg` is 0; give an angle in degrees above 0"),
        ("0.8\n", "180\n", "line 5: `angular_accuracy_deg` is 180; give an angle"),
        ("3.0]", "0]", "line 6: `observer_m` is 0; give an observer before the screen"),
        ("3.0]", "-3.0]", "line 6: `observer_m` is -3; give an observer before the screen"),
        ("eta = 1", "eta = 1.01", "line 7: `eta` is 1.01; give a number from 0"),
        ("eta = 1", "eta = -1", "line 7: `eta` is -1; give a number from 0"),
        ("eta = 1", "eta = 1\nrate_hz = 0", "line 8: `rate_hz` is 0; give a rate"),
        ("width_px = 800", "width_px = 0", "line 12: `width_px` is 0; give a number of pixels"),
        ("height_px = 600", "height_px = 0", "line 13: `height_px` is 0; give a number of pixels"),
        ("1.6, 0.9]", "1.6, -0.9]", "line 14: `screen_rect_m` is -0.9; give [left, bottom, width, height]"),
    ] {
        let message = message(from, to);
        assert!(message.contains(start), "{message}");
    }
}

#[test]
fn numbers_that_are_not_finite_are_refused() {
    for (from, to, start) in [
        ("1.6", "inf", "line 2: `screen_width_m` has an infinite number or NaN"),
        ("eta = 1", "eta = nan", "line 7: `eta` has an infinite number or NaN"),
        ("[0.0, 0.0, 3.0]", "[nan, 0.0, 3.0]", "line 6: `observer_m` has an infinite number or NaN"),
        ("[-1.0, 0.0", "[-inf, 0.0", "line 11: `centre_m` has an infinite number or NaN"),
        ("[-0.8, -0.45, 1.6", "[nan, -0.45, 1.6", "line 14: `screen_rect_m` has an infinite number or NaN"),
        ("[[-0.8, 0.45]", "[[inf, 0.45]", "line 22: `corners_m` has an infinite number or NaN"),
    ] {
        let message = message(from, to);
        assert!(message.contains(start), "{message}");
    }
}

#[test]
fn a_projector_in_the_screen_plane_is_refused() {
    let listed = message("[-1.0, 0.0, -6.0]", "[-1.0, 0.0, 0.0]");
    assert!(
        listed.starts_with("two.toml, line 11: `centre_m` puts a projector in the screen plane"),
        "{listed}"
    );
    let line = format!("{HEAD}{LINE}");
    let at_the_end = message_of(&line, "to_m = [1.0, 0.0, -6.0]", "to_m = [1.0, 0.0, -0.0]");
    assert!(at_the_end.contains("line 12: `to_m` puts a projector in the screen plane"), "{at_the_end}");
    let between = message_of(&line, "to_m = [1.0, 0.0, -6.0]", "to_m = [1.0, 0.0, 6.0]");
    assert!(between.contains("line 12: `to_m` puts a projector in the screen plane"), "{between}");
}

#[test]
fn singular_rasters_are_refused() {
    let rectangle = "screen_rect_m = [-0.8, -0.45, 1.6, 0.9]";
    for placement in [
        "homography = [[1, 2, 3], [2, 4, 6], [0, 0, 1]]",
        "homography = [[0, 0, 0], [0, 0, 0], [0, 0, 0]]",
        "homography = [[0.001, 0, 0], [0, 0.001, 0], [-0.002, 0, 1]]",
        "corners_m = [[0, 0], [1, 1], [2, 2], [3, 3]]",
        "corners_m = [[0, 0], [0, 0], [0, 0], [0, 0]]",
        "corners_m = [[0, 1], [1, 1], [0, 0], [1, 0]]",
    ] {
        let message = message(rectangle, placement);
        let key = placement.split(' ').next().unwrap();
        assert!(message.starts_with(&format!("two.toml, line 14: `{key}` is singular")), "{message}");
    }
}

#[test]
fn exactly_one_placement_is_asked_for() {
    let rectangle = "screen_rect_m = [-0.8, -0.45, 1.6, 0.9]\n";
    let none = message(rectangle, "");
    assert!(none.starts_with("two.toml, line 9: `projector` has 0 of the keys screen_rect_m"), "{none}");
    let both = message(rectangle, &format!("{rectangle}homography = [[1,0,0],[0,1,0],[0,0,1]]\n"));
    assert!(both.starts_with("two.toml, line 9: `projector` has 2 of the keys screen_rect_m"), "{both}");
}

#[test]
fn names_are_each_projectors_own() {
    let name = message("\"right\"", "\"left\"");
    assert!(name.starts_with("two.toml, line 18: `name` `left` is already the name"), "{name}");
    let empty = message("\"left\"", "\" \"");
    assert!(empty.starts_with("two.toml, line 10: `name` is empty"), "{empty}");
}

#[test]
fn back_ends_are_numbered_without_gaps() {
    let gap = message("backend = 1", "backend = 2");
    assert_eq!(
        gap,
        "two.toml, line 23: `backend` is 2, but no projector has back-end 1; number the back-ends from 0 without gaps"
    );
    let late = message("backend = 0", "backend = 1");
    assert!(late.contains("no projector has back-end 0"), "{late}");
    let line = format!("{HEAD}{LINE}");
    let many = message_of(&line, "backends = 2", "backends = 4");
    assert!(many.contains("line 16: `backends` is 4 for 3 projectors"), "{many}");
    let none = message_of(&line, "backends = 2", "backends = 0");
    assert!(none.contains("line 16: `backends` is 0; give a number of back-ends"), "{none}");
}

#[test]
fn back_ends_may_name_their_adapters() {
    let listed = |tables: &str| Display::from_toml(&format!("{}{tables}", listed()), "two.toml");
    let adapters = |tables| listed(tables).unwrap().adapters;
    assert_eq!(adapters(""), []);
    let tables = "[[backend]]\n[[backend]]\nadapter = 'RTX'\n";
    assert_eq!(adapters(tables), [None, Some("RTX".to_owned())]);
    let message = |tables| listed(tables).unwrap_err().to_string();
    assert_eq!(
        message("[[backend]]\n[[backend]]\n[[backend]]\nadapter = 'RTX'\n"),
        "two.toml, line 27: `backend` is the table of back-end 2, but the projectors' back-ends end at 1; remove it, or \
         give that back-end a projector"
    );
    assert!(message("[[backend]]\nadapter = ' '\n").starts_with("two.toml, line 26: `adapter` is empty"));
    assert!(message("[[backend]]\ncard = 1\n").contains("line 26: `card` is not a key of this table"));
    assert!(message("[[backend]]\nadapter = 1\n").contains("line 26: `adapter` cannot have this value"));
}

#[test]
fn names_that_are_no_display_say_what_is() {
    let unknown = Display::load("holo73").unwrap_err().to_string();
    assert_eq!(
        unknown,
        "there is no preset display `holo73` (did you mean `holo72`?); use one of holo72, desk8, or give the path of a \
         .toml file"
    );
    let absent = Display::load("no/such/display.toml").unwrap_err().to_string();
    assert!(absent.starts_with("cannot read the display file no/such/display.toml:"), "{absent}");
}

#[test]
fn a_file_is_loaded_by_its_path() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/presets/desk8.toml");
    assert_eq!(Display::load(path).unwrap(), Display::load("desk8").unwrap());
}

proptest! {
    #![proptest_config(crate::fixed_seed::config())]

    /// No text, however spoiled, panics or gives a message of several lines.
    #[test]
    fn spoiled_text_is_an_error_or_a_display(cut in 0usize..700, insert in "[\\[\\]{}=\"#a-z0-9.,\n é-]{0,6}") {
        let mut text = listed();
        let at = cut.min(text.len());
        text.insert_str(at, &insert);
        if let Err(error) = Display::from_toml(&text, "two.toml") {
            prop_assert!(!error.to_string().contains('\n'), "{}", error);
        }
    }
}
