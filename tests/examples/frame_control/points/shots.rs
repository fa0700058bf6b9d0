//! Still pictures of a scene, on a raster and on a finer one, of the projectors that an eye sees.

use crate::eyes::mean_flip;
use bricks::BrickSource;
use display_config::Display;
use frontend::tune::{Footage, Motion, Scenario};
use lightloom_tests::scenes::{self, TestScene};
use renderer::output::Picture;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

/// Instants of an interaction: at rest, while it is fast, and at the end of its way.
const INSTANTS: [usize; 3] = [0, 48, 174];
const CUT_AT: usize = 48;

/// Some instants of a scene.
pub struct Shots {
    /// The volume.
    pub volume: &'static str,
    /// Rays may go through the middles of so many times as fine a raster, along each axis. It is odd, so that the middles of
    /// pixels are among them.
    parts: u32,
    eye: Footage,
    fine: Footage,
}

/// What a picture errs.
#[derive(Clone, Copy, Debug, Default)]
pub struct Erred {
    /// In linear colour.
    pub rms: f64,
    /// Its mean.
    pub flip: f64,
}

/// What the eye should see.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Truth {
    /// A ray through the middle of each pixel.
    Middles,
    /// The mean of all rays in each pixel.
    Means,
}

impl Shots {
    /// Of all volumes: turned, and the cranium also cut by a plane.
    pub fn of_all(display: &Display, size: [u32; 2], parts: u32, each: usize) -> Result<Vec<Self>, String> {
        let small = display.with_rasters(size[0], size[1]);
        let mut all = vec![scenes::shells(&small), scenes::stored_vessels(&small)];
        let cranium = scenes::cranium(&small);
        all.extend(cranium.clone());
        let turned =
            |scene: &TestScene| Self::new(display, (size, parts), scene, Motion::Turn, &INSTANTS[..each]);
        let mut shots = all.iter().map(turned).collect::<Result<Vec<Self>, String>>()?;
        if let Some(cranium) = cranium {
            shots.push(Self::new(display, (size, parts), &cranium, Motion::Clip, &[CUT_AT])?);
        }
        Ok(shots)
    }

    fn new(
        display: &Display,
        (size, parts): ([u32; 2], u32),
        scene: &TestScene,
        motion: Motion,
        instants: &[usize],
    ) -> Result<Self, String> {
        let all = motion.scenario(scene.name, &scene.frame, display.height_m);
        let states = instants.iter().map(|&instant| all.states[instant].clone()).collect();
        let scenario = Scenario { name: all.name, states };
        let draw = |size| drawn(&scenario, display, size, &scene.source);
        let (eye, fine) = (draw(size)?, draw(size.map(|along| parts * along))?);
        let shots = Self { volume: scene.name, parts, eye, fine };
        eprintln!("{} is drawn at {size:?}: {} views", scenario.name, shots.fine.pictures(0).len());
        Ok(shots)
    }

    /// How many times as fine a raster rays go through.
    pub fn parts(&self) -> u32 {
        self.parts
    }

    /// Instants.
    pub fn count(&self) -> usize {
        self.fine.len()
    }

    /// The fine pictures of an instant.
    pub fn fine(&self, instant: usize) -> impl Iterator<Item = &[f32]> {
        self.fine.pictures(instant).iter().map(|image| &image.rgba[..])
    }

    /// Complete pictures of an instant.
    pub fn complete(&self, instant: usize, truth: Truth) -> Vec<Vec<f32>> {
        let of = |image: &protocol::ProjectorImage| coarse(&image.rgba, image.width, self.parts, truth);
        self.fine.pictures(instant).iter().map(of).collect()
    }

    /// What the eye sees of some pictures.
    pub fn seen(&self, pictures: &[Vec<f32>]) -> Picture {
        self.eye.eye(pictures.iter().map(|picture| &picture[..]))
    }

    /// What is seen, against what should be.
    pub fn judge(&self, seen: &Picture, should: &Picture) -> Erred {
        Erred { rms: self.rms(seen, should), flip: f64::from(mean_flip(&self.eye, seen, should)) }
    }

    /// The same in linear colour alone.
    pub fn rms(&self, seen: &Picture, should: &Picture) -> f64 {
        let colours = seen.rgba.iter().zip(&should.rgba).enumerate().filter(|(at, _)| at % 4 != 3);
        let squares: f64 = colours.map(|(_, (a, b))| f64::from(a - b).powi(2)).sum();
        (squares / (0.75 * seen.rgba.len() as f64)).sqrt()
    }

    /// What an eye sees of the raster drawn by itself, against the same rays of the finer one.
    pub fn apart(&self) -> f64 {
        let seen = |instant: usize| {
            let own: Vec<Vec<f32>> =
                self.eye.pictures(instant).iter().map(|image| image.rgba.clone()).collect();
            self.rms(&self.seen(&own), &self.seen(&self.complete(instant, Truth::Middles)))
        };
        (0..self.count()).map(seen).fold(0.0, f64::max)
    }
}

/// Draws a scenario.
pub fn drawn(
    scenario: &Scenario,
    display: &Display,
    size: [u32; 2],
    source: &Arc<dyn BrickSource>,
) -> Result<Footage, String> {
    let footage = Footage::draw(scenario, display, size, source, &AtomicBool::new(false), &|_| {});
    footage.map_err(|error| error.to_string())?.ok_or_else(|| "nobody stops it".to_owned())
}

/// A picture of a finer one, as wide as given.
fn coarse(fine: &[f32], fine_width: u32, parts: u32, truth: Truth) -> Vec<f32> {
    let (parts, fine_width) = (parts as usize, fine_width as usize);
    let (width, height) = (fine_width / parts, fine.len() / 4 / fine_width / parts);
    let ray = |x: usize, y: usize, i: usize| fine[4 * (y * fine_width + x) + i];
    let pixel = |x: usize, y: usize, i: usize| match truth {
        Truth::Middles => ray(parts * x + parts / 2, parts * y + parts / 2, i),
        Truth::Means => {
            let rays = (0..parts * parts).map(|at| ray(parts * x + at % parts, parts * y + at / parts, i));
            (rays.map(f64::from).sum::<f64>() / (parts * parts) as f64) as f32
        }
    };
    (0..width * height).flat_map(|at| (0..4).map(move |i| pixel(at % width, at / width, i))).collect()
}
