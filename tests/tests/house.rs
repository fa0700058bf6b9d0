//! The rules of the house, read from the files themselves; each rule also has to find the fault in a spoiled house.

use serde_json::Value;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::process::Command;

/// The crates, lowest first, each with the crates of the house that it may depend on. The tests may use all, and nothing
/// uses the tests.
const CRATES: [(&str, &str, &[&str]); 12] = [
    ("display-config", "display-config", &[]),
    ("layout", "shaders/layout", &[]),
    ("optics", "shaders/optics", &[]),
    ("shaders", "shaders", &["display-config", "layout", "optics"]),
    ("bricks", "backend/bricks", &["display-config", "layout", "optics"]),
    ("volumes", "backend/volumes", &["bricks"]),
    ("protocol", "backend/protocol", &["display-config", "optics"]),
    ("reference", "backend/reference", &["bricks", "optics", "protocol"]),
    // Its own tests compare it with the reference.
    (
        "renderer",
        "backend/renderer",
        &["bricks", "display-config", "layout", "optics", "protocol", "reference", "shaders"],
    ),
    ("transport", "backend/transport", &["display-config", "optics", "protocol"]),
    ("backend", "backend", &["bricks", "display-config", "optics", "protocol", "renderer", "transport"]),
    (
        "frontend",
        "frontend",
        &[
            "backend",
            "bricks",
            "display-config",
            "optics",
            "protocol",
            "reference",
            "renderer",
            "shaders",
            "transport",
            "volumes",
        ],
    ),
];
const TESTS: &str = "lightloom-tests";
/// The only top-level folders.
const FOLDERS: [&str; 5] = ["display-config", "shaders", "backend", "frontend", "tests"];
/// The only top-level files; hidden entries and what .gitignore names are free.
const FILES: [&str; 8] = [
    "Cargo.toml",
    "Cargo.lock",
    "README.md",
    "LICENSE-MIT",
    "LICENSE-APACHE",
    "deny.toml",
    "rustfmt.toml",
    "clippy.toml",
];
/// Crates that one crate alone may depend on.
const PRIVATE: [(&str, &str); 3] = [("wgpu", "renderer"), ("mpi", "transport"), ("bincode", "protocol")];
/// The only places where the paths of a crate may begin: a folder ends in a slash.
const CONFINED: [(&str, &[&str]); 3] = [
    ("mpi", &["backend/transport/src/mpi.rs"]),
    ("wgpu", &["backend/renderer/src/device/gpu/"]),
    // The second holds the tests of the first.
    ("bincode", &["backend/protocol/src/wire.rs", "backend/protocol/src/wire_tests.rs"]),
];
/// WGSL modules whose twin has another stem, or none, with the reason.
const ODD_TWINS: [(&str, Option<&str>, &str); 16] = [
    ("debug/none", Some("shaders/src/twin/debug/mod.rs"), "a branch in the twin"),
    ("enhance/importance", Some("shaders/src/twin/enhance/band_picker.rs"), "one reads it, one writes it"),
    ("enhance/no_importance", Some("shaders/src/twin/enhance/chain.rs"), "a branch in the twin"),
    ("enhance/none", Some("shaders/src/twin/enhance/chain.rs"), "a chain without links"),
    ("gradient/blended", Some("shaders/src/twin/gradient/detail.rs"), "a branch in the twin"),
    ("gradient/none", Some("shaders/src/twin/gradient/detail.rs"), "a constant in the twin"),
    ("gradient/own", Some("shaders/src/twin/gradient/detail.rs"), "a branch in the twin"),
    ("gradient/toward_parent", Some("shaders/src/twin/gradient/detail.rs"), "a branch in the twin"),
    ("layout", Some("shaders/layout/src/lib.rs"), "the host's structs are used beyond the twin"),
    ("levels/no_weights", Some("shaders/src/twin/levels/weights.rs"), "a constant in the twin"),
    ("levels/one", Some("shaders/src/twin/levels/three.rs"), "the twin of three without its ancestors"),
    ("levels/two", Some("shaders/src/twin/levels/three.rs"), "the twin of three without its grandparent"),
    ("material/one", Some("shaders/src/twin/material.rs"), "a branch in the twin"),
    ("material/table", Some("shaders/src/twin/material.rs"), "a branch in the twin"),
    (
        "sample/exact",
        Some("shaders/src/twin/sample.rs"),
        "the twin has one way to sample: there is no choice to name",
    ),
    ("sample/hardware", None, "the texture unit does it; its precision is measured instead"),
];
const MOST_LINES: usize = 400;

/// A text file of the repository.
struct Source {
    path: String,
    text: String,
}

