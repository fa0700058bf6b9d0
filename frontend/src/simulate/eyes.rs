//! Eyes in front of the display, and what they see while pictures come.

use crate::FrontendError;
use display_config::{Display, EyeModel};
use glam::DVec3;
use protocol::ProjectorImage;
use renderer::output::{EyePlan, EyeView, OutputError, Picture};
use std::sync::{Mutex, MutexGuard, PoisonError};

/// An eye in front of the display.
pub struct Eye {
    /// Where it is, display frame, metres.
    pub position_m: DVec3,
    /// What it sees of which projector.
    pub plan: EyePlan,
    /// A sentence that says so if it is outside the viewing zone.
    pub warning: Option<String>,
}

impl Eye {
    /// The eye at a place, display frame, metres.
    ///
    /// # Errors
    /// A place that is not in front of the screen.
    pub fn before(display: &Display, position_m: DVec3) -> Result<Self, FrontendError> {
        let model = EyeModel::new(display, position_m).map_err(|e| FrontendError::Display(e.to_string()))?;
        let warning = model.outside_zone();
        let weights = move |screen| model.weights(screen);
        let plan = EyePlan::new(display.canonical_raster(), display.projectors.len(), weights);
        Ok(Self { position_m, plan, warning })
    }
}

/// The views of all eyes of one frame while they are made: takes pictures from several threads, in any order.
pub(crate) struct EyeViews<'a> {
    display: &'a Display,
    views: Vec<Mutex<EyeView<'a>>>,
    /// Which projectors' pictures have arrived.
    seen: Mutex<Vec<bool>>,
}

impl<'a> EyeViews<'a> {
    pub fn new(display: &'a Display, eyes: &'a [Eye]) -> Self {
        Self {
            display,
            views: eyes.iter().map(|eye| Mutex::new(EyeView::new(&eye.plan))).collect(),
            seen: Mutex::new(vec![false; display.projectors.len()]),
        }
    }

    /// Adds what a projector of the display shows.
    pub fn add(&self, image: &ProjectorImage) -> Result<(), OutputError> {
        let projector = image.projector as usize;
        let raster = self.display.projectors.get(projector).map(|projector| &projector.raster);
        if let Some(inverse) = raster.and_then(|raster| raster.inverse()) {
            let pixel = |screen| inverse.pixel(screen);
            self.views.iter().try_for_each(|view| hold(view).add_image(image, pixel))?;
        }
        if let Some(seen) = hold(&self.seen).get_mut(projector) {
            *seen = true;
        }
        Ok(())
    }

    /// Once all pictures have arrived: the views, or what is missing.
    pub fn finish(&self, frame: u32) -> Result<Vec<Picture>, FrontendError> {
        let missing: Vec<usize> =
            hold(&self.seen).iter().enumerate().filter(|(_, seen)| !**seen).map(|(p, _)| p).collect();
        if !missing.is_empty() {
            return Err(FrontendError::MissingPictures { frame, missing });
        }
        Ok(self.views.iter().map(|view| hold(view).picture()).collect())
    }
}

/// A lock is only poisoned by a panic, which ends the run anyway.
pub(super) fn hold<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}
