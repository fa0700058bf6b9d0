//! The files of the house.

use std::path::{Path, PathBuf};

/// The only top-level folders.
pub const FOLDERS: [&str; 5] = ["display-config", "shaders", "backend", "frontend", "tests"];
/// A text file of the repository.
pub struct Source {
    /// Its path from the root, with slashes.
    pub path: String,
    /// All of it.
    pub text: String,
}

/// The root of the repository.
pub fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..").canonicalize().expect("the workspace is there")
}

/// A file of the repository.
pub fn read(path: &str) -> String {
    std::fs::read_to_string(root().join(path)).unwrap_or_else(|error| panic!("{path}: {error}"))
}

/// The paths below a folder of the repository, from its root, with slashes.
pub fn walk(folder: &str, paths: &mut Vec<String>) {
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
pub fn sources() -> Vec<Source> {
    let mut paths = Vec::new();
    FOLDERS.iter().for_each(|folder| walk(folder, &mut paths));
    paths.retain(|path| path.ends_with(".rs") || path.ends_with(".wgsl"));
    paths.retain(|path| !path.starts_with("tests/data/"));
    assert!(paths.len() > 100, "only {} sources found", paths.len());
    paths.into_iter().map(|path| Source { text: read(&path), path }).collect()
}

/// A file that is made up.
pub fn source(path: &str, text: &str) -> Source {
    Source { path: path.to_owned(), text: text.to_owned() }
}
