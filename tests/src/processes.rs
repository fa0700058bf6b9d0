//! Processes of this machine, as the system tells of them.

use std::fs;
use std::process::Command;

/// The numbers of all processes.
fn all() -> impl Iterator<Item = u32> {
    let entries = fs::read_dir("/proc").into_iter().flatten().flatten();
    entries.filter_map(|entry| entry.file_name().to_str()?.parse().ok())
}

/// What is said of a process after its name; nothing where it is not there.
fn fields(process: u32) -> Vec<String> {
    let stat = fs::read_to_string(format!("/proc/{process}/stat")).unwrap_or_default();
    let fields = stat.rsplit_once(") ").map_or("", |(_, fields)| fields);
    fields.split(' ').map(str::to_owned).collect()
}

/// The children of a process, those that have ended and are not missed yet left out.
pub fn children(parent: u32) -> Vec<u32> {
    let is_child = |process: u32| {
        let fields = fields(process);
        let is_of_parent = fields.get(1).and_then(|of| of.parse().ok()) == Some(parent);
        is_of_parent && fields.first().is_some_and(|state| is_alive(state))
    };
    let mut children: Vec<u32> = all().filter(|&process| is_child(process)).collect();
    children.sort_unstable();
    children
}

fn is_alive(state: &str) -> bool {
    !matches!(state, "" | "Z" | "X")
}

/// Whether a process is there and has not ended.
pub fn is_there(process: u32) -> bool {
    fields(process).first().is_some_and(|state| is_alive(state))
}

/// Processor time a process has used, in ticks of the clock.
pub fn ticks(process: u32) -> u64 {
    fields(process).iter().skip(11).take(2).filter_map(|field| field.parse::<u64>().ok()).sum()
}

/// Its program and arguments.
pub fn command_line(process: u32) -> String {
    let line = fs::read_to_string(format!("/proc/{process}/cmdline")).unwrap_or_default();
    line.trim_end_matches('\0').replace('\0', " ")
}

/// A variable of its environment.
pub fn variable(process: u32, name: &str) -> Option<String> {
    let environment = fs::read(format!("/proc/{process}/environ")).ok()?;
    let environment = String::from_utf8_lossy(&environment).into_owned();
    environment.split('\0').find_map(|one| Some(one.strip_prefix(name)?.strip_prefix('=')?.to_owned()))
}

/// How many files it has open.
pub fn open_files(process: u32) -> usize {
    fs::read_dir(format!("/proc/{process}/fd")).map_or(0, Iterator::count)
}

/// The memory that it holds, MiB.
pub fn resident_mib(process: u32) -> f64 {
    let status = fs::read_to_string(format!("/proc/{process}/status")).unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("VmRSS:"));
    line.and_then(|rest| rest.trim().trim_end_matches(" kB").parse::<f64>().ok()).map_or(0.0, |k| k / 1024.0)
}

/// Sends it a signal, by its name without SIG; false where it is not there.
pub fn signal(process: u32, name: &str) -> bool {
    let sent = Command::new("kill").args(["-s", name, &process.to_string()]).status();
    sent.is_ok_and(|status| status.success())
}
