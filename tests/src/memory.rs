//! Memory of this process.

/// Most memory this process has held, MiB.
pub fn peak_mib() -> f64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
    line.and_then(|rest| rest.trim().trim_end_matches(" kB").parse::<f64>().ok())
        .map_or(f64::NAN, |k| k / 1024.0)
}

/// Lets [`peak_mib`] count from now on.
///
/// # Errors
/// The system does not offer it.
pub fn forget_peak() -> std::io::Result<()> {
    // See proc(5): 5 resets the "high water mark".
    std::fs::write("/proc/self/clear_refs", "5")
}
