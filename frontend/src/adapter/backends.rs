//! The back-ends of a run.

use super::trace;
use crate::FrontendError;
use backend::open_renderer;
use display_config::{Display, Wiring};
use protocol::{
    AdapterWish, DeviceChoice, DeviceInfo, Draw, FilterChoice, RendererOptions, Setup, VolumeRef,
};
use std::path::PathBuf;
use transport::{Launch, Limits, Link, Session, launch, threads};

/// What back-ends draw with.
#[derive(Clone, Debug, PartialEq)]
pub struct BackendOptions {
    /// The device.
    pub device: DeviceChoice,
    /// The interpolation.
    pub filter: FilterChoice,
    /// Size of each brick cache, bytes.
    pub cache_bytes: u64,
    /// The folder for traces of live frames; None where none are wanted.
    pub traces: Option<PathBuf>,
}

/// Back-ends that run and wait to be set up.
pub struct Backends {
    link: Box<dyn Link>,
}

impl Backends {
    /// Finds the back-ends that a launcher started, or starts `asked` of them (1 where it is None) in this process.
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

    /// What each of them drives.
    ///
    /// # Errors
    /// There are more than the display has projectors.
    pub fn wiring(&self, display: &Display) -> Result<Wiring, FrontendError> {
        display.wiring(self.link.backends()).map_err(|e| FrontendError::Display(e.to_string()))
    }

    /// Sets them up as they are wired, and gives what draws frames with them.
    pub fn start(
        self,
        options: &BackendOptions,
        volume: &VolumeRef,
        display: &Display,
        wiring: &Wiring,
    ) -> Result<(Box<dyn Draw>, Vec<DeviceInfo>), FrontendError> {
        let setups = wiring.shares.iter().zip(0..).map(|(share, backend)| Setup {
            options: RendererOptions {
                display: display.clone(),
                projectors: share.projectors.clone(),
                backend,
                device: options.device,
                adapter: AdapterWish { turn: backend, name: share.adapter.clone() },
                filter: options.filter,
                cache_bytes: options.cache_bytes,
            },
            volume: volume.clone(),
            trace: options.traces.as_deref().map(|folder| trace::path(folder, backend)),
        });
        let setups = setups.collect();
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