/// A dependency between a crate of the workspace and any other.
type Arrow = (String, String);

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..").canonicalize().expect("the workspace is there")
}

fn read(path: &str) -> String {
    std::fs::read_to_string(root().join(path)).unwrap_or_else(|error| panic!("{path}: {error}"))
}

/// The paths below a folder of the repository, from its root, with slashes.
fn walk(folder: &str, paths: &mut Vec<String>) {
    for entry in std::fs::read_dir(root().join(folder)).expect("a listed folder can be read") {
        let entry = entry.expect("a listed entry can be read");
        let path = format!("{folder}/{}", entry.file_name().to_string_lossy());
        if entry.file_type().expect("a listed entry has a type").is_dir() {
            walk(&path, paths);
        } else {
            paths.push(path);
        }
    }
}

/// Every Rust and WGSL file of the house; what lies among the data of the tests is data.
fn sources() -> Vec<Source> {
    let mut paths = Vec::new();
    FOLDERS.iter().for_each(|folder| walk(folder, &mut paths));
    paths.retain(|path| path.ends_with(".rs") || path.ends_with(".wgsl"));
    paths.retain(|path| !path.starts_with("tests/data/"));
    assert!(paths.len() > 100, "only {} sources found", paths.len());
    paths.into_iter().map(|path| Source { text: read(&path), path }).collect()
}

fn source(path: &str, text: &str) -> Source {
    Source { path: path.to_owned(), text: text.to_owned() }
}

/// What the crates of the workspace depend on, by any kind of dependency.
fn arrows() -> Vec<Arrow> {
    let output = Command::new(env!("CARGO"))
        .args(["metadata", "--format-version", "1", "--no-deps", "--offline"])
        .current_dir(root())
        .output()
        .expect("the cargo that built this test runs");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let metadata: Value = serde_json::from_slice(&output.stdout).expect("cargo metadata prints JSON");
    let name = |value: &Value| value["name"].as_str().expect("packages have names").to_owned();
    let list = |value: &Value| value.as_array().cloned().expect("cargo metadata has lists here");
    let of = |package: &Value| {
        let from = name(package);
        list(&package["dependencies"]).iter().map(|to| (from.clone(), name(to))).collect::<Vec<_>>()
    };
    list(&metadata["packages"]).iter().flat_map(of).collect()
}

fn arrow(from: &str, to: &str) -> Arrow {
    (from.to_owned(), to.to_owned())
}

fn may_use(name: &str) -> Option<&'static [&'static str]> {
    CRATES.iter().find(|(known, ..)| *known == name).map(|&(_, _, uses)| uses)
}

/// Dependencies that the table does not allow, crates that it does not know, and private crates elsewhere.
fn wrong_arrows(arrows: &[Arrow]) -> Vec<String> {
    let is_of_house = |name: &str| name == TESTS || may_use(name).is_some();
    let is_private = |from: &str, to: &str| PRIVATE.iter().any(|&(name, owner)| to == name && from != owner);
    let is_wrong = |(from, to): &&Arrow| match may_use(from) {
        _ if is_private(from, to) => true,
        None => from != TESTS || to == TESTS,
        Some(uses) => is_of_house(to) && !uses.contains(&to.as_str()),
    };
    arrows.iter().filter(is_wrong).map(|(from, to)| format!("{from} must not depend on {to}")).collect()
}

/// Whether each crate of the table uses crates before it only.
fn points_down() -> bool {
    let place = |name: &str| CRATES.iter().position(|(known, ..)| *known == name);
    CRATES.iter().all(|(from, _, uses)| uses.iter().all(|to| place(to) < place(from)))
}

/// Top-level entries that are not allowed, and allowed ones that are missing.
fn wrong_entries(entries: &BTreeSet<String>, ignored: &str) -> Vec<String> {
    let is_ignored = |name: &str| ignored.lines().any(|line| line.trim_matches('/') == name);
    let is_allowed = |name: &str| name.starts_with('.') || FOLDERS.contains(&name) || FILES.contains(&name);
    let extra = entries.iter().filter(|name| !is_allowed(name) && !is_ignored(name));
    let missing = FOLDERS.iter().chain(&FILES).filter(|&&name| !entries.contains(name));
    extra
        .map(|name| format!("{name} is extra"))
        .chain(missing.map(|name| format!("{name} is missing")))
        .collect()
}

