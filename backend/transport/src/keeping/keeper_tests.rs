//! Keepers of real processes, which draw nothing, and die as a test says: this test program starts itself again.

use super::*;
use crate::keeping::kept;
use crate::opened::Opened;
use crate::process::is_running;
use crate::session_fixtures::{device, device_after, frame, held, report, setups};
use protocol::{
    Advance, CodesAt, DrawError, FrameState, ProjectorImage, Render, ScreenImage, ScreenPicture, Screens,
    StopAsked,
};
use rustix::process::{Pid, Signal, kill_process};

/// Longer than any of these things takes.
const LIMIT: Duration = Duration::from_secs(30);

/// Set for a process that is to be a kept renderer: its keeper's process number.
const KEEPER: &str = "LIGHTLOOM_TEST_KEEPER";

/// Frames in which a renderer ends, and how.
const ABORTS: u32 = 1001;
const EXITS: u32 = 1002;
const FAILS: u32 = 1003;
const PANICS: u32 = 1004;
/// One in which it is slow, tile by tile, and one in which it never comes to the next tile.
const IS_SLOW: u32 = 1005;
const IS_STUCK: u32 = 1006;
/// One in which it holds something.
const HOLDS: u32 = 1007;

/// Beyond what a back-end of a test counts as stuck after.
const SLOWLY: Duration = Duration::from_millis(2500);

struct Fake(u32);

impl Render for Fake {
    fn restart(&mut self, frame: &FrameState) -> Result<(), DrawError> {
        self.0 = frame.index;
        Ok(())
    }

    fn advance(&mut self, stop: StopAsked) -> Result<Advance, DrawError> {
        match self.0 {
            ABORTS => std::process::abort(),
            EXITS => std::process::exit(7),
            FAILS => return Err(DrawError("the fake device is lost".to_owned())),
            PANICS => panic!("a fake fault"),
            IS_SLOW => {
                let since = Instant::now();
                while since.elapsed() < SLOWLY && !stop() {
                    std::thread::sleep(Duration::from_millis(20));
                }
            }
            IS_STUCK => std::thread::sleep(2 * LIMIT),
            _ => {}
        }
        Ok(Advance { done: 1, total: 1, lacking_bricks: 0, report: Some(Box::new(report(self.0, 0))) })
    }

    fn present(&mut self, _: &mut dyn FnMut(ProjectorImage)) -> Result<(), DrawError> {
        Ok(())
    }

    fn held(&mut self) -> Option<Held> {
        (self.0 == HOLDS).then(held)
    }

    fn present_on_screens(
        &mut self,
        _: CodesAt,
        sink: &mut dyn FnMut(ScreenPicture),
    ) -> Result<(), DrawError> {
        sink(ScreenPicture::Host(ScreenImage {
            projector: 0,
            width: 800,
            height: 600,
            rgb: vec![self.0 as u8; 3 * 800 * 600],
        }));
        Ok(())
    }
}

/// A renderer in a process of its own, where the environment asks for one; else nothing.
#[test]
fn be_a_kept_renderer() {
    let Ok(keeper) = std::env::var(KEEPER) else { return };
    let open = |setup: Setup| -> Result<Opened, String> {
        match setup.options.cache_bytes {
            0 => Err("there is no such volume".to_owned()),
            _ => Ok(Opened::new(Box::new(Fake(0)), device_after(setup.held))),
        }
    };
    let code = kept::work(open, keeper.parse().unwrap());
    std::process::exit(i32::from(code != std::process::ExitCode::SUCCESS));
}

fn this_test() -> io::Result<Command> {
    let mut command = Command::new(std::env::current_exe()?);
    command.args(["keeping::keeper::tests::be_a_kept_renderer", "--exact", "--nocapture"]);
    command.env(KEEPER, std::process::id().to_string());
    Ok(command)
}

fn setup() -> Setup {
    let screens = Screens { frontend: true, ..Screens::default() };
    Setup { screens, ..setups(1).remove(0) }
}

/// A front-end with a keeper.
struct Bench {
    keeper: Keeper,
    /// Processes that have greeted.
    processes: Vec<u32>,
}

impl Bench {
    fn new() -> Self {
        Self::with(this_test, setup())
    }

