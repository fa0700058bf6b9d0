//! What the processors of this host have taken, where the machine tells (Intel's and AMD's RAPL, through Linux's powercap).

use std::fs;
use std::path::{Path, PathBuf};

const POWERCAP: &str = "/sys/class/powercap";

/// A counter of one package of processors.
#[derive(Clone, Debug)]
struct Counter {
    folder: PathBuf,
    began_uj: u64,
}

/// The counters of this host, from when they were read first.
#[derive(Clone, Debug)]
pub struct Energy(Vec<Counter>);

impl Energy {
    /// Reads them; without any that can be read nothing is told.
    pub fn begin() -> Self {
        Self::of(Path::new(POWERCAP))
    }

    fn of(folder: &Path) -> Self {
        let entries = fs::read_dir(folder).into_iter().flatten().flatten().map(|entry| entry.path());
        // "intel-rapl:0" is a package; "intel-rapl:0:1" is a part of one.
        let is_package = |path: &PathBuf| {
            let name = path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
            name.starts_with("intel-rapl:") && name.matches(':').count() == 1
        };
        let counter = |folder: PathBuf| Some(Counter { began_uj: number(&folder, "energy_uj")?, folder });
        Self(entries.filter(is_package).filter_map(counter).collect())
    }

    /// What was taken since, joules; None where no counter tells.
    pub fn joules(&self) -> Option<f64> {
        let since = |counter: &Counter| {
            let now = number(&counter.folder, "energy_uj")?;
            let range = number(&counter.folder, "max_energy_range_uj").unwrap_or(u64::MAX);
            // It begins again at 0 beyond its range.
            let taken = now.checked_sub(counter.began_uj).unwrap_or_else(|| now + (range - counter.began_uj));
            Some(taken as f64 / 1e6)
        };
        self.0.iter().map(since).sum::<Option<f64>>().filter(|_| !self.0.is_empty())
    }
}

fn number(folder: &Path, file: &str) -> Option<u64> {
    fs::read_to_string(folder.join(file)).ok()?.trim().parse().ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn packages_are_added_up_and_wrap() {
        let folder = tempfile::tempdir().unwrap();
        let write = |name: &str, uj: u64| {
            let counter = folder.path().join(name);
            fs::create_dir_all(&counter).unwrap();
            fs::write(counter.join("energy_uj"), format!("{uj}\n")).unwrap();
            fs::write(counter.join("max_energy_range_uj"), "10000000\n").unwrap();
        };
        write("intel-rapl:0", 1_000_000);
        write("intel-rapl:1", 9_000_000);
        write("intel-rapl:0:0", 500);
        let energy = Energy::of(folder.path());
        write("intel-rapl:0", 3_500_000);
        write("intel-rapl:1", 2_000_000);
        write("intel-rapl:0:0", 5_000_000);
        assert_eq!(energy.joules(), Some(5.5));
        assert_eq!(Energy::of(&folder.path().join("nothing")).joules(), None);
    }
}
