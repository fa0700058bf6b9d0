//! Kernels and their twins lie under one name.

use crate::assert_none;
use crate::sources::sources;
use std::collections::BTreeSet;

/// Why some twins lie elsewhere.
const SHOWS: &str = "it casts no rays: the CPU device shows with it, and nobody asks for it in f64";
/// The same of row planes.
const BY_BLOCKS: &str =
    "the CPU goes through eight columns or pixels at a time, and samples closer where a GPU casts rays";

/// WGSL modules whose twin has another stem, or none, with the reason.
const ODD_TWINS: [(&str, Option<&str>, &str); 53] = [
    ("composite/plain_sample", Some("shaders/twin/src/composite/sample.rs"), "a constant in the twin"),
    ("debug/none", Some("shaders/twin/src/debug/mod.rs"), "a branch in the twin"),
    ("enhance/importance", Some("shaders/twin/src/enhance/band_picker.rs"), "one reads it, one writes it"),
    ("enhance/no_importance", Some("shaders/twin/src/enhance/chain.rs"), "a branch in the twin"),
    ("enhance/none", Some("shaders/twin/src/enhance/chain.rs"), "a chain without links"),
    ("gradient/blended", Some("shaders/twin/src/gradient/detail.rs"), "a branch in the twin"),
    ("gradient/none", Some("shaders/twin/src/gradient/detail.rs"), "a constant in the twin"),
    ("gradient/own", Some("shaders/twin/src/gradient/detail.rs"), "a branch in the twin"),
    ("gradient/toward_parent", Some("shaders/twin/src/gradient/detail.rs"), "a branch in the twin"),
    ("layout", Some("shaders/layout/src/lib.rs"), "the host's structs are used beyond the twin"),
    ("levels/no_weights", Some("shaders/twin/src/levels/weights.rs"), "a constant in the twin"),
    ("levels/one", Some("shaders/twin/src/levels/three.rs"), "the twin of three without its ancestors"),
    ("levels/two", Some("shaders/twin/src/levels/three.rs"), "the twin of three without its grandparent"),
    ("material/one", Some("shaders/twin/src/material.rs"), "a branch in the twin"),
    ("material/table", Some("shaders/twin/src/material.rs"), "a branch in the twin"),
    (
        "listed",
        Some("backend/renderer/src/device/tile_list.rs"),
        "the CPU device goes through the lists themselves",
    ),
    ("place/halved", Some("shaders/twin/src/tables.rs"), "a branch in the twin"),
    ("place/listed", Some("shaders/twin/src/tables.rs"), "a branch in the twin"),
    ("sample/quads", Some("shaders/twin/src/sample.rs"), "the twin has one way to sample"),
    (
        "sample/exact",
        Some("shaders/twin/src/sample.rs"),
        "the twin has one way to sample: there is no choice to name",
    ),
    ("sample/gathered", Some("shaders/twin/src/sample.rs"), "the same numbers from other instructions"),
    ("planes/alone/cell", Some("shaders/planes/src/pixels.rs"), BY_BLOCKS),
    ("planes/alone/errors", Some("shaders/planes/src/need.rs"), BY_BLOCKS),
    ("planes/errors", Some("shaders/planes/src/need.rs"), BY_BLOCKS),
    ("planes/fill", Some("shaders/planes/src/fill.rs"), BY_BLOCKS),
    ("planes/front/importance", Some("shaders/planes/src/view_row.rs"), "a list of its own on the CPU"),
    ("planes/front/over", Some("shaders/planes/src/view_row.rs"), "a view's row is kept on the CPU"),
    ("planes/gradient/none", Some("shaders/planes/src/slab.rs"), "a number on the CPU"),
    ("planes/gradient/one", Some("shaders/planes/src/slab.rs"), "a number on the CPU"),
    ("planes/gradient/three", Some("shaders/planes/src/slab.rs"), "a number on the CPU"),
    ("planes/grid", Some("shaders/planes/src/fan.rs"), BY_BLOCKS),
    ("planes/kept", Some("shaders/planes/src/slab.rs"), BY_BLOCKS),
    ("planes/place", Some("shaders/planes/src/blocks.rs"), BY_BLOCKS),
    ("planes/shared/cell", Some("shaders/planes/src/sweep.rs"), BY_BLOCKS),
    ("planes/shared/errors", Some("shaders/planes/src/classify.rs"), BY_BLOCKS),
    ("planes/shared/kept", Some("shaders/planes/src/slab.rs"), BY_BLOCKS),
    ("planes/shared/lit", Some("shaders/planes/src/means.rs"), BY_BLOCKS),
    ("planes/shared/means", Some("shaders/planes/src/means.rs"), BY_BLOCKS),
    ("planes/shared/unlit", Some("shaders/planes/src/means.rs"), "a branch on the CPU"),
    ("planes/sweep", Some("shaders/planes/src/sweep.rs"), BY_BLOCKS),
    ("present/block", Some("shaders/layout/src/present.rs"), "the host's struct is used beyond the renderer"),
    ("present/ease", Some("backend/renderer/src/present/ease.rs"), SHOWS),
    ("present/layers", Some("backend/renderer/src/present/layers.rs"), SHOWS),
    ("present/finish", Some("backend/renderer/src/present/finish/mod.rs"), SHOWS),
    (
        "present/paint",
        Some("backend/screens/src/wall/pixels.rs"),
        "windows that no GPU paints get their pixels there",
    ),
    ("present/reconstruct", Some("backend/renderer/src/present/reconstruct.rs"), SHOWS),
    ("present/transfer", Some("backend/renderer/src/present/finish/transfer.rs"), SHOWS),
    ("present/warp", Some("backend/renderer/src/present/finish/warp.rs"), SHOWS),
    ("spread/none", Some("shaders/twin/src/spread/level.rs"), "a branch in the twin"),
    ("spread/one", Some("shaders/twin/src/spread/three.rs"), "the twin of three without ancestors"),
    ("spread/two", Some("shaders/twin/src/spread/three.rs"), "the twin of three without a grandparent"),
    ("tally", Some("backend/renderer/src/device/tiles.rs"), "the CPU device adds up as it casts"),
    ("sample/hardware", None, "the texture unit does it; its precision is measured instead"),
];