    fn with(command: fn() -> io::Result<Command>, setup: Setup) -> Self {
        let keeper = Keeper::with(Box::new(command), Box::new(setup)).unwrap();
        Self { keeper, processes: Vec::new() }
    }

    /// Once it has drawn a frame.
    fn ready(mut self) -> Self {
        assert_eq!(self.next(), FromBackend::Ready(device()));
        self.beat(0);
        self.draws(0);
        self
    }

    fn say(&mut self, message: &FromFrontend) {
        assert_eq!(self.keeper.take(&encode(message).unwrap()), Ok(Taken::PassedOn));
    }

    fn beat(&mut self, index: u32) {
        self.say(&FromFrontend::Beat { frame: Box::new(frame(index)), newest: None });
    }

    /// What the front-end hears next, signs of life apart.
    fn next(&mut self) -> FromBackend {
        let since = Instant::now();
        while since.elapsed() < LIMIT {
            let bytes = self.keeper.next(Duration::from_millis(1));
            match bytes.map(|bytes| decode(&bytes).unwrap()) {
                None | Some(FromBackend::Alive) => {}
                Some(message) => return message,
            }
        }
        panic!("nothing comes");
    }

    /// The process of the present renderer.
    fn process(&self) -> u32 {
        match &self.keeper.state {
            State::Running(child) => child.renderer.process(),
            _ => panic!("there is none"),
        }
    }

    fn signal(&self, signal: Signal) {
        let process = Pid::from_raw(self.process() as i32).unwrap();
        kill_process(process, signal).unwrap();
    }

    /// It says how it was lost, comes back as the front-end sets it up, and draws a frame.
    fn comes_back(&mut self) -> String {
        self.comes_back_after(None)
    }

    /// The same after one that held this.
    fn comes_back_after(&mut self, held: Option<Box<Held>>) -> String {
        let lost = self.next();
        let FromBackend::Lost(why) = lost else { panic!("{lost:?}") };
        // What the front-end said before it knew is not for the new one.
        self.beat(500);
        self.say(&FromFrontend::Clock { asked_us: 3 });
        let greeted = self.next();
        let FromBackend::Hello(hello) = greeted else { panic!("{greeted:?}") };
        assert_eq!(hello.process, self.process());
        assert!(!self.processes.contains(&hello.process));
        self.processes.push(hello.process);
        self.beat(501);
        self.say(&FromFrontend::Setup(Box::new(setup())));
        assert_eq!(self.next(), FromBackend::Ready(device_after(held)));
        self.beat(600);
        self.draws(600);
        why
    }

    fn draws(&mut self, index: u32) {
        let FromBackend::Screen(image) = self.next() else { panic!("no picture") };
        assert!(image.rgb.len() == 3 * 800 * 600 && image.rgb.iter().all(|&code| code == index as u8));
        assert_eq!(self.next(), FromBackend::Drawn(Box::new(report(index, 0))));
    }
}

#[test]
fn messages_and_pictures_pass_both_ways() {
    let mut bench = Bench::new().ready();
    for index in 0..20 {
        bench.beat(index);
        bench.draws(index);
    }
    bench.say(&FromFrontend::Clock { asked_us: 7 });
    let FromBackend::Clock { asked_us: 7, .. } = bench.next() else { panic!("no answer") };
    let process = bench.process();
    let quit = encode(&FromFrontend::Quit).unwrap();
    assert_eq!(bench.keeper.take(&quit), Ok(Taken::Quit));
    let since = Instant::now();
    bench.keeper.part();
    assert!(since.elapsed() < HANGS_AFTER, "it leaves by itself");
    assert_ne!(is_running(process), Some(true));
}

#[test]
fn one_that_ends_in_whatever_way_comes_back() {
    let mut bench = Bench::new().ready();
    bench.signal(Signal::KILL);
    assert!(bench.comes_back().contains("ended by signal 9 (SIGKILL)"));
    for (index, how) in [
        (ABORTS, "ended by signal 6 (SIGABRT)"),
        (EXITS, "ended with exit code 7"),
        (FAILS, "failed: the fake device is lost"),
    ] {
        bench.beat(index);
        let why = bench.comes_back();
        assert!(why.contains(how) && why.contains("its renderer (process "), "{why}");
    }
    // It is the fifth that lives short.
    bench.beat(PANICS);
    let since = Instant::now();
    let why = bench.comes_back();
    assert!(why.contains("it panicked: a fake fault") && why.contains("wait longer and longer"), "{why}");
    assert!(since.elapsed() >= Duration::from_secs(1), "it waited for {:?}", since.elapsed());
}

