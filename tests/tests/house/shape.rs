//! What the top level holds, and what its files say of themselves.

use crate::assert_none;
use crate::crates::CRATES;
use crate::sources::{FOLDERS, Source, read, root, source, sources, walk};
use std::collections::BTreeSet;

/// The only top-level files; hidden entries and what .gitignore names are free.
const FILES: [&str; 11] = [
    "Cargo.toml",
    "Cargo.lock",
    "README.md",
    "LICENSE-MIT",
    "LICENSE-APACHE",
    "deny.toml",
    "rustfmt.toml",
    "clippy.toml",
    "CHANGELOG.md",
    "CONTRIBUTING.md",
    "rust-toolchain.toml",
];

const MOST_LINES: usize = 400;

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
    let file = |target: &str| target.split('#').next().is_some_and(&is_there);
    own.filter(|target| !file(target)).map(|target| format!("nothing is at {target}")).collect()
}

/// Lines of a script that do something.
fn deeds(script: &str) -> Vec<&str> {
    script.lines().map(str::trim).filter(|line| !line.is_empty() && !line.starts_with('#')).collect()
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

/// Blocks of code show what is somewhere else.
fn without_code(page: &str) -> String {
    page.split("```").step_by(2).collect()
}

#[test]
fn links_of_every_page_lead_somewhere() {
    let mut paths = vec!["CHANGELOG.md".to_owned(), "CONTRIBUTING.md".to_owned()];
    FOLDERS.iter().for_each(|folder| walk(folder, &mut paths));
    paths.retain(|path| path.ends_with(".md"));
    assert!(paths.len() > 20, "{paths:?}");
    for path in paths {
        let folder = root().join(&path).parent().expect("a page lies in a folder").to_owned();
        let dead = dead_links(&without_code(&read(&path)), |target| folder.join(target).exists());
        assert!(dead.is_empty(), "{path}: {dead:?}");
    }
    assert_eq!(dead_links(&without_code("[a](no.md#part) ```[b](no.md)``` [c](no.md)"), |_| false).len(), 2);
}

#[test]
fn the_checks_of_a_change_are_the_page_s_second_command() {
    let whole = ["cd \"$(dirname \"$0\")/..\" && exec ./tests/run"];
    assert_eq!(deeds(&read(".ci/run")), whole);
    let spoiled = format!("{}\ncargo update\n", read(".ci/run"));
    assert_ne!(deeds(&spoiled), whole);
}
