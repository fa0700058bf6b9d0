//! The recipe for an enhancer, followed to the letter in a copy of the sources.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

const RECIPE: &str = include_str!("../docs/add-an-enhancer.md");
/// What the copy is made of.
const MEMBERS: [&str; 6] =
    ["display-config", "shaders/layout", "shaders/optics", "shaders/needs", "shaders/twin", "shaders"];
/// A line of a file of each list that a one-line block belongs to: the line goes before it.
const LISTS: [(&str, &str); 2] = [("mod fog;", "mod l"), ("Fog fog,", "LayerOpacity layer_opacity,")];

fn house() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

fn copy(from: &Path, to: &Path) {
    fs::create_dir_all(to).expect("the folder can be made");
    for entry in fs::read_dir(from).expect("the folder is there") {
        let entry = entry.expect("the entry can be read");
        let (from, to) = (entry.path(), to.join(entry.file_name()));
        if entry.file_type().expect("an entry has a type").is_dir() {
            copy(&from, &to);
        } else {
            fs::copy(from, to).expect("the file can be copied");
        }
    }
}

/// The sources of this crate, of the twin, and of those that the two depend on, as a workspace of their own.
fn copied_house() -> PathBuf {
    let root = Path::new(env!("CARGO_TARGET_TMPDIR")).join("add-an-enhancer");
    if root.exists() {
        fs::remove_dir_all(&root).expect("an earlier copy can be removed");
    }
    for folder in ["display-config", "shaders"] {
        copy(&house().join(folder), &root.join(folder));
    }
    let manifest = fs::read_to_string(house().join("Cargo.toml")).expect("the workspace has a manifest");
    let (start, rest) = manifest.split_once("members = [").expect("it lists its members");
    let (_, rest) = rest.split_once("[workspace.package]").expect("it has a table of the package");
    // Packages of another version: what is compiled of them must not be taken for what is compiled of the originals.
    let rest = rest.replacen("\nversion = \"", "\nversion = \"9", 1);
    let manifest = format!("{start}members = {MEMBERS:?}\n[workspace.package]{rest}");
    fs::write(root.join("Cargo.toml"), manifest).expect("the manifest can be written");
    fs::copy(house().join("Cargo.lock"), root.join("Cargo.lock")).expect("the lock file can be copied");
    root
}

/// The blocks of the recipe, each with the file that was named last before it.
fn blocks() -> Vec<(String, String)> {
    let mut blocks = Vec::new();
    let (mut path, mut block) = (String::new(), None::<String>);
    for line in RECIPE.lines() {
        match (&mut block, line.starts_with("```")) {
            (None, true) => block = Some(String::new()),
            (Some(text), false) => *text += &format!("{line}\n"),
            (Some(_), true) => blocks.extend(block.take().map(|text| (path.clone(), text))),
            (None, false) => {
                let is_source = |name: &&str| name.ends_with(".rs") || name.ends_with(".wgsl");
                path =
                    line.split('`').skip(1).step_by(2).filter(is_source).last().map_or(path, str::to_owned);
            }
        }
    }
    blocks
}

/// Follows the recipe: a block of one line goes into a list of its file, any other is the file.
fn follow(root: &Path) {
    for (path, block) in blocks() {
        let path = root.join(path);
        let Some((_, before)) = LISTS.iter().find(|(line, _)| block.trim() == *line) else {
            assert!(!path.exists(), "{} is there already", path.display());
            fs::write(&path, block).expect("the file can be written");
            continue;
        };
        let text = fs::read_to_string(&path).expect("the file with the list is there");
        let place = text.lines().position(|line| line.trim().starts_with(before)).expect("the list is there");
        let mut lines: Vec<&str> = text.lines().collect();
        lines.insert(place, block.trim_end());
        fs::write(&path, lines.join("\n") + "\n").expect("the file can be written");
    }
}

/// Runs cargo in the copy; whether that went well, and what was said.
fn cargo(root: &Path, args: &[&str]) -> (bool, String) {
    let target = Path::new(env!("CARGO_TARGET_TMPDIR")).parent().expect("it lies in the target folder");
    let mut command = Command::new(env!("CARGO"));
    command.current_dir(root).env("CARGO_TARGET_DIR", target);
    command.args(args).args(["--offline", "--quiet"]);
    if !cfg!(debug_assertions) {
        command.arg("--release");
    }
    let output = command.output().expect("cargo runs");
    let said = String::from_utf8_lossy(&output.stdout) + String::from_utf8_lossy(&output.stderr);
    (output.status.success(), said.into_owned())
}

fn check_twin(root: &Path) -> (bool, String) {
    cargo(root, &["check", "--package", "twin"])
}

fn validate_kernels(root: &Path) -> (bool, String) {
    cargo(root, &["test", "--package", "shaders", "--test", "kernels"])
}

/// Replaces a word in a file that the recipe wrote.
fn spoil(path: &Path, word: &str, with: &str) {
    let text = fs::read_to_string(path).expect("the recipe wrote it");
    assert!(text.contains(word), "{} lacks {word}", path.display());
    fs::write(path, text.replace(word, with)).expect("the file can be written");
}

#[test]
fn the_recipe_adds_an_enhancer_and_a_spoiled_one_is_found_out() {
    let root = copied_house();
    follow(&root);
    for (went_well, said) in [check_twin(&root), validate_kernels(&root)] {
        assert!(went_well, "{said}");
    }
    spoil(&root.join("shaders/wgsl/enhance/fog.wgsl"), "fog_at", "fog_ate");
    let (went_well, said) = validate_kernels(&root);
    assert!(!went_well && said.contains("fog_at"), "a module without a hook passes: {said}");
    spoil(&root.join("shaders/twin/src/enhance/fog.rs"), "fn constants", "fn constant");
    let (went_well, said) = check_twin(&root);
    assert!(!went_well && said.contains("constants"), "a twin without its constants passes: {said}");
}