/// WGSL modules without a twin, and exceptions that no longer hold.
fn wrong_twins(paths: &BTreeSet<&str>) -> Vec<String> {
    let odd = |stem: &str| ODD_TWINS.iter().find(|(name, ..)| *name == stem);
    let stem = |path: &str| path.strip_prefix("shaders/wgsl/")?.strip_suffix(".wgsl").map(str::to_owned);
    let stems: BTreeSet<String> = paths.iter().filter_map(|path| stem(path)).collect();
    let twin = |stem: &str| match odd(stem) {
        Some((_, twin, _)) => twin.map(str::to_owned),
        None => Some(format!("shaders/twin/src/{stem}.rs")),
    };
    let has_twin = |stem: &&String| twin(stem).is_none_or(|twin| paths.contains(twin.as_str()));
    let alone = stems.iter().filter(|stem| !has_twin(stem)).map(|stem| format!("{stem}.wgsl has no twin"));
    let stale = ODD_TWINS.iter().filter(|(name, ..)| !stems.contains(*name));
    alone.chain(stale.map(|(name, ..)| format!("{name} is an exception for nothing"))).collect()
}

#[test]
fn twins_share_a_stem() {
    let sources = sources();
    let paths: BTreeSet<&str> = sources.iter().map(|s| s.path.as_str()).collect();
    assert_none(&wrong_twins(&paths));
    let mut spoiled = paths.clone();
    spoiled.remove("shaders/twin/src/cast.rs");
    assert_eq!(wrong_twins(&spoiled), ["cast.wgsl has no twin"]);
    let mut spoiled = paths;
    spoiled.remove("shaders/wgsl/sample/hardware.wgsl");
    assert_eq!(wrong_twins(&spoiled), ["sample/hardware is an exception for nothing"]);
}
