//! A show on a cluster whose renderers are ended from outside, and what is seen of it meanwhile.

use crate::machine;
use crate::processes::{children, command_line, is_there, signal, variable};
use crate::program::{Ran, Running, SMALL_DISPLAY, cluster, lightloom, pictures, run, start};
use std::collections::BTreeMap;
use std::fs;
use std::path::PathBuf;
use std::thread::sleep;
use std::time::{Duration, Instant, SystemTime};

/// Each draws one projector.
pub const BACKENDS: u32 = 4;

/// Frames a second: two cores draw them with time to spare.
pub const RATE_HZ: f64 = 20.0;

const SCENE: &str = "procedural:shells@64";

/// A show comes to rest within this.
const LIMIT: Duration = Duration::from_secs(60);

/// A back-end comes back within this, or never.
pub const COMES_BACK_WITHIN: Duration = Duration::from_secs(20);

const LOOK_INTERVAL: Duration = Duration::from_millis(3);
/// That reads what the system tells of every process, and a renderer takes longer to begin.
const LOOK_FOR_PROCESS: Duration = Duration::from_millis(20);

/// A still scene that is shown, frame by frame, and its pictures on their way.
pub struct Show {
    running: Running,
    folder: tempfile::TempDir,
    /// What each projector shows in the end.
    complete: BTreeMap<u32, Vec<u8>>,
}

/// A process that draws.
#[derive(Clone, Copy, Debug)]
pub struct Kept {
    /// Which back-end it is.
    pub backend: u32,
    /// The rank that keeps it.
    pub keeper: u32,
    /// It.
    pub process: u32,
}

/// How a back-end came back.
#[derive(Clone, Copy, Debug)]
pub struct Comeback {
    /// Until it showed something again.
    pub shown: Duration,
    /// Until it showed the complete picture again.
    pub right: Duration,
    /// How much longer the others took for a frame, at most, meanwhile.
    pub others_late: Duration,
}

impl Show {
    /// Begins one of so many seconds, and waits until all projectors show their complete pictures. None where there is no
    /// MPI, which is said aloud.
    pub fn begin(seconds: u32) -> Option<Self> {
        machine::alone();
        let folder = tempfile::tempdir().expect("a temporary folder can be made");
        let path = |name: &str| folder.path().join(name).to_string_lossy().into_owned();
        let display = path("small4.toml");
        let wired = SMALL_DISPLAY.replace("backends = 2", &format!("backends = {BACKENDS}"));
        fs::write(&display, wired).expect("a temporary folder can be written");
        let fixed = [SCENE, "--display", &display, "--device", "cpu"];
        let (rate, time) = (RATE_HZ.to_string(), seconds.to_string());
        let (dump, drawn) = (path("dump"), path("drawn"));
        let show =
            ["--output", "none", "--fade", "0", "--rate", &rate, "--for", &time, "--dump", &dump, "--json"];
        let mut command = cluster(&[&["drive"], &fixed[..], &show].concat(), BACKENDS)?;
        run(&mut lightloom(&[&["simulate"], &fixed[..], &["--out", &drawn, "--quiet"]].concat())).succeeded();
        let complete = (0..BACKENDS).zip(pictures_of(&drawn)).collect();
        let show = Self { running: start(&mut command), folder, complete };
        let since = Instant::now();
        while !(0..BACKENDS).all(|backend| show.newest(0).is_some_and(|frame| show.is_right(frame, backend)))
        {
            assert!(since.elapsed() < LIMIT, "the show does not come to rest");
            sleep(LOOK_INTERVAL);
        }
        Some(show)
    }

    /// Its launcher.
    pub fn launcher(&self) -> u32 {
        self.running.process()
    }

    /// How long it has been running.
    pub fn age(&self) -> Duration {
        self.running.age()
    }

    /// The front-end.
    pub fn frontend(&self) -> u32 {
        let is_frontend = |&process: &u32| command_line(process).contains("/lightloom drive");
        children(self.launcher()).into_iter().find(is_frontend).expect("a show has a front-end")
    }

    /// What draws at the moment.
    pub fn renderers(&self) -> Vec<Kept> {
        let keepers = children(self.launcher()).into_iter().filter_map(|keeper| {
            let rank = variable(keeper, "OMPI_COMM_WORLD_RANK")?.parse::<u32>().ok()?;
            Some((rank.checked_sub(1)?, keeper))
        });
        let mut kept: Vec<Kept> = keepers
            .flat_map(|(backend, keeper)| {
                children(keeper).into_iter().map(move |process| Kept { backend, keeper, process })
            })
            .collect();
        kept.sort_unstable_by_key(|one| one.backend);
        kept
    }