/// Whether a line of code has a path that begins at a crate, not at a module that happens to have the same name.
fn names_crate(line: &str, name: &str) -> bool {
    let code = line.split("//").next().unwrap_or_default();
    let is_path = |(at, _): (usize, &str)| {
        let before = code[..at].strip_suffix("::").unwrap_or(&code[..at]);
        let continues = before.ends_with(|c: char| c.is_alphanumeric() || c == '_');
        let after = &code[at + name.len()..];
        let is_whole = after.starts_with("::")
            || (code.trim_start().starts_with("use ") && after.starts_with([';', ' ', ',', '}']));
        !continues && is_whole
    };
    code.match_indices(name).any(is_path)
}

/// Lines that name a confined crate outside its places.
fn wrong_places(sources: &[Source]) -> Vec<String> {
    let mut wrong = Vec::new();
    for (name, places) in CONFINED {
        let is_home =
            |path: &str| places.iter().any(|p| path == *p || p.ends_with('/') && path.starts_with(p));
        for source in sources.iter().filter(|s| s.path.ends_with(".rs") && !is_home(&s.path)) {
            let lines = source.text.lines().enumerate().filter(|(_, line)| names_crate(line, name));
            wrong.extend(
                lines.map(|(at, _)| format!("{}:{}: {name} belongs in {places:?}", source.path, at + 1)),
            );
        }
    }
    wrong
}

/// WGSL modules without a twin, and exceptions that no longer hold.
fn wrong_twins(paths: &BTreeSet<&str>) -> Vec<String> {
    let odd = |stem: &str| ODD_TWINS.iter().find(|(name, ..)| *name == stem);
    let stem = |path: &str| path.strip_prefix("shaders/wgsl/")?.strip_suffix(".wgsl").map(str::to_owned);
    let stems: BTreeSet<String> = paths.iter().filter_map(|path| stem(path)).collect();
    let twin = |stem: &str| match odd(stem) {
        Some((_, twin, _)) => twin.map(str::to_owned),
        None => Some(format!("shaders/src/twin/{stem}.rs")),
    };
    let has_twin = |stem: &&String| twin(stem).is_none_or(|twin| paths.contains(twin.as_str()));
    let alone = stems.iter().filter(|stem| !has_twin(stem)).map(|stem| format!("{stem}.wgsl has no twin"));
    let stale = ODD_TWINS.iter().filter(|(name, ..)| !stems.contains(*name));
    alone.chain(stale.map(|(name, ..)| format!("{name} is an exception for nothing"))).collect()
}

/// Files that do not say what they are, or are too long.
fn wrong_files(sources: &[Source]) -> Vec<String> {
    let opening = |s: &Source| if s.path.ends_with(".rs") { "//! " } else { "// " };
    let silent = sources.iter().filter(|s| !s.text.starts_with(opening(s)));
    let long = sources.iter().filter(|s| s.text.lines().count() > MOST_LINES);
    let silent = silent.map(|s| format!("{} does not open with what it is", s.path));
    silent.chain(long.map(|s| format!("{} has more than {MOST_LINES} lines", s.path))).collect()
}

/// Manifests that do not take the workspace's lints, licence and edition.
fn wrong_manifests(manifests: &[Source]) -> Vec<String> {
    let needed = ["[lints]\nworkspace = true", "license.workspace = true", "edition.workspace = true"];
    let lacks =
        |s: &Source, line: &str| (!s.text.contains(line)).then(|| format!("{} lacks {line:?}", s.path));
    manifests.iter().flat_map(|s| needed.iter().filter_map(|line| lacks(s, line))).collect()
}

/// Targets of links and pictures in a page that are neither addresses, places in the page, nor files.
fn dead_links(page: &str, is_there: impl Fn(&str) -> bool) -> Vec<String> {
    let targets = page.split("](").skip(1).filter_map(|rest| rest.split(')').next());
    let own = targets.filter(|target| !target.contains("://") && !target.starts_with('#'));
    own.filter(|target| !is_there(target)).map(|target| format!("nothing is at {target}")).collect()
}

/// Lines of a script that do something.
fn deeds(script: &str) -> Vec<&str> {
    script.lines().map(str::trim).filter(|line| !line.is_empty() && !line.starts_with('#')).collect()
}

fn assert_none(wrong: &[String]) {
    assert!(wrong.is_empty(), "\n{}", wrong.join("\n"));
}

