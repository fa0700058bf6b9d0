//! Arrows between modules run one way, within every crate.

use crate::assert_none;
use crate::code::{self, Import};
use crate::crates::CRATES;
use crate::sources::{Source, source, sources};
use std::collections::{BTreeMap, BTreeSet};

/// Crates whose top-level modules have an order: each uses those before it only.
const ORDERS: [(&str, &[&str]); 3] = [
    (
        "backend/bricks",
        &["links", "temporary", "working_file", "working_folder", "volume", "store", "lod", "procedural"],
    ),
    ("backend/renderer", &["output", "present", "cache_size", "working_set", "device", "refine", "render"]),
    (
        "frontend",
        &[
            "same_file",
            "orientation",
            "progress",
            "scene",
            "accuracy",
            "error",
            "interrupt",
            "report",
            "calibrate",
            "simulate",
            "gallery",
            "staging",
            "drive",
            "tune",
            "monitor",
            "adapter",
            "cli",
            "command",
        ],
    ),
];
/// Folders in which modules still go round in circles, with the reason; the list can only shrink.
const CIRCLES: [(&str, &str); 0] = [];

/// A module's names from its crate's root.
pub type Path = Vec<String>;

/// What is known of a module.
#[derive(Default)]
struct Module {
    imports: BTreeMap<String, Path>,
    stars: Vec<Path>,
    defines: BTreeSet<String>,
    /// The paths of its imports, but not of what it passes on, and those in its code.
    named: Vec<Path>,
}

/// The modules of a crate that are in files of their own, tests left out.
struct Modules(BTreeMap<Path, Module>);

/// The files of a crate's library, each with its module, but for those that only tests have.
pub fn product_files<'a>(sources: &'a [Source], folder: &str) -> Vec<(Path, &'a Source)> {
    let (mut files, mut waiting) = (Vec::new(), vec![(Path::new(), format!("{folder}/src"))]);
    while let Some((path, place)) = waiting.pop() {
        let places = [format!("{place}.rs"), format!("{place}/mod.rs"), format!("{place}/lib.rs")];
        let Some(file) = sources.iter().find(|s| places.contains(&s.path)) else { continue };
        let child = |name: &String| ([path.clone(), vec![name.clone()]].concat(), format!("{place}/{name}"));
        waiting.extend(code::declared(&code::without_strings(&file.text)).iter().map(child));
        files.push((path, file));
    }
    files
}

impl Modules {
    fn of(sources: &[Source], folder: &str) -> Self {
        let module = |(path, file): (Path, &Source)| (path, Module::of(&code::without_strings(&file.text)));
        Self(product_files(sources, folder).into_iter().map(module).collect())
    }

    /// The module in which the thing that a path names in `at` is defined; None where that is another crate.
    fn home(&self, at: &Path, path: &[String], hops: u32) -> Option<Path> {
        let (mut place, mut rest) = (at.clone(), path);
        match path.first()?.as_str() {
            "crate" => (place, rest) = (Path::new(), &path[1..]),
            "self" => rest = &path[1..],
            "super" => {
                let ups = path.iter().take_while(|name| *name == "super").count();
                place.truncate(place.len().checked_sub(ups)?);
                rest = &path[ups..];
            }
            _ => {}
        }
        while let Some((name, after)) = rest.split_first() {
            let inner = [place.clone(), vec![name.clone()]].concat();
            if self.0.contains_key(&inner) {
                (place, rest) = (inner, after);
                continue;
            }
            let module = self.0.get(&place)?;
            if name == "*" || module.defines.contains(name) {
                return Some(place);
            }
            let hops = hops.checked_sub(1)?;
            if let Some(import) = module.imports.get(name).filter(|import| *import != rest) {
                return self.home(&place, &[import, after].concat(), hops);
            }
            return module.stars.iter().find_map(|star| self.home(&place, &[star, rest].concat(), hops));
        }
        // A module by itself: what is taken from it is named elsewhere.
        None
    }

    /// From each module to those that define what it names.
    fn arrows(&self) -> BTreeSet<(Path, Path)> {
        let of = |(at, module): (&Path, &Module)| {
            let homes = module.named.iter().filter_map(|path| self.home(at, path, 8));
            homes.filter(|home| home != at).map(|home| (at.clone(), home)).collect::<Vec<_>>()
        };
        self.0.iter().flat_map(of).collect()
    }

