//! The cut that a picture would ask for if nothing hid anything: what visibility feedback is measured against.

use bricks::LodRule;
use bricks::is_shown;
use bricks::{BrickSource, NodeKey};
use display_config::{BeamLaw, Clip, Display, Raster};
use glam::{DVec2, DVec3};
use protocol::FrameState;

/// The bricks of an ideal cut.
#[derive(Clone, Debug)]
pub struct IdealCut {
    /// Its leaves that are not empty and lie within a view.
    pub leaves: Vec<NodeKey>,
    /// Bricks that a cache would hold for it: the root's, and those of all children, seen or not, of what is split.
    pub held: usize,
}

/// Where one projector looks.
struct Sight {
    law: BeamLaw,
    /// Corners of its picture's bounding box on the screen.
    low: DVec2,
    high: DVec2,
}

impl Sight {
    fn new(display: &Display, projector: u32, frame: &FrameState) -> Self {
        let law = display
            .beam_law(projector as usize, frame.observer_in_display, frame.eta)
            .expect("a test scene goes with its display");
        let raster: &Raster = &display.projectors[projector as usize].raster;
        let corners = raster.corners_on_screen();
        let low = corners.into_iter().fold(DVec2::INFINITY, DVec2::min);
        let high = corners.into_iter().fold(DVec2::NEG_INFINITY, DVec2::max);
        Self { law, low, high }
    }

    /// Whether a ray may meet a box: whether the bounds of its corners on the screen overlap the picture. Screen x depends
    /// on x and z alone and screen y on y and z alone, each as a perspective does, so the corners bound the image of the
    /// box in each; a box that lies across a corner of the picture may be counted though no ray meets it.
    fn meets(&self, corners: &[DVec3; 8]) -> bool {
        let (mut low, mut high) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
        for &corner in corners {
            match self.law.screen_from_point(corner) {
                Ok(screen) => (low, high) = (low.min(screen), high.max(screen)),
                // A box across the observer's plane has no bounds on the screen.
                Err(Clip::BehindObserver | Clip::NoImage | Clip::NotFinite) => return true,
            }
        }
        low.cmple(self.high).all() && high.cmpge(self.low).all()
    }
}

/// The cut for some projectors of a display: split wherever the rule of detail asks for it, whether rays get there or
/// something is in their way.
pub fn ideal_cut(
    source: &dyn BrickSource,
    display: &Display,
    frame: &FrameState,
    projectors: &[u32],
) -> IdealCut {
    let shape = source.shape();
    let rule = LodRule::new(display, frame.display_from_volume, frame.quality.lod_scale);
    let sights: Vec<Sight> = projectors.iter().map(|&p| Sight::new(display, p, frame)).collect();
    let is_wanted = |key: &NodeKey| shape.contains(*key) && is_shown(&frame.optics, source.summary(*key));
    let is_in_view = |key| {
        let corners = shape.corners(key).map(|corner| frame.display_from_volume.transform_point3(corner));
        sights.iter().any(|sight| sight.meets(&corners))
    };
    let mut found = IdealCut { leaves: Vec::new(), held: 0 };
    let mut open: Vec<NodeKey> = std::iter::once(NodeKey::ROOT).filter(is_wanted).collect();
    while let Some(key) = open.pop() {
        found.held += 1;
        if !is_in_view(key) {
            continue;
        }
        if rule.is_fine_enough(&shape, key) {
            found.leaves.push(key);
        } else {
            open.extend((0..8).map(|octant| key.child(octant)).filter(is_wanted));
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::draw::{self, With};
    use crate::scenes::{self, scaled};
    use protocol::DeviceChoice;

    /// Rays sample no brick that the ideal cut lacks, and nearly all that it has where nothing hides anything.
    #[test]
    fn what_rays_sample_lies_in_the_ideal_cut() {
        let _turn = draw::turn();
        let display = Display::load("desk8").unwrap().with_rasters(128, 96);
        let mut scene = scenes::shells(&display);
        scene.frame.optics.extinction = scaled(&scene.frame.optics.extinction, 1e-6);
        let ideal = ideal_cut(&*scene.source, &display, &scene.frame, &[2]);
        let with = With::device(DeviceChoice::Cpu);
        let drawn = draw::draw(&display, &scene.frame, &scene.source, &[2], with);
        let (sampled, all) = (drawn.report.working_set_union as usize, ideal.leaves.len());
        assert!(sampled <= all && 10 * sampled >= 8 * all, "{sampled} of {all}");
        let resident = drawn.report.bricks_resident as usize;
        assert!(resident <= ideal.held, "{resident} of {}", ideal.held);
    }

    #[test]
    fn what_lies_beside_the_picture_is_not_in_it() {
        let display = Display::load("holo72").unwrap();
        let mut scene = scenes::shells(&display);
        let whole = ideal_cut(&*scene.source, &display, &scene.frame, &[36]).leaves.len();
        scene.frame.display_from_volume.translation.x += 0.5 * display.width_m;
        let half = ideal_cut(&*scene.source, &display, &scene.frame, &[36]).leaves.len();
        assert!(half < whole && 3 * half > whole, "{half} of {whole}");
        scene.frame.display_from_volume.translation.x += display.width_m;
        assert!(ideal_cut(&*scene.source, &display, &scene.frame, &[36]).leaves.is_empty());
    }
}