    fn picture(&self, frame: u32, backend: u32) -> PathBuf {
        self.folder.path().join(format!("dump/frame-{frame:06}/projector-{backend:02}.png"))
    }

    /// The newest frame of which there are pictures, from a frame on that is known to be there.
    pub fn newest(&self, from: u32) -> Option<u32> {
        let is_there = |frame: u32| (0..BACKENDS).any(|backend| self.picture(frame, backend).exists());
        // Two frames may be on their way at once, and one may have come to nothing.
        let mut newest = is_there(from).then_some(from);
        let mut next = from;
        while next <= newest.unwrap_or(from) + 3 {
            if is_there(next) {
                newest = Some(next);
            }
            next += 1;
        }
        newest
    }

    /// Whether a projector shows its complete picture in a frame.
    pub fn is_right(&self, frame: u32, backend: u32) -> bool {
        fs::read(self.picture(frame, backend)).is_ok_and(|bytes| bytes == self.complete[&backend])
    }

    fn shown_at(&self, frame: u32, backend: u32) -> Option<SystemTime> {
        fs::metadata(self.picture(frame, backend)).and_then(|file| file.modified()).ok()
    }

    /// Ends a renderer by a signal, and waits until another shows the complete picture. None where that does not come.
    pub fn end(&self, victim: Kept, signal_name: &str, newest: u32) -> Option<Comeback> {
        let Kept { backend, keeper, process } = victim;
        let before = self.newest(newest).unwrap_or(newest);
        signal(process, signal_name);
        let since = Instant::now();
        let has_another = || children(keeper).iter().any(|&child| child != process);
        while !has_another() && since.elapsed() < COMES_BACK_WITHIN {
            sleep(LOOK_FOR_PROCESS);
            if signal_name == "SEGV" && is_there(process) {
                // Rust looks at the first for a stack that is full, and goes on; a fault would come again by itself.
                signal(process, signal_name);
            }
        }
        // What was drawn before its end may still be shown; a new renderer does not get that far in no time.
        let mut newest = self.newest(before).unwrap_or(before);
        let (first, mut shown) = (newest + 1, None);
        while since.elapsed() < COMES_BACK_WITHIN {
            newest = self.newest(newest).unwrap_or(newest);
            let has_shown = (first..=newest).any(|frame| self.picture(frame, backend).exists());
            shown = shown.or_else(|| has_shown.then(|| since.elapsed()));
            if let Some(shown) = shown
                && (first..=newest).any(|frame| self.is_right(frame, backend))
            {
                let others_late = self.longest_wait(before, newest, backend);
                return Some(Comeback { shown, right: since.elapsed(), others_late });
            }
            sleep(LOOK_INTERVAL);
        }
        None
    }

    /// How much longer than a period any other back-end's frame was waited for.
    fn longest_wait(&self, from: u32, to: u32, but: u32) -> Duration {
        let period = Duration::from_secs_f64(1.0 / RATE_HZ);
        let others = (0..BACKENDS).filter(|&backend| backend != but);
        let late = others.map(|backend| {
            let times: Vec<SystemTime> =
                (from..=to).filter_map(|frame| self.shown_at(frame, backend)).collect();
            let steps = times.windows(2).map(|pair| pair[1].duration_since(pair[0]).unwrap_or_default());
            steps.max().unwrap_or_default().saturating_sub(period)
        });
        late.max().unwrap_or_default()
    }

    /// Forgets the pictures of frames before one.
    pub fn forget_before(&self, frame: u32) {
        for old in
            (0..frame).rev().take_while(|&old| self.picture(old, 0).parent().is_some_and(|one| one.exists()))
        {
            let _ = self.picture(old, 0).parent().map(fs::remove_dir_all);
        }
    }

    /// Waits for its end.
    pub fn finish(self, limit: Duration) -> Ran {
        self.running.finish(limit)
    }
}

/// What projectors show, in their order.
fn pictures_of(folder: &str) -> Vec<Vec<u8>> {
    let of_projector = |(name, _): &(String, Vec<u8>)| name.contains("frame-0000/projector-");
    let found: Vec<_> = pictures(folder.as_ref()).into_iter().filter(of_projector).collect();
    assert_eq!(found.len(), BACKENDS as usize, "a picture for each projector");
    found.into_iter().map(|(_, bytes)| bytes).collect()
}
