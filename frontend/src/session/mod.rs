//! Where the front-end meets what it drives: displays, volumes, importers and back-ends.
//!
//! The commands reach readers, stores and back-ends through here.

mod import;
mod levels;
mod store;

pub use import::{ImportSummary, import};
pub use levels::LevelSummary;
pub use store::{StoreSummary, VerifySummary, store_summary, verify};

mod export;
mod replay;
mod trace;

pub use export::{ExportSummary, export};
pub use replay::{ReplayRow, Traces};
pub use trace::prepare_traces;

use crate::FrontendError;
use crate::cli::BackendArgs;
use crate::scene::VolumeFacts;
use crate::simulate::{Event, FrameSource};
use backend::open_renderer;
use bricks::BrickSource;
use display_config::{Display, EyeModel};
use glam::{DVec2, DVec3};
use protocol::{DeviceInfo, FrameReport, FrameState, Setup, VolumeRef};
use std::path::Path;
use std::sync::Arc;
use transport::{EventKind, Launch, Limits, Link, Session, launch, threads};

/// The displays that come with the program: name, and a line about each.
pub fn preset_displays() -> Result<Vec<(String, String)>, FrontendError> {
    let about = |name: &str| {
        let display = load_display(name)?;
        let (count, (w, h)) = (display.projectors.len(), (display.width_m, display.height_m));
        Ok((name.to_owned(), format!("{count} projectors on a screen of {w:.2} × {h:.2} m")))
    };
    display_config::presets().iter().map(|(name, _)| about(name)).collect()
}

/// A preset by its name, or the display in a file.
pub fn load_display(name_or_path: &str) -> Result<Display, FrontendError> {
    Display::load(name_or_path).map_err(|e| FrontendError::Display(e.to_string()))
}

/// What an eye sees of a display, before any picture is drawn.
pub struct EyeOptics {
    /// (projector, weight) pairs at a screen point, metres; they add to 1 if there are any.
    pub weights: Box<dyn Fn(DVec2) -> Vec<(usize, f64)>>,
    /// A sentence that says so if the eye is outside the viewing zone.
    pub warning: Option<String>,
}

/// The optics of an eye, metres in the display frame.
pub fn eye_optics(display: &Display, eye_m: DVec3) -> Result<EyeOptics, FrontendError> {
    let model = EyeModel::new(display, eye_m).map_err(|e| FrontendError::Display(e.to_string()))?;
    let warning = model.outside_zone();
    Ok(EyeOptics { weights: Box::new(move |screen| model.weights(screen)), warning })
}

/// A map from screen metres to a projector's pixel coordinates; None if the raster is singular.
pub fn pixel_from_screen(
    display: &Display,
    projector: usize,
) -> Option<impl Fn(DVec2) -> Option<DVec2> + use<>> {
    let inverse = display.projectors.get(projector)?.raster.inverse()?;
    Some(move |screen| inverse.pixel(screen))
}

/// Opens a volume just to learn what it is.
pub fn volume_facts(volume: &VolumeRef) -> Result<VolumeFacts, FrontendError> {
    Ok(VolumeFacts::of(open_volume(volume)?.as_ref()))
}

/// Opens a volume for work in this process.
pub fn open_volume(volume: &VolumeRef) -> Result<Arc<dyn BrickSource>, FrontendError> {
    backend::open_volume(volume).map_err(FrontendError::Volume)
}

/// Back-ends that run and wait to be set up.
pub struct Backends {
    link: Box<dyn Link>,
}

impl Backends {
    /// Finds the back-ends that a launcher started, or starts `asked` of them (1 if it is None) in this process.
    pub fn connect(asked: Option<u32>) -> Result<Self, FrontendError> {
        let link = match launch().map_err(FrontendError::Backend)? {
            Launch::OneProcess => Box::new(
                threads::spawn(asked.unwrap_or(1) as usize, open_renderer)
                    .map_err(|e| FrontendError::Backend(e.to_string()))?,
            ),
            Launch::Cluster => cluster_link()?,
        };
        Ok(Self { link })
    }

    /// How many there are.
    pub fn count(&self) -> u32 {
        self.link.backends() as u32
    }

    /// Sets them up, one with each setup, and gives what draws frames with them.
    pub fn start(self, setups: Vec<Setup>) -> Result<(Box<dyn FrameSource>, Vec<DeviceInfo>), FrontendError> {
        let session = Session::start(self.link, setups, Limits::default());
        let session = session.map_err(|e| FrontendError::Backend(e.to_string()))?;
        let devices = session.devices().to_vec();
        Ok((Box::new(session), devices))
    }
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

impl FrameSource for Session {
    fn render(
        &mut self,
        frame: &FrameState,
        on_event: &mut dyn FnMut(Event),
    ) -> Result<Vec<FrameReport>, FrontendError> {
        let reports = Session::render(self, frame, &mut |event| {
            on_event(match event.kind {
                EventKind::Progress { done, total } => {
                    Event::Progress { backend: event.backend, done, total }
                }
                EventKind::Image(image) => Event::Image(image),
            });
        });
        reports.map_err(|e| FrontendError::Backend(e.to_string()))
    }

    fn finish(self: Box<Self>) -> Result<(), FrontendError> {
        Session::finish(*self).map_err(|e| FrontendError::Backend(e.to_string()))
    }
}

/// Which projectors each of `backends` back-ends drives: shares as even as can be, neighbours together.
pub fn assignment(display: &Display, backends: u32) -> Result<Vec<Vec<u32>>, FrontendError> {
    display.assign(backends as usize).map_err(|e| FrontendError::Display(e.to_string()))
}

/// The setup of each of `backends` back-ends, sent before the first frame; `traces` is the folder for their traces.
pub fn setups(
    args: &BackendArgs,
    volume: &VolumeRef,
    display: &Display,
    backends: u32,
    traces: Option<&Path>,
) -> Result<Vec<Setup>, FrontendError> {
    let setup = |(projectors, backend)| Setup {
        display: display.clone(),
        projectors,
        backend,
        volume: volume.clone(),
        device: args.device.into(),
        filter: args.filter.into(),
        cache_bytes: args.cache_mib << 20,
        trace: traces.map(|folder| trace::path(folder, backend)),
    };
    Ok(assignment(display, backends)?.into_iter().zip(0..).map(setup).collect())
}