#[test]
fn one_that_comes_back_knows_what_the_one_before_it_showed() {
    let mut bench = Bench::new().ready();
    let known = Some(Box::new(held()));
    // It is told after a frame, to the keeper alone, and outlives more than one of them.
    std::thread::sleep(Duration::from_millis(100));
    bench.beat(HOLDS);
    bench.draws(HOLDS);
    for _ in 0..2 {
        bench.signal(Signal::KILL);
        bench.comes_back_after(known.clone());
    }
}

#[test]
fn one_that_nobody_listened_to_for_long_is_not_killed() {
    let mut bench = Bench::new().ready();
    // As while the front-end takes a large picture.
    std::thread::sleep(HANGS_AFTER + Duration::from_millis(500));
    let since = Instant::now();
    while since.elapsed() < Duration::from_secs(1) {
        assert_eq!(bench.keeper.next(Duration::from_millis(1)), None, "it is not lost");
    }
}

#[test]
fn one_that_hangs_is_killed_and_comes_back_and_one_that_is_idle_is_not() {
    let mut bench = Bench::new().ready();
    let since = Instant::now();
    while since.elapsed() < HANGS_AFTER + Duration::from_secs(1) {
        assert_eq!(bench.keeper.next(Duration::from_millis(1)), None, "the keeper's questions are its own");
    }
    let (process, since) = (bench.process(), Instant::now());
    bench.signal(Signal::STOP);
    let why = bench.comes_back();
    assert!(why.contains("gave no sign of life for 1.5 s, so it was killed"), "{why}");
    assert!(since.elapsed() < HANGS_AFTER + Duration::from_secs(2), "{:?}", since.elapsed());
    assert_ne!(is_running(process), Some(true));
}

#[test]
fn one_that_draws_no_tile_comes_back_and_one_that_is_slow_is_let_be() {
    let mut bench = Bench::new().ready();
    // Idle for longer than it may be stuck, and asked again.
    let since = Instant::now();
    while since.elapsed() < SLOWLY {
        assert_eq!(bench.keeper.next(Duration::from_millis(1)), None);
    }
    bench.beat(IS_SLOW);
    bench.draws(IS_SLOW);
    bench.beat(IS_STUCK);
    let why = bench.comes_back();
    assert!(why.contains("failed: it has drawn no tile for 2 s"), "{why}");
}

#[test]
fn one_that_cannot_begin_says_why_and_is_not_started_again() {
    let mut broken = setup();
    broken.options.cache_bytes = 0;
    let mut bench = Bench::with(this_test, broken);
    assert_eq!(bench.next(), FromBackend::Failed("there is no such volume".to_owned()));
    assert_eq!(bench.keeper.next(Duration::from_millis(200)), None);
    let [nowhere, dies]: [fn() -> io::Result<Command>; 2] =
        [|| Ok(Command::new("/nowhere/lightloom-backend")), || Ok(Command::new("false"))];
    let mut bench = Bench::with(nowhere, setup());
    let FromBackend::Failed(why) = bench.next() else { panic!("it started") };
    assert!(why.contains("could not be started"), "{why}");
    let mut bench = Bench::with(dies, setup());
    let FromBackend::Failed(why) = bench.next() else { panic!("it started") };
    assert!(why.contains("ended with exit code 1"), "{why}");
    let mut bench = Bench::with(this_test, setup());
    assert_eq!(bench.next(), FromBackend::Ready(device()));
    bench.beat(FAILS);
    assert_eq!(bench.next(), FromBackend::Failed("the fake device is lost".to_owned()));
}

#[test]
fn a_stopped_renderer_ends_with_its_keeper() {
    let bench = Bench::new().ready();
    let process = bench.process();
    bench.signal(Signal::STOP);
    let since = Instant::now();
    bench.keeper.part();
    assert!(since.elapsed() < PARTING + Duration::from_secs(1));
    assert_ne!(is_running(process), Some(true));
}
