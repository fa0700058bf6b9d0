//! Kernels kept from one run to the next save time, and change no picture.

use lightloom_tests::program::{assert_same, files, has_gpu, lightloom, pictures, run, small_display};
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

type Files = BTreeMap<String, Vec<u8>>;

/// Runs of one scene with a folder of caches of their own.
struct Runs {
    folder: tempfile::TempDir,
    display: String,
}

impl Runs {
    fn new() -> Self {
        let folder = tempfile::tempdir().unwrap();
        let display = small_display(folder.path());
        Self { folder, display }
    }

    fn caches(&self) -> PathBuf {
        self.folder.path().join("caches")
    }

    /// The pictures, with caches below `caches`, or none at all.
    fn draw(&self, name: &str, caches: &Path, is_off: bool) -> Files {
        let out = self.folder.path().join(name);
        let fixed = ["simulate", "procedural:shells@32", "--device", "gpu", "--exr", "--quiet"];
        let (display, to) = (["--display", &self.display], ["--out", &out.to_string_lossy()]);
        let mut command = lightloom(&[&fixed[..], &display[..], &to[..]].concat());
        // Mesa's own cache would stand beside ours.
        command.env("MESA_SHADER_CACHE_DISABLE", "true");
        command.env("XDG_CACHE_HOME", caches).env("LIGHTLOOM_NO_CACHE", if is_off { "1" } else { "" });
        run(&mut command).succeeded();
        pictures(&out)
    }
}

#[test]
fn a_cache_changes_no_picture_whatever_is_in_it() {
    if !has_gpu() {
        return;
    }
    let runs = Runs::new();
    let caches = runs.caches();
    let without = runs.draw("without", &caches, true);
    assert!(!without.is_empty() && files(&caches).is_empty(), "a cache that is off writes nothing");
    assert_same("an empty cache", &without, &runs.draw("cold", &caches, false));
    let kept = files(&caches);
    println!("kept: {:?}", kept.iter().map(|(name, bytes)| (name, bytes.len())).collect::<Vec<_>>());
    if kept.is_empty() {
        println!("SKIPPED: this driver keeps no compiled kernels");
        return;
    }
    assert!(kept.keys().all(|name| name.starts_with("lightloom/pipelines/")), "{:?}", kept.keys());
    assert_same("the cache of the run before", &without, &runs.draw("warm", &caches, false));
    let path = caches.join(kept.keys().next().unwrap());
    let whole = fs::read(&path).unwrap();
    let mut flipped = whole.clone();
    *flipped.last_mut().unwrap() ^= 0x10;
    for (name, spoilt) in [
        ("flipped", &flipped[..]),
        ("cut", &whole[..whole.len() / 2]),
        ("empty", &[]),
        ("foreign", b"something else altogether"),
    ] {
        fs::write(&path, spoilt).unwrap();
        assert_same(name, &without, &runs.draw(name, &caches, false));
        // What could not be used has made room for what can.
        assert_ne!(fs::read(&path).unwrap(), spoilt, "{name}");
    }
}

#[test]
fn a_folder_that_takes_no_cache_is_no_error() {
    if !has_gpu() {
        return;
    }
    let runs = Runs::new();
    let file = runs.folder.path().join("no folder");
    fs::write(&file, "").unwrap();
    let expected = runs.draw("without", &file, true);
    assert_same("a file where the folder ought to be", &expected, &runs.draw("beside", &file, false));
    assert_same("a folder for no one", &expected, &runs.draw("proc", Path::new("/proc"), false));
}

#[test]
fn several_that_start_at_once_leave_a_whole_cache() {
    if !has_gpu() {
        return;
    }
    let runs = Runs::new();
    let caches = runs.caches();
    let all: Vec<Files> = std::thread::scope(|scope| {
        let threads = ["a", "b"].map(|name| scope.spawn(|| runs.draw(name, &caches, false)));
        threads.map(|thread| thread.join().unwrap()).into()
    });
    assert_same("two at once", &all[0], &all[1]);
    let kept = files(&caches);
    assert!(kept.len() <= 1, "no working file stays: {:?}", kept.keys());
    assert_same("after them", &all[0], &runs.draw("after", &caches, false));
}
