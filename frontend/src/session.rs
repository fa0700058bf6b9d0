//! Where the front-end meets what it drives: displays, volumes, importers and back-ends.
//!
//! Everything that the commands need from elsewhere passes through this file and no other.

use crate::FrontendError;
use crate::cli::ImportArgs;
use crate::progress::Progress;
use crate::scene::VolumeFacts;
use crate::simulate::FrameSource;
use backend::protocol::{DeviceInfo, Setup, VolumeRef};
use display_config::Display;
use glam::{DVec2, DVec3, UVec3};
use serde::Serialize;

/// The displays that come with the program: name, and a line about each.
pub fn preset_displays() -> Result<Vec<(String, String)>, FrontendError> {
    Err(FrontendError::Display("no preset display is built in yet".to_owned()))
}

/// A preset by its name, or the display in a file.
pub fn load_display(name_or_path: &str) -> Result<Display, FrontendError> {
    Err(FrontendError::Display(format!("cannot load the display {name_or_path}: no reader is built in yet")))
}

/// What an eye sees of a display, before any picture is drawn.
pub struct EyeOptics {
    /// (projector, weight) pairs at a screen point, metres; they add to 1 where there are any.
    pub weights: Box<dyn Fn(DVec2) -> Vec<(usize, f64)>>,
    /// Where the eye is outside the viewing zone: a sentence that says so.
    pub warning: Option<String>,
}

/// The optics of an eye, metres in the display frame.
pub fn eye_optics(display: &Display, eye_m: DVec3) -> Result<EyeOptics, FrontendError> {
    let _ = (display, eye_m);
    Err(FrontendError::Display("no eye model is built in yet".to_owned()))
}

/// A map from screen metres to a projector's pixel coordinates; None where the raster is singular.
pub fn pixel_from_screen(
    display: &Display,
    projector: usize,
) -> Option<impl Fn(DVec2) -> Option<DVec2> + use<>> {
    let forward = display.projectors.get(projector)?.raster.screen_from_pixel.0;
    let inverse = forward.inverse();
    inverse.is_finite().then_some(move |screen: DVec2| {
        let pixel = inverse * screen.extend(1.0);
        let place = pixel.truncate() / pixel.z;
        place.is_finite().then_some(place)
    })
}

/// Opens a volume just to learn what it is.
pub fn volume_facts(volume: &VolumeRef) -> Result<VolumeFacts, FrontendError> {
    Err(FrontendError::Volume(format!("cannot open {volume:?}: no volume is built in yet")))
}

/// Back-ends that run and wait to be set up.
pub struct Backends {
    count: u32,
}

impl Backends {
    /// Finds the back-ends that a launcher started, or starts `asked` of them (1 where it is None) in this process.
    pub fn connect(asked: Option<u32>) -> Result<Self, FrontendError> {
        Ok(Self { count: asked.unwrap_or(1) })
    }

    /// How many there are.
    pub fn count(&self) -> u32 {
        self.count
    }

    /// Sets them up, one with each setup, and gives what draws frames with them.
    pub fn start(self, setups: Vec<Setup>) -> Result<(Box<dyn FrameSource>, Vec<DeviceInfo>), FrontendError> {
        let _ = setups;
        Err(FrontendError::Backend("no renderer is built in yet".to_owned()))
    }
}

/// What an import did.
#[derive(Clone, Debug, Serialize)]
pub struct ImportSummary {
    /// Voxels along each axis.
    pub dims: UVec3,
    /// Bytes of the source's voxels.
    pub source_bytes: u64,
    /// Bytes of the store.
    pub store_bytes: u64,
    /// Bricks that hold anything.
    pub stored_bricks: u64,
    /// Smallest and largest value.
    pub value_range: (f64, f64),
    /// Root mean square of the store's error, data units.
    pub rms_error: f64,
    /// Largest error, data units.
    pub max_error: f64,
    /// Voxels that were not finite, and were replaced.
    pub non_finite: u64,
    /// Time it took, milliseconds.
    pub total_ms: f64,
}

/// Makes a store from a volume file.
pub fn import(args: &ImportArgs, progress: Progress) -> Result<ImportSummary, FrontendError> {
    let _ = progress;
    Err(FrontendError::Volume(format!("cannot import {}: no reader is built in yet", args.input.display())))
}

/// Which projectors each of `backends` back-ends drives: shares as even as can be, neighbours together.
pub fn assignment(display: &Display, backends: u32) -> Result<Vec<Vec<u32>>, FrontendError> {
    let count = display.projectors.len() as u32;
    if !(1..=count).contains(&backends) {
        return Err(FrontendError::Display(format!(
            "cannot share the {count} projectors of {} among {backends} back-ends; give --backends from 1 to {count}",
            display.name
        )));
    }
    let end = |backend: u32| (u64::from(count) * u64::from(backend) / u64::from(backends)) as u32;
    Ok((0..backends).map(|backend| (end(backend)..end(backend + 1)).collect()).collect())
}
