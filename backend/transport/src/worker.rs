//! The loop of a back-end.

use super::link::{LinkError, WorkerLink};
use super::process;
use protocol::{
    DeviceInfo, Draw, FrameState, FromBackend, FromFrontend, Hello, PROTOCOL_VERSION, RenderEvent, Setup,
};
use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::time::{Duration, Instant};

/// An opened renderer and what it draws with.
pub type Opened = (Box<dyn Draw>, DeviceInfo);

/// Why a back-end stopped before it was asked to.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum WorkerError {
    /// The front-end cannot be reached.
    #[error(transparent)]
    Link(#[from] LinkError),
    /// The front-end has said nothing for too long.
    #[error("the front-end has said nothing for {0} s, so this back-end ends; look there for the cause")]
    FrontendSilent(u64),
    /// It could not go on, and said so to the front-end, which shows the sentence.
    #[error("{0}")]
    Failed(String),
}

/// Progress is sent at most this often; the renderer may report each tile.
const PROGRESS_INTERVAL: Duration = Duration::from_millis(100);

/// How long a failed back-end stays so that the front-end can read why. If it left at once, the launcher could end the
/// job before the sentence is shown.
const LAST_WORDS: Duration = Duration::from_secs(5);

/// Serves one front-end until it says Quit. `make` opens the renderer once the setup is known. Errors and panics of
/// the renderer reach the front-end as one sentence.
pub fn serve<M>(link: &mut dyn WorkerLink, make: M) -> Result<(), WorkerError>
where
    M: FnOnce(Setup) -> Result<Opened, String>,
{
    link.send(FromBackend::Hello(Hello {
        protocol: PROTOCOL_VERSION,
        host: process::host(),
        process: std::process::id(),
    }))?;
    let mut make = Some(make);
    let mut renderer = None;
    loop {
        match (next(link)?, &mut renderer) {
            (FromFrontend::Alive, _) => {}
            (FromFrontend::Quit, _) => return Ok(()),
            (FromFrontend::Setup(setup), None) => {
                let Some(make) = make.take() else { return fail(link, "it was set up twice".to_owned()) };
                match guarded(|| make(*setup)) {
                    Ok((opened, info)) => {
                        renderer = Some(opened);
                        link.send(FromBackend::Ready(info))?;
                    }
                    Err(sentence) => return fail(link, sentence),
                }
            }
            (FromFrontend::Frame(frame), Some(renderer)) => draw_frame(link, renderer.as_mut(), &frame)?,
            (FromFrontend::Finish, Some(renderer)) => match guarded(|| renderer.finish()) {
                Ok(()) => link.send(FromBackend::Finished)?,
                Err(sentence) => return fail(link, sentence),
            },
            (FromFrontend::Finish, None) => return fail(link, "its end came before the setup".to_owned()),
            (FromFrontend::Setup(_), Some(_)) => return fail(link, "it was set up twice".to_owned()),
            (FromFrontend::Frame(_), None) => return fail(link, "a frame came before the setup".to_owned()),
        }
    }
}

fn next(link: &mut dyn WorkerLink) -> Result<FromFrontend, WorkerError> {
    let silence = link.frontend_silence();
    link.receive(silence).map_err(|error| match error {
        LinkError::Silent => WorkerError::FrontendSilent(silence.as_secs()),
        error => error.into(),
    })
}

fn draw_frame(
    link: &mut dyn WorkerLink,
    renderer: &mut dyn Draw,
    frame: &FrameState,
) -> Result<(), WorkerError> {
    let mut sending = Ok(());
    let mut last_progress: Option<Instant> = None;
    let mut sink = |event| {
        if sending.is_err() {
            return;
        }
        sending = match event {
            RenderEvent::Image(image) => link.send(FromBackend::Image(image)),
            RenderEvent::Progress { done, total } => {
                if done < total && last_progress.is_some_and(|at| at.elapsed() < PROGRESS_INTERVAL) {
                    return;
                }
                last_progress = Some(Instant::now());
                link.send(FromBackend::Progress { done, total })
            }
        };
    };
    let drawn = guarded(|| renderer.draw(frame, &mut sink));
    sending?;
    match drawn {
        Ok(report) => Ok(link.send(FromBackend::Done(Box::new(report)))?),
        Err(sentence) => fail(link, sentence),
    }
}

/// Sends the front-end the reason why this back-end ends, and gives it time to print it.
fn fail(link: &mut dyn WorkerLink, sentence: String) -> Result<(), WorkerError> {
    link.send(FromBackend::Failed(sentence.clone()))?;
    let since = Instant::now();
    while let Some(left) = LAST_WORDS.checked_sub(since.elapsed()) {
        match link.receive(left) {
            Ok(FromFrontend::Quit) | Err(_) => break,
            Ok(_) => {}
        }
    }
    Err(WorkerError::Failed(sentence))
}

/// The result of `work`, with a panic turned into a sentence.
fn guarded<T>(work: impl FnOnce() -> Result<T, String>) -> Result<T, String> {
    catch_unwind(AssertUnwindSafe(work)).unwrap_or_else(|panic| Err(panic_sentence(panic.as_ref())))
}

/// What a panic says, as a sentence.
pub(super) fn panic_sentence(panic: &(dyn Any + Send)) -> String {
    let text = panic.downcast_ref::<&str>().copied();
    let text = text.or_else(|| panic.downcast_ref::<String>().map(String::as_str)).unwrap_or("no message");
    format!("it panicked: {text}; this is a fault in lightloom, please report it with this line")
}
