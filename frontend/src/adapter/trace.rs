//! The folder for the traces of a run.

use crate::FrontendError;
use renderer::output::{OutputError, can_write_into};
use std::path::{Path, PathBuf};

/// Where a back-end's trace will be, whatever host the back-end runs on.
pub(super) fn path(folder: &Path, backend: u32) -> PathBuf {
    std::path::absolute(folder).unwrap_or_else(|_| folder.to_owned()).join(format!("backend-{backend}.trace"))
}

/// Makes the folder and tries to write in it. Traces of an earlier run go: it may have had more back-ends.
pub fn prepare_traces(folder: &Path) -> Result<(), FrontendError> {
    can_write_into(folder)?;
    let error = |path: &Path| {
        let path = path.to_owned();
        |source| OutputError::Write { path, source }
    };
    for entry in std::fs::read_dir(folder).map_err(error(folder))? {
        let path = entry.map_err(error(folder))?.path();
        if is_trace(&path) {
            std::fs::remove_file(&path).map_err(error(&path))?;
        }
    }
    Ok(())
}

/// Whether a file has the name of a back-end's trace.
fn is_trace(path: &Path) -> bool {
    let name = path.file_name().and_then(|name| name.to_str());
    let number = name.and_then(|name| name.strip_prefix("backend-")?.strip_suffix(".trace"));
    number.is_some_and(|number| number.parse::<u32>().is_ok())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn earlier_traces_go_and_nothing_else() {
        let folder = tempfile::tempdir().unwrap();
        let traces = folder.path().join("traces");
        prepare_traces(&traces).unwrap();
        for name in ["backend-0.trace", "backend-17.trace", "backend-x.trace", "mine.trace"] {
            std::fs::write(traces.join(name), "").unwrap();
        }
        prepare_traces(&traces).unwrap();
        let names = std::fs::read_dir(&traces).unwrap().map(|entry| entry.unwrap().file_name());
        let mut names: Vec<_> = names.collect();
        names.sort();
        assert_eq!(names, ["backend-x.trace", "mine.trace"]);
        assert!(is_trace(&path(&traces, 3)));
    }
}
