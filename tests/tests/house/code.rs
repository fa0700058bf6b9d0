//! Rust source as the rules read it: without comments and tests, cut into the paths that it names.

use std::collections::BTreeSet;

/// What begins an item that only tests have.
const TEST_ONLY: &str = "#[cfg(test)]";
/// Words after which a name is defined.
const DEFINING: [&str; 9] =
    ["fn", "struct", "enum", "trait", "const", "static", "type", "macro_rules", "mod"];

/// An imported name.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Import {
    /// The path as it is written; a star stands for all names.
    pub path: Vec<String>,
    /// The name that it has here.
    pub name: String,
}

/// The code of a file that is no test's, with strings as they are.
pub fn with_strings(text: &str) -> String {
    without_tests(&bare(text, true))
}

/// The same, with strings empty.
pub fn without_strings(text: &str) -> String {
    without_tests(&bare(text, false))
}

fn bare(text: &str, keeps_strings: bool) -> String {
    let (mut code, mut rest) = (String::with_capacity(text.len()), text);
    while let Some(first) = rest.chars().next() {
        let (bytes, kept) = match special(rest) {
            Some((bytes, _)) if keeps_strings && !rest.starts_with('/') => (bytes, &rest[..bytes]),
            Some((bytes, stand_in)) => (bytes, stand_in),
            None => (first.len_utf8(), &rest[..first.len_utf8()]),
        };
        code.push_str(kept);
        rest = &rest[bytes..];
    }
    code
}

/// The length of the comment or literal that a text begins with, and what stands for it.
fn special(text: &str) -> Option<(usize, &'static str)> {
    let until =
        |from: usize, end: &str| text[from..].find(end).map_or(text.len(), |at| from + at + end.len());
    if text.starts_with("//") {
        return Some((text.find('\n').unwrap_or(text.len()), ""));
    }
    if text.starts_with("/*") {
        return Some((until(2, "*/"), ""));
    }
    if text.starts_with('"') {
        return Some((string_length(text), "\"\""));
    }
    if let Some(raw) = text.strip_prefix('r') {
        let hashes = raw.bytes().take_while(|&byte| byte == b'#').count();
        let is_raw = raw[hashes..].starts_with('"');
        return is_raw.then(|| (until(hashes + 2, &format!("\"{}", "#".repeat(hashes))), "\"\""));
    }
    let character = text.strip_prefix('\'')?;
    let end = match character.strip_prefix('\\') {
        Some(escaped) => 3 + escaped.get(1..)?.find('\'')?,
        None => 1 + character.chars().next()?.len_utf8(),
    };
    text[end..].starts_with('\'').then_some((end + 1, "' '"))
}

/// The length of the string that a text begins with.
fn string_length(text: &str) -> usize {
    let mut is_escaped = false;
    for (at, letter) in text.char_indices().skip(1) {
        match letter {
            '"' if !is_escaped => return at + 1,
            _ => is_escaped = letter == '\\' && !is_escaped,
        }
    }
    text.len()
}

/// Items after [`TEST_ONLY`] are left out: up to their semicolon or the end of their braces.
fn without_tests(code: &str) -> String {
    let (mut kept, mut rest) = (String::new(), code);
    while let Some(at) = rest.find(TEST_ONLY) {
        kept.push_str(&rest[..at]);
        let item = &rest[at + TEST_ONLY.len()..];
        rest = &item[item_length(item)..];
    }
    kept + rest
}

fn item_length(item: &str) -> usize {
    let mut depth = 0;
    for (at, byte) in item.bytes().enumerate() {
        match byte {
            b'{' | b'(' | b'[' => depth += 1,
            b'}' | b')' | b']' => depth -= 1,
            _ => {}
        }
        if depth == 0 && (byte == b'}' || byte == b';') {
            return at + 1;
        }
    }
    item.len()
}

/// The imports of some code, and the code without them. Of `pub use` the second list tells.
pub fn imports(code: &str) -> (Vec<Import>, Vec<Import>, String) {
    let (mut private, mut public, mut others, mut rest) = (Vec::new(), Vec::new(), String::new(), code);
    while let Some((before, tree, after)) = next_import(rest) {
        let is_public =
            before.trim_end().rsplit(char::is_whitespace).next().is_some_and(|w| w.starts_with("pub"));
        expand(&[], tree, if is_public { &mut public } else { &mut private });
        others.push_str(before);
        rest = after;
    }
    (private, public, others + rest)
}

/// What stands before, in and after the first import.
fn next_import(code: &str) -> Option<(&str, &str, &str)> {
    let is_import = |&(at, _): &(usize, &str)| !code[..at].ends_with(is_of_name);
    let (at, word) = code.match_indices("use ").find(is_import)?;
    let (tree, after) = code[at + word.len()..].split_once(';')?;
    Some((&code[..at], tree, after))
}

