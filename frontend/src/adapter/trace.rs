//! The folder for the traces of a run.

use crate::FrontendError;
use renderer::output::{OutputError, can_write_into};
use std::path::{Path, PathBuf};
use std::time::SystemTime;

/// Where a back-end's trace will be, whatever host the back-end runs on.
pub(super) fn path(folder: &Path, backend: u32) -> PathBuf {
    std::path::absolute(folder).unwrap_or_else(|_| folder.to_owned()).join(format!("backend-{backend}.trace"))
}

/// The folder for the traces of a run. Those of an earlier run stay until new ones take their places.
pub struct TraceFolder {
    folder: PathBuf,
    /// The earlier trace of the first back-end: when it was written, and its bytes.
    earlier: Option<(SystemTime, u64)>,
}

impl TraceFolder {
    /// Makes the folder and tries to write in it.
    pub fn prepare(folder: &Path) -> Result<Self, FrontendError> {
        can_write_into(folder)?;
        Ok(Self { folder: folder.to_owned(), earlier: written(&path(folder, 0)) })
    }

    /// Once back-ends have finished: where they wrote traces, those of an earlier run that had more back-ends go.
    pub fn settle(&self, backends: usize) -> Result<(), FrontendError> {
        let newest = written(&path(&self.folder, 0));
        if newest.is_none() || newest == self.earlier {
            return Ok(());
        }
        let error = |path: &Path| {
            let path = path.to_owned();
            |source| OutputError::Write { path, source }
        };
        for entry in std::fs::read_dir(&self.folder).map_err(error(&self.folder))? {
            let path = entry.map_err(error(&self.folder))?.path();
            if backend_of(&path).is_some_and(|backend| backend as usize >= backends) {
                std::fs::remove_file(&path).map_err(error(&path))?;
            }
        }
        Ok(())
    }
}

fn written(path: &Path) -> Option<(SystemTime, u64)> {
    let facts = std::fs::metadata(path).ok()?;
    Some((facts.modified().ok()?, facts.len()))
}

/// The back-end whose trace has this name.
fn backend_of(path: &Path) -> Option<u32> {
    path.file_name()?.to_str()?.strip_prefix("backend-")?.strip_suffix(".trace")?.parse().ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(folder: &Path) -> Vec<String> {
        let names = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().file_name());
        let mut names: Vec<_> = names.map(|name| name.into_string().unwrap()).collect();
        names.sort();
        names
    }

    #[test]
    fn earlier_traces_go_once_new_ones_are_there_and_nothing_else() {
        let folder = tempfile::tempdir().unwrap();
        let traces = folder.path().join("traces");
        TraceFolder::prepare(&traces).unwrap().settle(1).unwrap();
        let earlier = ["backend-0.trace", "backend-17.trace", "backend-x.trace", "mine.trace"];
        for name in earlier {
            std::fs::write(traces.join(name), "earlier").unwrap();
        }
        let run = TraceFolder::prepare(&traces).unwrap();
        run.settle(2).unwrap();
        assert_eq!(names(&traces), earlier, "nothing has taken their places");
        std::fs::write(path(&traces, 0), "a new one").unwrap();
        run.settle(2).unwrap();
        assert_eq!(names(&traces), ["backend-0.trace", "backend-x.trace", "mine.trace"]);
    }
}
