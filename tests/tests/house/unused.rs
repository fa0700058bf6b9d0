//! What a crate offers, some product uses: what tests alone call is theirs.

use crate::assert_none;
use crate::code;
use crate::crates::CRATES;
use crate::modules::product_files;
use crate::sources::{Source, source, sources};
use std::collections::BTreeSet;

/// Words before the name of something that a crate offers.
const KINDS: [&str; 7] = ["fn", "const", "static", "struct", "enum", "trait", "type"];

/// Names that no product uses yet, or ever, with the reason; the list can only shrink.
const KNOWN: [(&str, &str); 3] = [
    ("FinishTruth", "the codes of projectors in f64, which the renderer's are compared with"),
    ("plainly", "row planes without wide instructions, which tests compare with those that have them"),
    ("segmented", "the paper's own, step-dependent compositing: the reference offers it to be compared with"),
];

/// The files of the crates themselves, programs included, but for those that only tests have.
fn products<'a>(sources: &'a [Source], folders: &[&str]) -> Vec<&'a Source> {
    let libraries = folders.iter().flat_map(|folder| product_files(sources, folder)).map(|(_, file)| file);
    let is_program = |s: &&Source| folders.iter().any(|folder| s.path == format!("{folder}/src/main.rs"));
    libraries.chain(sources.iter().filter(is_program)).collect()
}

/// The names that some code offers to other crates.
fn offered(code: &str) -> BTreeSet<&str> {
    let mut words = code::words(code).peekable();
    let mut offered = BTreeSet::new();
    while let Some(word) = words.next() {
        if word != "pub" || words.peek().is_some_and(|word| ["super", "crate", "in"].contains(word)) {
            continue;
        }
        let is_before_kind = |word: &&str| ["const", "unsafe", "async"].contains(word);
        let mut kind = words.next();
        while kind.as_ref().is_some_and(is_before_kind)
            && words.peek().is_some_and(|word| KINDS.contains(word))
        {
            kind = words.next();
        }
        if kind.is_some_and(|kind| KINDS.contains(&kind)) {
            offered.extend(words.next());
        }
    }
    offered
}

/// The names that some code mentions, other than where they are defined, passed on, or given methods.
fn mentioned(code: &str) -> BTreeSet<String> {
    let (imports, _, code) = code::imports(code);
    let mut mentioned: BTreeSet<String> = imports.into_iter().flat_map(|import| import.path).collect();
    for statement in code.split_inclusive([';', '{', '}']) {
        let (words, own) = (code::words(statement).collect::<Vec<_>>(), implementing(statement));
        let is_mention = |&(at, word): &(usize, &&str)| {
            let is_defined = at > 0 && KINDS.contains(&words[at - 1]);
            !is_defined && own != Some(*word)
        };
        mentioned.extend(words.iter().enumerate().filter(is_mention).map(|(_, word)| (*word).to_owned()));
    }
    mentioned
}

/// The type that a heading begins to give methods to.
fn implementing(heading: &str) -> Option<&str> {
    let heading = heading.trim_start().strip_prefix("impl")?;
    let of = heading.split_once(" for ").map_or(heading, |(_, of)| of);
    let generics = if of.starts_with('<') { of.find("> ")? + 1 } else { 0 };
    code::words(&of[generics..]).next()
}

/// Names that crates offer and no product mentions, each with its file.
fn unused(sources: &[Source], folders: &[&str]) -> Vec<(String, String)> {
    let code_of = |s: &&Source| (s.path.clone(), code::with_strings(&s.text));
    let files: Vec<(String, String)> = products(sources, folders).iter().map(code_of).collect();
    let mentioned: BTreeSet<String> = files.iter().flat_map(|(_, code)| mentioned(code)).collect();
    let of = |(path, code): &(String, String)| {
        let unused = offered(code).into_iter().filter(|name| !mentioned.contains(*name));
        unused.map(|name| (path.clone(), name.to_owned())).collect::<Vec<_>>()
    };
    files.iter().flat_map(of).collect()
}

/// Unused names that are not known, and exceptions for nothing.
fn wrong_names(unused: &[(String, String)], known: &[(&str, &str)]) -> Vec<String> {
    let new = unused.iter().filter(|(_, name)| !known.iter().any(|(known, _)| known == name));
    let stale = known.iter().filter(|(known, _)| !unused.iter().any(|(_, name)| name == known));
    new.map(|(path, name)| format!("{path}: no product uses {name}"))
        .chain(stale.map(|(name, _)| format!("{name} is an exception for nothing")))
        .collect()
}

#[test]
fn what_crates_offer_is_used() {
    let folders: Vec<&str> = CRATES.iter().map(|&(_, folder, _)| folder).collect();
    assert_none(&wrong_names(&unused(&sources(), &folders), &KNOWN));
}

#[test]
fn what_nothing_uses_is_found() {
    let offering = "pub struct Used;\nimpl Used { pub const fn idle(self) -> u8 { 1 } pub(crate) fn own() {} }\n\
                    pub const IDLE: u8 = 1;\npub use x::y;\n#[cfg(test)]\nmod tests { fn t() { idle(IDLE) } }\n";
    let house = |using: &str| {
        let files =
            [("a/src/lib.rs", offering), ("b/src/lib.rs", using), ("b/src/a_tests.rs", "a::idle(IDLE)")];
        files.map(|(path, text)| source(path, text))
    };
    let found = |using: &str| -> Vec<String> {
        unused(&house(using), &["a", "b"]).into_iter().map(|(_, name)| name).collect()
    };
    assert_eq!(found("use a::Used; // idle(IDLE)"), ["IDLE", "idle"]);
    assert_eq!(found("use a::{Used, IDLE};"), ["idle"]);
    assert_eq!(found("pub use a::IDLE;\nfn f(u: a::Used) { u.idle() }"), ["IDLE"]);
    assert_none(&found("fn f(u: a::Used) { println!(\"{} {IDLE}\", u.idle()) }"));
    assert_eq!(found(""), ["IDLE", "Used", "idle"], "also a struct that is only defined and given methods");
}

#[test]
fn known_names_are_unused() {
    let unused = [("a/src/lib.rs".to_owned(), "idle".to_owned())];
    assert_eq!(wrong_names(&unused, &[]), ["a/src/lib.rs: no product uses idle"]);
    assert_none(&wrong_names(&unused, &[("idle", "the reason")]));
    assert_eq!(wrong_names(&[], &[("idle", "the reason")]), ["idle is an exception for nothing"]);
}
