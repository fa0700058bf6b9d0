//! Whether a process of this machine still runs.

use std::fs;

/// The name of this host.
pub fn host() -> String {
    let name =
        fs::read_to_string("/proc/sys/kernel/hostname").or_else(|_| fs::read_to_string("/etc/hostname"));
    match name.as_deref().map(str::trim) {
        Ok(name) if !name.is_empty() => name.to_owned(),
        _ => "(unnamed)".to_owned(),
    }
}

/// Whether a process runs on this host: None if the system does not say. One that has died and waits for its
/// parent to notice does not run.
#[cfg(any(feature = "mpi", test))]
pub fn is_running(process: u32) -> Option<bool> {
    if !std::path::Path::new("/proc/self/stat").exists() {
        return None;
    }
    // The second field is the program's name in parentheses, which may itself hold spaces and parentheses.
    let stat = fs::read_to_string(format!("/proc/{process}/stat")).unwrap_or_default();
    let state = stat.rsplit_once(") ").and_then(|(_, fields)| fields.chars().next());
    Some(!matches!(state, None | Some('Z' | 'X')))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::process::{Command, Stdio};
    use std::time::Duration;

    #[test]
    fn a_killed_process_does_not_run_even_before_its_parent_notices() {
        if is_running(std::process::id()).is_none() {
            println!("skipped: this system has no /proc");
            return;
        }
        let mut child = Command::new("sleep").arg("60").stdout(Stdio::null()).spawn().unwrap();
        assert_eq!(is_running(child.id()), Some(true));
        child.kill().unwrap();
        std::thread::sleep(Duration::from_millis(100));
        assert_eq!(is_running(child.id()), Some(false));
        child.wait().unwrap();
        assert_eq!(is_running(child.id()), Some(false));
    }
}
