//! The processes of a run, and which of them are still there.

use super::process;

/// A process that said where it runs.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Peer {
    /// Its rank.
    pub rank: usize,
    /// Its host.
    pub host: String,
    /// Its number on that host.
    pub process: u32,
    /// Whether this process can see it: it is on the same host, and was seen when it introduced itself. Hosts in
    /// containers may share a name but not their processes, so the name alone is not enough.
    is_visible: bool,
}

impl Peer {
    /// A peer that has just introduced itself, so it is alive now.
    pub fn new(rank: usize, host: String, process: u32) -> Self {
        let is_visible = host == process::host() && process::is_running(process) == Some(true);
        Self { rank, host, process, is_visible }
    }

    /// Whether it is known to be gone.
    pub fn is_gone(&self) -> bool {
        self.is_visible && process::is_running(self.process) == Some(false)
    }
}

/// The back-ends of a run and what it is doing.
#[derive(Debug, Default)]
pub struct Roster {
    /// Back-end i at i; empty until all have introduced themselves.
    pub backends: Vec<Peer>,
    /// For instance `drawing frame 3`.
    pub activity: String,
}

impl Roster {
    /// A back-end's name and place.
    pub fn name(&self, backend: usize) -> String {
        match self.backends.get(backend) {
            Some(Peer { rank, host, process, .. }) => {
                format!("back-end {backend} (rank {rank}, process {process} on host {host})")
            }
            None => format!("back-end {backend}"),
        }
    }

    /// The back-ends known to be gone.
    pub fn gone(&self) -> Vec<usize> {
        (0..self.backends.len()).filter(|&backend| self.backends[backend].is_gone()).collect()
    }

    /// One sentence that names those that are gone.
    pub fn obituary(&self, gone: &[usize]) -> String {
        let names: Vec<String> = gone.iter().map(|&backend| self.name(backend)).collect();
        format!("{} ended while {}: {WHAT_TO_DO}", names.join(" and "), self.activity)
    }
}

/// What is known of a process that vanished, and what to do.
pub const WHAT_TO_DO: &str = "its process is gone without a word; see what it printed above and whether the system \
     killed it for memory (dmesg), then start the run again";
