//! How this process was started, and how it ends when the run cannot go on.

use std::io::Write;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

/// How the programs have to be started on a cluster.
pub const HOW_TO_LAUNCH: &str = "mpirun -n 1 lightloom … : -n N lightloom-backend";

/// Where the back-ends of this run are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Launch {
    /// Threads of this process.
    OneProcess,
    /// The other ranks of an MPI job.
    Cluster,
}

/// How this process was started. An error is a sentence: it is one of several ranks and built without MPI.
pub fn launch() -> Result<Launch, String> {
    let launch = if under_mpi() { Launch::Cluster } else { Launch::OneProcess };
    if launch == Launch::Cluster && !cfg!(feature = "mpi") {
        // Rank 0 speaks for all: it ends the job before the others can print anything.
        if rank_in(|name| std::env::var(name).ok()) != Some(0) {
            std::thread::sleep(Duration::from_secs(2));
        }
        return Err(
            "this lightloom was built without MPI; build it with `--features mpi` to run it as several \
                    ranks, or start it without mpirun"
                .to_owned(),
        );
    }
    Ok(launch)
}

/// Whether a launcher started this process as one of several ranks. It reads only the environment, so a plain start
/// never initialises MPI. A single rank is a plain start.
pub fn under_mpi() -> bool {
    ranks_in(|name| std::env::var(name).ok()).is_some_and(|ranks| ranks > 1)
}

/// The number of ranks by an environment; None without a launcher. PMIx gives a process only its rank:
/// the number is then Slurm's, or counts as several.
fn ranks_in(variable: impl Fn(&str) -> Option<String>) -> Option<usize> {
    let number = |name| variable(name).and_then(|text| text.parse().ok());
    ["OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "MV2_COMM_WORLD_SIZE"]
        .into_iter()
        .find_map(number)
        .or_else(|| variable("PMIX_RANK").map(|_| number("SLURM_NTASKS").unwrap_or(2)))
}

/// Which of the ranks of its host this process is, as its launcher says; None where there is no launcher, or it does not
/// say.
pub fn local_rank() -> Option<u32> {
    under_mpi().then(|| local_rank_in(|name| std::env::var(name).ok())).flatten()
}

fn local_rank_in(variable: impl Fn(&str) -> Option<String>) -> Option<u32> {
    let names = [
        "OMPI_COMM_WORLD_LOCAL_RANK",
        "MPI_LOCALRANKID",
        "MV2_COMM_WORLD_LOCAL_RANK",
        "PMI_LOCAL_RANK",
        "PALS_LOCAL_RANKID",
        "SLURM_LOCALID",
    ];
    names.into_iter().find_map(|name| variable(name)?.parse().ok())
}

fn rank_in(variable: impl Fn(&str) -> Option<String>) -> Option<usize> {
    let names = ["OMPI_COMM_WORLD_RANK", "PMI_RANK", "MV2_COMM_WORLD_RANK", "PMIX_RANK"];
    names.into_iter().find_map(|name| variable(name).and_then(|text| text.parse().ok()))
}

static SAID: AtomicBool = AtomicBool::new(false);

/// Prints a line on standard error. Unlike `eprintln!` it does not panic when the launcher, which reads it, is gone, and
/// writes the line at once, so that lines of several ranks do not mix.
pub(super) fn say(program: &str, sentence: &str) {
    let _ = std::io::stderr().write_all(printable(&format!("{program}: {sentence}\n")).as_bytes());
}

/// Text that comes from files, without the characters that a terminal takes for commands; line ends and tabs stay.
pub fn printable(text: &str) -> String {
    let is_command = |c: char| c.is_control() && !matches!(c, '\n' | '\t');
    text.replace(is_command, "\u{fffd}")
}

/// Whether the caller is the first to say why the run ends. A lost back-end is noticed in more than one place, and
/// one sentence is enough.
pub(super) fn is_first_to_say() -> bool {
    !SAID.swap(true, Ordering::SeqCst)
}

/// Ends the run: prints `program: sentence` on standard error, and ends the other ranks too, if there are any.
/// Call it from the main thread. The exit code is 1.
pub fn fail(program: &str, sentence: &str) -> ! {
    if is_first_to_say() {
        say(program, sentence);
    } else {
        // Another thread is saying it and ends the process when it has.
        std::thread::sleep(Duration::from_secs(5));
    }
    #[cfg(feature = "mpi")]
    super::mpi::abort_if_running(1);
    std::process::exit(1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_command_reaches_the_terminal() {
        let text = "title \u{1b}]0;x\u{7}, colour \u{9b}31m, bell \u{7}\r\nnext\tline é";
        let plain = "title \u{fffd}]0;x\u{fffd}, colour \u{fffd}31m, bell \u{fffd}\u{fffd}\nnext\tline é";
        assert_eq!(printable(text), plain);
    }

    fn value(environment: &[(&str, &str)], name: &str) -> Option<String> {
        environment.iter().find(|(n, _)| *n == name).map(|(_, value)| (*value).to_owned())
    }

    fn ranks(environment: &[(&str, &str)]) -> Option<usize> {
        ranks_in(|name| value(environment, name))
    }

    #[test]
    fn the_launchers_are_recognised_by_what_they_set() {
        assert_eq!(ranks(&[]), None);
        assert_eq!(ranks(&[("SLURM_NTASKS", "4")]), None);
        assert_eq!(ranks(&[("OMPI_COMM_WORLD_SIZE", "4")]), Some(4));
        assert_eq!(ranks(&[("PMI_SIZE", "1")]), Some(1));
        assert_eq!(ranks(&[("PMIX_RANK", "0"), ("SLURM_NTASKS", "3")]), Some(3));
        assert_eq!(ranks(&[("PMIX_RANK", "0")]), Some(2));
    }

    #[test]
    fn a_rank_s_place_on_its_host_is_what_its_launcher_says() {
        let local = |environment: &[(&str, &str)]| local_rank_in(|name| value(environment, name));
        assert_eq!(local(&[]), None);
        assert_eq!(local(&[("OMPI_COMM_WORLD_LOCAL_RANK", "3"), ("SLURM_LOCALID", "0")]), Some(3));
        assert_eq!(local(&[("MPI_LOCALRANKID", "?"), ("SLURM_LOCALID", "2")]), Some(2));
    }
}