    /// All folders that hold modules.
    fn folders(&self) -> BTreeSet<Path> {
        self.0.keys().flat_map(|path| (0..path.len()).map(|depth| path[..depth].to_vec())).collect()
    }
}

impl Module {
    fn of(code: &str) -> Self {
        let (private, public, others) = code::imports(code);
        let (stars, imports): (Vec<_>, Vec<_>) =
            private.iter().chain(&public).cloned().partition(|import| import.name == "*");
        let without_star = |import: Import| import.path[..import.path.len() - 1].to_vec();
        Self {
            imports: imports.into_iter().map(|import| (import.name, import.path)).collect(),
            stars: stars.into_iter().map(without_star).collect(),
            defines: code::defined(&others),
            named: private.into_iter().map(|import| import.path).chain(code::paths(&others)).collect(),
        }
    }
}

/// Arrows between the files and folders of one folder; its own `mod.rs` is called so.
fn arrows_within(folder: &Path, arrows: &BTreeSet<(Path, Path)>) -> BTreeMap<String, BTreeSet<String>> {
    let mut within: BTreeMap<String, BTreeSet<String>> = BTreeMap::new();
    let name = |path: &Path| path.get(folder.len()).map_or("mod.rs", String::as_str).to_owned();
    for (from, to) in arrows.iter().filter(|(a, b)| a.starts_with(folder) && b.starts_with(folder)) {
        if name(from) != name(to) {
            within.entry(name(from)).or_default().insert(name(to));
        }
    }
    within
}

/// All that can be reached from a place.
fn reached<'a>(from: &'a str, arrows: &'a BTreeMap<String, BTreeSet<String>>) -> BTreeSet<&'a str> {
    let (mut reached, mut waiting) = (BTreeSet::new(), vec![from]);
    while let Some(place) = waiting.pop() {
        let next = arrows.get(place).into_iter().flatten().map(String::as_str);
        waiting.extend(next.filter(|place| reached.insert(*place)));
    }
    reached
}

/// The places of one folder that go round in circles.
fn circle(arrows: &BTreeMap<String, BTreeSet<String>>) -> Vec<&str> {
    let is_in_circle = |place: &&str| reached(place, arrows).contains(place);
    arrows.keys().map(String::as_str).filter(is_in_circle).collect()
}

/// Folders of the crates in which modules go round in circles, and who takes part.
fn circles(sources: &[Source], crates: &[&str]) -> BTreeMap<String, String> {
    let mut found = BTreeMap::new();
    for folder in crates {
        let modules = Modules::of(sources, folder);
        let arrows = modules.arrows();
        for within in modules.folders() {
            let place = [vec![format!("{folder}/src")], within.clone()].concat().join("/");
            let arrows = arrows_within(&within, &arrows);
            let circle = circle(&arrows);
            if !circle.is_empty() {
                found.insert(place, circle.join(", "));
            }
        }
    }
    found
}

/// Circles that nobody knows of, and exceptions for nothing.
fn wrong_circles(found: &BTreeMap<String, String>, known: &[(&str, &str)]) -> Vec<String> {
    let is_known = |place: &str| known.iter().any(|(known, _)| *known == place);
    let new = found.iter().filter(|(place, _)| !is_known(place));
    let stale = known.iter().filter(|(place, _)| !found.contains_key(*place));
    new.map(|(place, circle)| format!("{place} goes round in circles: {circle}"))
        .chain(stale.map(|(place, _)| format!("{place} is an exception for nothing")))
        .collect()
}

/// Arrows between top-level modules against the order of their crate, and modules that the order lacks.
fn wrong_order(sources: &[Source], folder: &str, order: &[&str]) -> Vec<String> {
    let modules = Modules::of(sources, folder);
    let place = |name: &str| order.iter().position(|known| *known == name);
    let tops: BTreeSet<&String> = modules.0.keys().filter_map(|path| path.first()).collect();
    let lacking = tops.into_iter().filter(|top| place(top).is_none());
    let lacking = lacking.map(|top| format!("{folder}: {top} has no place in the order"));
    let mut wrong: Vec<String> = lacking.collect();
    for (from, to) in modules.arrows() {
        let (Some(top), Some(target)) = (from.first(), to.first()) else { continue };
        if place(top) < place(target) {
            wrong.push(format!("{folder}: {} takes from {}", from.join("/"), to.join("/")));
        }
    }
    wrong
}