fn expand(prefix: &[String], tree: &str, imports: &mut Vec<Import>) {
    let tree = tree.trim();
    let segments = |path: &str| {
        let all = path.split("::").map(str::trim).filter(|segment| !segment.is_empty());
        prefix.iter().cloned().chain(all.map(str::to_owned)).collect::<Vec<_>>()
    };
    if let Some((path, list)) = tree.split_once('{') {
        let prefix = segments(path);
        let list = list.trim_end().strip_suffix('}').unwrap_or(list);
        return split_outside_braces(list).iter().for_each(|part| expand(&prefix, part, imports));
    }
    let (path, alias) =
        tree.split_once(" as ").map_or((tree, None), |(path, alias)| (path, Some(alias.trim())));
    let mut path = segments(path);
    if path.len() > 1 && path.last().is_some_and(|last| last == "self") {
        path.pop();
    }
    if let Some(last) = path.last().cloned() {
        imports.push(Import { path, name: alias.map_or(last, str::to_owned) });
    }
}

fn split_outside_braces(list: &str) -> Vec<&str> {
    let (mut parts, mut depth, mut from) = (Vec::new(), 0, 0);
    for (at, byte) in list.bytes().enumerate() {
        match byte {
            b'{' => depth += 1,
            b'}' => depth -= 1,
            b',' if depth == 0 => {
                parts.push(&list[from..at]);
                from = at + 1;
            }
            _ => {}
        }
    }
    parts.push(&list[from..]);
    parts.retain(|part| !part.trim().is_empty());
    parts
}

fn is_of_name(letter: char) -> bool {
    letter.is_alphanumeric() || letter == '_'
}

/// All names and other words of some code, in order.
pub fn words(code: &str) -> impl Iterator<Item = &str> {
    code.split(|letter| !is_of_name(letter)).filter(|word| !word.is_empty())
}

/// The names that some code defines.
pub fn defined(code: &str) -> BTreeSet<String> {
    let all: Vec<&str> = words(code).collect();
    let is_definition = |pair: &&[&str]| DEFINING.contains(&pair[0]);
    all.windows(2).filter(is_definition).map(|pair| pair[1].to_owned()).collect()
}

/// The modules that some code declares and that lie in other files.
pub fn declared(code: &str) -> Vec<String> {
    let module = |statement: &str| {
        let words: Vec<&str> = words(statement.strip_suffix(';')?).collect();
        let [.., keyword, name] = words[..] else { return None };
        (keyword == "mod").then(|| name.to_owned())
    };
    code.split_inclusive([';', '{', '}']).filter_map(module).collect()
}

/// Paths of two names and more.
pub fn paths(code: &str) -> Vec<Vec<String>> {
    let (mut paths, mut rest, mut before) = (Vec::new(), code, ' ');
    while let Some(first) = rest.chars().next() {
        let name = &rest[..rest.find(|letter| !is_of_name(letter)).unwrap_or(rest.len())];
        if name.is_empty() {
            before = first;
            rest = &rest[first.len_utf8()..];
            continue;
        }
        let mut path = vec![name.to_owned()];
        rest = &rest[name.len()..];
        while let Some(after) = rest.strip_prefix("::") {
            let next = &after[..after.find(|letter| !is_of_name(letter)).unwrap_or(after.len())];
            if next.is_empty() {
                break;
            }
            path.push(next.to_owned());
            rest = &after[next.len()..];
        }
        if path.len() > 1 && !".$:".contains(before) {
            paths.push(path);
        }
        before = ' ';
    }
    paths
}

#[test]
fn code_is_read_without_comments_strings_and_tests() {
    let text = "//! A.\nuse a::B; // c::D\nfn f<'a>() { g(\"x\\\"::y\", r#\"a\"b\"#, '\"', '\\'') }\n\
                #[cfg(test)]\n#[path = \"t.rs\"]\nmod tests;\n#[cfg(test)]\nmod more { fn t() {} }\nfn last() {}\n";
    let code = without_strings(text);
    assert_eq!(code, "\nuse a::B; \nfn f<'a>() { g(\"\", \"\", ' ', ' ') }\n\n\nfn last() {}\n");
    assert!(with_strings(text).contains("x\\\"::y"));
    assert_eq!(defined(&code), ["f", "last"].map(str::to_owned).into());
}

#[test]
fn imports_are_taken_apart() {
    let code = "pub use a::{self, b::{C, D as E}, *};\npub(super) use f::G;\nuse h;\nlet use_it = 1;";
    let (private, public, others) = imports(code);
    let text = |import: &Import| format!("{}={}", import.path.join("::"), import.name);
    assert_eq!(private.iter().map(text).collect::<Vec<_>>(), ["h=h"]);
    let public: Vec<_> = public.iter().map(text).collect();
    assert_eq!(public, ["a=a", "a::b::C=C", "a::b::D=E", "a::*=*", "f::G=G"]);
    assert!(others.ends_with("let use_it = 1;"));
}

#[test]
fn paths_and_modules_are_found() {
    let found: Vec<_> =
        paths("a::b::c(x.d::<e>(), f, ::g::h, i::J {})").iter().map(|p| p.join("::")).collect();
    assert_eq!(found, ["a::b::c", "i::J"]);
    assert_eq!(declared("mod a;\n#[x]\npub(crate) mod b;\nmod c { mod d; }\nfn mode() {}"), ["a", "b", "d"]);
}
