//! What an earlier run left in the output folder.

use crate::report::{self, CONTACT_SHEET};
use renderer::output::OutputError;
use std::fs;
use std::io::{self, ErrorKind};
use std::path::Path;

/// How the name of a frame's folder begins; the number follows, of four digits or more.
const FRAME: &str = "frame-";

/// The folder of a frame.
pub(super) fn frame_folder(index: u32) -> String {
    format!("{FRAME}{index:04}")
}

/// Removes the reports and pictures of an earlier run, by their names; all other files stay.
pub(super) fn remove_earlier_run(out: &Path) -> Result<(), OutputError> {
    for name in report::FILES {
        remove(&out.join(name), |path| fs::remove_file(path))?;
    }
    let of_run = |name: &str| number_after(name, FRAME).is_some_and(|digits| digits.len() >= 4);
    for folder in below(out, of_run)?.into_iter().filter(|folder| folder.is_dir()) {
        for picture in below(&folder, is_picture)? {
            remove(&picture, |path| fs::remove_file(path))?;
        }
        // Something of somebody else may be in it.
        if below(&folder, |_| true)?.is_empty() {
            remove(&folder, |path| fs::remove_dir(path))?;
        }
    }
    Ok(())
}

/// Whether a frame's folder has a file of this name.
fn is_picture(name: &str) -> bool {
    let stem = name.strip_suffix(".png").or_else(|| name.strip_suffix(".exr"));
    let is_numbered =
        |stem| ["projector-", "calibrated-", "eye-"].iter().any(|kind| number_after(stem, kind).is_some());
    name == CONTACT_SHEET || stem.is_some_and(is_numbered)
}

/// The digits that follow `start`, where nothing else does.
fn number_after<'a>(name: &'a str, start: &str) -> Option<&'a str> {
    let digits = name.strip_prefix(start)?;
    (!digits.is_empty() && digits.bytes().all(|byte| byte.is_ascii_digit())).then_some(digits)
}

/// What a folder holds, by name; nothing where it is no folder.
fn below(folder: &Path, is_wanted: impl Fn(&str) -> bool) -> Result<Vec<std::path::PathBuf>, OutputError> {
    let failed = |source| OutputError::Write { path: folder.to_owned(), source };
    let entries = match fs::read_dir(folder) {
        Err(error) if matches!(error.kind(), ErrorKind::NotFound | ErrorKind::NotADirectory) => {
            return Ok(Vec::new());
        }
        entries => entries.map_err(failed)?,
    };
    let mut found = Vec::new();
    for entry in entries {
        let entry = entry.map_err(failed)?;
        if is_wanted(&entry.file_name().to_string_lossy()) {
            found.push(entry.path());
        }
    }
    Ok(found)
}

fn remove(path: &Path, remove: impl Fn(&Path) -> io::Result<()>) -> Result<(), OutputError> {
    match remove(path) {
        Err(source) if source.kind() != ErrorKind::NotFound => {
            Err(OutputError::Write { path: path.to_owned(), source })
        }
        _ => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_what_a_run_writes_goes() {
        let out = tempfile::tempdir().unwrap();
        let file = |name: &str| {
            let path = out.path().join(name);
            fs::create_dir_all(path.parent().unwrap()).unwrap();
            fs::write(&path, "").unwrap();
        };
        let ours = [
            "report.html",
            "contact-sheet.png",
            "frame-0000/projector-00.png",
            "frame-0000/eye-0.exr",
            "frame-0000/calibrated-00.png",
            "frame-0000/contact-sheet.png",
            "frame-12345/projector-123.exr",
        ];
        let others = [
            "frame-0007/notes.txt",
            "frame-0007/projector-00.txt",
            "frame-0007/projector-x.png",
            "frame-1/projector-00.png",
            "frame-001x/eye-0.png",
            "pictures/projector-00.png",
            "projector-00.png",
            "frame-0003",
        ];
        ours.iter().chain(&others).for_each(|name| file(name));
        remove_earlier_run(out.path()).unwrap();
        assert!(others.iter().all(|name| out.path().join(name).exists()));
        assert!(ours.iter().all(|name| !out.path().join(name).exists()));
        assert!(!out.path().join("frame-0000").exists() && !out.path().join("frame-12345").exists());
        assert!(remove_earlier_run(&out.path().join("nowhere")).is_ok());
    }
}
