//! The names of tapes' parts, and which of a folder's tapes are the oldest.

use std::path::{Path, PathBuf};

/// The name of a part of a tape, from 1.
pub fn path_of(base: &Path, part: u32) -> PathBuf {
    if part == 1 {
        return base.to_owned();
    }
    let extension = base.extension().unwrap_or_default().to_string_lossy();
    base.with_file_name(format!("{}-{part:04}.{extension}", stem(base)))
}

/// Removes the oldest parts of this tape, and before them the tapes of the folder that are named by the time at which their
/// shows began, so that `keep` are left. Files of other names are somebody's own.
pub fn keep_latest(base: &Path, keep: usize) {
    let folder = base.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let Ok(entries) = std::fs::read_dir(folder) else { return };
    let files = entries.filter_map(|entry| Some(entry.ok()?.path()));
    let mut tapes: Vec<(bool, String, u32, PathBuf)> = files.filter_map(|path| place(base, path)).collect();
    tapes.sort();
    for (.., path) in tapes.iter().take(tapes.len().saturating_sub(keep)) {
        // One that cannot be removed stays; the next part tries again.
        let _ = std::fs::remove_file(path);
    }
}

/// Where a file stands among tapes, if it is one: those of this show last.
fn place(base: &Path, path: PathBuf) -> Option<(bool, String, u32, PathBuf)> {
    if path.extension() != base.extension() {
        return None;
    }
    let (own, name) = (stem(base), stem(&path));
    let (show, part) = match name.rsplit_once('-').filter(|(show, _)| *show == own || is_time(show)) {
        Some((show, part)) => (show.to_owned(), part.parse().ok()?),
        None => (name, 1),
    };
    (show == own || is_time(&show)).then(|| (show == own, show, part, path))
}

/// Whether a show is named as `2026-11-25T17-00-00.123Z`.
fn is_time(name: &str) -> bool {
    const LIKE: &[u8] = b"0000-00-00T00-00-00.000Z";
    let fits = |(byte, like): (u8, &u8)| if *like == b'0' { byte.is_ascii_digit() } else { byte == *like };
    name.len() == LIKE.len() && name.bytes().zip(LIKE).all(fits)
}

fn stem(path: &Path) -> String {
    path.file_stem().unwrap_or_default().to_string_lossy().into_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_oldest_of_earlier_shows_go_first_and_other_files_stay() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        let base = at("2026-11-25T09-00-00.000Z.mcap");
        let names = [
            "2026-11-24T09-00-00.000Z.mcap",
            "2026-11-24T09-00-00.000Z-0002.mcap",
            "2026-11-24T09-00-00.000Z-0010.mcap",
            "2026-11-25T09-00-00.000Z.mcap",
            "2026-11-25T09-00-00.000Z-0002.mcap",
            "2026-11-25.mcap",
            "mine.mcap",
            "2026-11-23T09-00-00.000Z.txt",
        ];
        names.iter().for_each(|name| std::fs::write(at(name), "").unwrap());
        let there = || names.map(|name| at(name).exists());
        keep_latest(&base, 5);
        assert_eq!(there(), [true; 8]);
        keep_latest(&base, 3);
        assert_eq!(there(), [false, false, true, true, true, true, true, true]);
        keep_latest(&base, 1);
        assert_eq!(there(), [false, false, false, false, true, true, true, true]);
    }

    #[test]
    fn a_tape_of_any_name_counts_its_own_parts() {
        let folder = tempfile::tempdir().unwrap();
        let base = folder.path().join("day.mcap");
        let parts = [1, 2, 3].map(|part| path_of(&base, part));
        assert!(parts[1].ends_with("day-0002.mcap"));
        parts.iter().for_each(|path| std::fs::write(path, "").unwrap());
        keep_latest(&base, 2);
        assert_eq!(parts.map(|path| path.exists()), [false, true, true]);
    }
}