#[test]
fn dependencies_point_down() {
    assert!(points_down());
    let arrows = arrows();
    assert!(arrows.contains(&arrow("frontend", "backend")), "{arrows:?}");
    assert_none(&wrong_arrows(&arrows));
    for (from, to) in [
        ("display-config", "shaders"),
        ("optics", "shaders"),
        ("reference", "shaders"),
        ("reference", "layout"),
        ("volumes", "renderer"),
        ("bricks", "shaders"),
        ("transport", "renderer"),
        ("backend", "frontend"),
        ("backend", TESTS),
        ("frontend", "wgpu"),
        (TESTS, "wgpu"),
        ("shaders", "mpi"),
        ("frontend", "bincode"),
        ("console", "serde"),
    ] {
        assert_eq!(wrong_arrows(&[arrow(from, to)]).len(), 1, "{from} -> {to} passed");
    }
}

#[test]
fn the_top_level_is_the_design_s() {
    let listed = std::fs::read_dir(root()).expect("the root can be read");
    let entries = listed.map(|e| e.expect("an entry").file_name().to_string_lossy().into_owned());
    let entries: BTreeSet<String> = entries.collect();
    let ignored = read(".gitignore");
    assert_none(&wrong_entries(&entries, &ignored));
    let mut spoiled = entries.clone();
    spoiled.insert("utils".into());
    assert_eq!(wrong_entries(&spoiled, &ignored), ["utils is extra"]);
    spoiled.remove("utils");
    spoiled.remove("shaders");
    assert_eq!(wrong_entries(&spoiled, &ignored), ["shaders is missing"]);
}

#[test]
fn outside_crates_stay_in_their_places() {
    assert_none(&wrong_places(&sources()));
    for (name, places) in CONFINED {
        for (line, faults) in [
            ("use NAME::Thing;", 1),
            ("use ::NAME::Thing;", 1),
            ("    let thing = NAME::inner::thing(7);", 1),
            ("use NAME;", 1),
            ("use NAME as other;", 1),
            ("use super::NAME::Thing; // not NAME::Thing", 0),
            ("mod NAME;", 0),
            ("use other_NAME::Thing;", 0),
        ] {
            let line = line.replace("NAME", name);
            assert_eq!(wrong_places(&[source("backend/src/render.rs", &line)]).len(), faults, "{line}");
            assert_none(&wrong_places(&[source(places[0], &line)]));
        }
    }
}

#[test]
fn twins_share_a_stem() {
    let sources = sources();
    let paths: BTreeSet<&str> = sources.iter().map(|s| s.path.as_str()).collect();
    assert_none(&wrong_twins(&paths));
    let mut spoiled = paths.clone();
    spoiled.remove("shaders/src/twin/cast.rs");
    assert_eq!(wrong_twins(&spoiled), ["cast.wgsl has no twin"]);
    let mut spoiled = paths;
    spoiled.remove("shaders/wgsl/sample/hardware.wgsl");
    assert_eq!(wrong_twins(&spoiled), ["sample/hardware is an exception for nothing"]);
}

#[test]
fn files_say_what_they_are_and_stay_short() {
    assert_none(&wrong_files(&sources()));
    assert_eq!(wrong_files(&[source("a.rs", "use std::io;\n")]).len(), 1);
    assert_eq!(wrong_files(&[source("a.wgsl", "fn f() {}\n")]).len(), 1);
    let long = format!("//! A noun.\n{}", "\n".repeat(MOST_LINES));
    assert_eq!(wrong_files(&[source("a.rs", &long)]).len(), 1);
}

#[test]
fn manifests_take_the_workspace_s_rules() {
    let folders = CRATES.iter().map(|&(_, folder, _)| folder).chain(["tests"]);
    let manifests: Vec<Source> = folders
        .map(|folder| format!("{folder}/Cargo.toml"))
        .map(|path| source(&path, &read(&path)))
        .collect();
    assert_none(&wrong_manifests(&manifests));
    let spoiled = [source("a/Cargo.toml", &manifests[0].text.replace("[lints]", "[other]"))];
    assert_eq!(wrong_manifests(&spoiled).len(), 1);
}

#[test]
fn the_page_shows_what_is_there() {
    let page = read("README.md");
    assert_none(&dead_links(&page, |path| root().join(path).exists()));
    assert_eq!(dead_links("![a](no/picture.png) [b](https://example.org) [c](#d)", |_| false).len(), 1);
    assert!(page.contains("\n./tests/run\n"), "the page has lost its second command");
    for folder in FOLDERS {
        assert!(page.contains(&format!("| [`{folder}`]({folder}) |")), "the map lacks {folder}");
    }
}

#[test]
fn the_checks_of_a_change_are_the_page_s_second_command() {
    let whole = ["cd \"$(dirname \"$0\")/..\" && exec ./tests/run"];
    assert_eq!(deeds(&read(".ci/run")), whole);
    let spoiled = format!("{}\ncargo update\n", read(".ci/run"));
    assert_ne!(deeds(&spoiled), whole);
}
