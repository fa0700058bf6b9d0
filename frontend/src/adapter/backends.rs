//! The back-ends of a run.

use super::trace;
use crate::{FrontendError, interrupt};
use backend::open_renderer;
use display_config::{Display, Wiring};
use protocol::{
    AdapterWish, CasterChoice, DeviceChoice, DeviceInfo, Draw, FilterChoice, RendererOptions, Screens, Setup,
    VolumeRef,
};
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use std::time::Duration;
use transport::beat::{Drive, Time};
use transport::{Launch, Limits, Link, Session, launch, threads, under_mpi};

/// What back-ends draw with.
#[derive(Clone, Debug, PartialEq)]
pub struct BackendOptions {
    /// The device.
    pub device: DeviceChoice,
    /// The interpolation.
    pub filter: FilterChoice,
    /// The caster.
    pub caster: CasterChoice,
    /// Size of each brick cache, bytes.
    pub cache_bytes: u64,
    /// The folder for traces of live frames; None where none are wanted.
    pub traces: Option<PathBuf>,
}

/// How a display is driven.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Showing {
    /// From frame to frame, at best.
    pub period: Duration,
    /// The clock.
    pub time: Time,
    /// Where the pictures go.
    pub at: Screens,
}

/// Back-ends that run and wait to be set up.
pub struct Backends {
    link: Box<dyn Link>,
    /// What each of them drives.
    pub wiring: Wiring,
    stop: Arc<AtomicBool>,
}

/// Back-ends that are set up.
pub struct Drawing {
    /// What draws frames with them.
    pub source: Box<dyn Draw>,
    /// What each of them draws with.
    pub devices: Vec<DeviceInfo>,
    /// True once somebody asks the program to end.
    pub stop: Arc<AtomicBool>,
}

impl Backends {
    /// Finds the back-ends that a launcher started, or starts `asked` of them (1 where it is None) in this process, and
    /// shares the projectors of `display` among them.
    ///
    /// # Errors
    /// There are more than the display has projectors.
    pub fn connect(asked: Option<u32>, display: &Display) -> Result<Self, FrontendError> {
        let wiring = |count| display.wiring(count).map_err(|e| FrontendError::Display(e.to_string()));
        match launch().map_err(FrontendError::Backend)? {
            Launch::OneProcess => {
                let wiring = wiring(asked.unwrap_or(1) as usize)?;
                let link = threads::spawn(wiring.shares.len(), open_renderer)
                    .map_err(|e| FrontendError::Backend(e.to_string()))?;
                Ok(Self { link: Box::new(link), wiring, stop: interrupt::stop_flag()? })
            }
            // There the signals are the launcher's, which tells every rank.
            Launch::Cluster => {
                let link = cluster_link()?;
                let wiring = wiring(link.backends())?;
                Ok(Self { link, wiring, stop: Arc::default() })
            }
        }
    }

    /// Sets them up as they are wired.
    pub fn start(
        self,
        options: &BackendOptions,
        volume: &VolumeRef,
        display: &Display,
    ) -> Result<Drawing, FrontendError> {
        // Whole frames come as they are drawn: back-ends finish none of them.
        let setups = self.setups(options, volume, &display.with_finishes_of(&[]), None);
        let stop = Arc::clone(&self.stop);
        let session = self.session(setups)?;
        let devices = session.devices().to_vec();
        Ok(Drawing { source: Box::new(session), devices, stop })
    }

    /// Sets them up as they are wired, to drive the display.
    pub fn drive(
        self,
        options: &BackendOptions,
        volume: &VolumeRef,
        display: &Display,
        showing: &Showing,
    ) -> Result<Drive, FrontendError> {
        let setups = self.setups(options, volume, display, Some(showing.at));
        let session = self.session(setups.clone())?;
        Ok(Drive::new(session, setups, showing.period, showing.time))
    }

    /// What each is set up with; `shown_at` says where the pictures of a show go, and is None where there is none.
    fn setups(
        &self,
        options: &BackendOptions,
        volume: &VolumeRef,
        display: &Display,
        shown_at: Option<Screens>,
    ) -> Vec<Setup> {
        let setups = self.wiring.shares.iter().zip(0..).map(|(share, backend)| Setup {
            options: RendererOptions {
                display: display.with_finishes_of(&share.projectors),
                projectors: share.projectors.clone(),
                backend,
                device: options.device,
                adapter: AdapterWish { turn: backend, name: share.adapter.clone() },
                filter: options.filter,
                caster: options.caster,
                cache_bytes: options.cache_bytes,
            },
            volume: volume.clone(),
            trace: options.traces.as_deref().map(|folder| trace::path(folder, backend)),
            screens: shown_at.unwrap_or_default(),
            is_kept: shown_at.is_some(),
            held: None,
        });
        setups.collect()
    }

    fn session(self, setups: Vec<Setup>) -> Result<Session, FrontendError> {
        let session = Session::start(self.link, setups, Limits::default(), Arc::clone(&self.stop));
        session.map_err(|error| interrupt::or_stopped(error.into(), &self.stop))
    }
}

impl Drawing {
    /// Completes what back-ends write, once `work` has been done with them or was stopped.
    ///
    /// # Errors
    /// That of the work, or what is written cannot be completed.
    pub fn finish<T>(&mut self, work: Result<T, FrontendError>) -> Result<T, FrontendError> {
        let work = work.map_err(|error| interrupt::or_stopped(error, &self.stop));
        // Back-ends that failed cannot be asked for anything any more.
        let finished = if let Err(FrontendError::Backend(_)) = work { Ok(()) } else { self.source.finish() };
        match (work, finished) {
            (Err(FrontendError::Stopped(why)), Err(error)) => {
                Err(FrontendError::Stopped(format!("{why}; {error}")))
            }
            (Err(error), _) => Err(error),
            (Ok(done), finished) => finished.map(|()| done).map_err(FrontendError::from),
        }
    }
}

/// Lets the back-ends go that a launcher started, if it did: for work that needs none.
pub fn dismiss_backends() -> Result<(), FrontendError> {
    if !under_mpi() || cfg!(not(feature = "mpi")) {
        return Ok(());
    }
    Ok(Session::dismiss(cluster_link()?, Limits::default())?)
}

#[cfg(feature = "mpi")]
fn cluster_link() -> Result<Box<dyn Link>, FrontendError> {
    let link = transport::cluster::connect().map_err(|e| FrontendError::Backend(e.to_string()))?;
    Ok(Box::new(link))
}

#[cfg(not(feature = "mpi"))]
fn cluster_link() -> Result<Box<dyn Link>, FrontendError> {
    Err(FrontendError::Backend(
        "this lightloom was built without MPI; build it with `--features mpi`".to_owned(),
    ))
}
