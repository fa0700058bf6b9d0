//! How much memory this process has used.

/// The largest resident size so far, bytes; None if the system has no `/proc`.
pub fn peak_memory_bytes() -> Option<u64> {
    peak_in(&std::fs::read_to_string("/proc/self/status").ok()?)
}

fn peak_in(status: &str) -> Option<u64> {
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    let kib: u64 = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
    Some(1024 * kib)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_peak_is_read_in_kibibytes() {
        assert_eq!(peak_in("VmPeak:\t  10 kB\nVmHWM:\t   2048 kB\n"), Some(2 << 20));
        assert_eq!(peak_in("nothing"), None);
    }
}
