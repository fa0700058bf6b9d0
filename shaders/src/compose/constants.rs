//! The constants that host and kernels share, as WGSL.

use layout::present::{
    CODED_PIXELS, CODES, CURVE_NUMBERS, DITHER_BITS, HAS_BLACK_MAP, HAS_BLEND, HAS_WARP, IS_DITHERED,
    MOST_PAIRS, NOWHERE,
};
use layout::{
    CODE_OF_ZERO, CODES_PER_LEVEL, CUT, MISSING, MOST_DEFICIT, NO_NODE, NO_SLOT, PLANE_COLUMNS, SAMPLE_COUNT,
    SHORT_RAYS, TALLIED_TILES, TILE_EDGE, binding, brick,
};
use optics::MOST_ENHANCERS;

/// A declaration each: bindings, the geometry of a brick, the codes of feedback.
pub(super) fn wgsl() -> String {
    let mut text = String::from("// Written by the composer, from the crate layout.\n\n");
    let mut declare = |name: &str, kind: &str, value: String| {
        text += &format!("const {name}: {kind} = {value};\n");
    };
    for (name, number) in binding::ALL {
        declare(&format!("BINDING_{name}"), "u32", format!("{number}u"));
    }
    let counts = [
        ("BRICK_EDGE", brick::EDGE),
        ("CELLS_ACROSS", brick::CELLS_ACROSS),
        ("CELL_WORDS", brick::CELL_WORDS),
        ("MOST_LINKS", MOST_ENHANCERS),
        ("MOST_PAIRS", MOST_PAIRS),
        ("CODES", CODES),
        ("CURVE_NUMBERS", CURVE_NUMBERS),
    ];
    for (name, count) in counts {
        declare(name, "u32", format!("{count}u"));
    }
    let codes = [
        ("NO_NODE", NO_NODE),
        ("NO_SLOT", NO_SLOT),
        ("MISSING", MISSING),
        ("CUT", CUT),
        ("SAMPLE_COUNT", SAMPLE_COUNT),
        ("TILE_EDGE", TILE_EDGE),
        ("SHORT_RAYS", SHORT_RAYS),
        ("PLANE_COLUMNS", PLANE_COLUMNS),
        ("TALLIED_TILES", TALLIED_TILES),
        ("CODED_PIXELS", CODED_PIXELS),
        ("DITHER_BITS", DITHER_BITS),
        ("HAS_WARP", HAS_WARP),
        ("HAS_BLEND", HAS_BLEND),
        ("HAS_BLACK_MAP", HAS_BLACK_MAP),
        ("IS_DITHERED", IS_DITHERED),
    ];
    for (name, code) in codes {
        declare(name, "u32", format!("{code}u"));
    }
    let lengths = [
        ("OVERLAP", brick::OVERLAP as f32),
        ("OWN_EDGE", brick::OWN_EDGE as f32),
        ("CELL_EDGE", brick::CELL_EDGE as f32),
        ("CODE_OF_ZERO", CODE_OF_ZERO),
        ("CODES_PER_LEVEL", CODES_PER_LEVEL),
        ("MOST_DEFICIT", MOST_DEFICIT),
        ("NOWHERE", NOWHERE),
    ];
    for (name, length) in lengths {
        declare(name, "f32", format!("{length:?}"));
    }
    text
}