/// Sources of a crate `house`, each as path and text.
fn house(files: &[(&str, &str)]) -> Vec<Source> {
    files.iter().map(|(path, text)| source(&format!("house/src/{path}"), text)).collect()
}

#[test]
fn modules_do_not_go_round_in_circles() {
    let folders: Vec<&str> = CRATES.iter().map(|&(_, folder, _)| folder).collect();
    let found = circles(&sources(), &folders);
    assert_none(&wrong_circles(&found, &CIRCLES));
}

#[test]
fn a_circle_is_found_however_it_is_written() {
    let b = ("b.rs", "pub struct B;\nfn f(_: crate::a::A) {}");
    let a_with = |text: &'static str| [("lib.rs", "mod a;\nmod b;\n"), ("a.rs", text), b];
    for (text, is_circle) in [
        ("use super::b::B;\npub struct A(B);", true),
        ("use crate::{b::B as C};\npub struct A(C);", true),
        ("use super::b;\npub struct A(b::B);", true),
        ("pub struct A(super::b::B);", true),
        ("use crate::b::*;\npub struct A(B);", true),
        ("pub struct A; // crate::b::B", false),
        ("pub struct A;\n#[cfg(test)]\nmod tests { use crate::b::B; }", false),
        ("use other::b::B;\npub struct A(B);", false),
    ] {
        assert_eq!(!circles(&house(&a_with(text)), &["house"]).is_empty(), is_circle, "{text}");
    }
}

#[test]
fn a_circle_is_found_through_what_a_folder_passes_on() {
    let folder = |parent: &'static str| {
        house(&[
            ("lib.rs", "pub mod a;\npub mod b;\n"),
            ("a/mod.rs", parent),
            ("a/inner.rs", "use crate::b::B;\npub struct A(B);"),
            ("b.rs", "use crate::a::A;\npub struct B;\nfn f(_: A) {}"),
        ])
    };
    let passed_on = circles(&folder("mod inner;\npub use inner::A;\n"), &["house"]);
    assert_eq!(passed_on, [("house/src".to_owned(), "a, b".to_owned())].into());
    let own = circles(&folder("mod inner;\npub struct A(inner::A);\n"), &["house"]);
    assert_eq!(own.len(), 1, "{own:?}");
    let parent = house(&[
        ("lib.rs", "mod a;"),
        ("a/mod.rs", "mod inner;\npub struct A(inner::B);"),
        ("a/inner.rs", "pub struct B;\nfn f(_: super::A) {}"),
    ]);
    assert_eq!(circles(&parent, &["house"]), [("house/src/a".to_owned(), "inner, mod.rs".to_owned())].into());
}

#[test]
fn known_circles_are_there() {
    let found = [("house/src".to_owned(), "a, b".to_owned())].into();
    assert_eq!(wrong_circles(&found, &[]), ["house/src goes round in circles: a, b"]);
    assert_none(&wrong_circles(&found, &[("house/src", "the reason")]));
    let stale = wrong_circles(&BTreeMap::new(), &[("house/src", "the reason")]);
    assert_eq!(stale, ["house/src is an exception for nothing"]);
}

#[test]
fn top_level_modules_use_those_below_them() {
    let sources = sources();
    let wrong = ORDERS.iter().flat_map(|(folder, order)| wrong_order(&sources, folder, order));
    assert_none(&wrong.collect::<Vec<_>>());
    let upward = house(&[
        ("lib.rs", "mod low;\nmod high;\nmod new;"),
        ("low.rs", "use crate::high::High;"),
        ("high.rs", "pub struct High;"),
        ("new.rs", ""),
    ]);
    assert_eq!(
        wrong_order(&upward, "house", &["low", "high"]),
        ["house: new has no place in the order", "house: low takes from high"]
    );
    assert_none(&wrong_order(&upward, "house", &["new", "high", "low"]));
}
