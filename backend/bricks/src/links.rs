//! Symbolic links in the place of a file that is to be written.

use std::path::{Path, PathBuf};

/// Links that are followed one after the other; Linux follows as many.
const MOST_LINKS: usize = 40;

/// Where links lead from a path, whether anything is there or not: a file is written there, and the link stays.
///
/// # Errors
/// They lead in a circle.
pub fn followed(path: &Path) -> std::io::Result<PathBuf> {
    let mut path = path.to_path_buf();
    for _ in 0..MOST_LINKS {
        match std::fs::read_link(&path) {
            Ok(target) => path = path.with_file_name(target),
            Err(_) => return Ok(path),
        }
    }
    Err(std::io::Error::other("its links lead in a circle"))
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;
    use std::os::unix::fs::symlink;

    #[test]
    fn links_are_followed_to_where_they_lead() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        std::fs::create_dir(at("there")).unwrap();
        symlink("b", at("a")).unwrap();
        symlink("there/store.lloom", at("b")).unwrap();
        symlink("circle", at("circle")).unwrap();
        assert_eq!(followed(&at("a")).unwrap(), at("there/store.lloom"));
        assert_eq!(followed(&at("plain")).unwrap(), at("plain"));
        assert!(followed(&at("circle")).unwrap_err().to_string().contains("circle"));
    }
}
