//! A frame's marks in what is shown of its pictures. What rays see of it is not touched: the next frame goes on from that.

use super::engine::Engine;
use super::work::Work;
use crate::device::{DeviceError, ShortJob};
use crate::present::Layers;
use layout::present::Layer;
use needs::Needs;
use overlay::{Fragment, FragmentPlace, View};
use protocol::Mark;
use twin::ShortRay;

impl Engine {
    /// What the marks of a frame lay into the picture of a view.
    pub(super) fn layers(&mut self, work: &Work, view: usize) -> Result<Layers, DeviceError> {
        let mut layers = Layers::default();
        let fragments = self.fragments(work, view);
        let mut before = self.before(work, view, &fragments)?.into_iter();
        for Fragment { pixel, paint, place } in fragments {
            let before = place.and_then(|_| before.next()).unwrap_or_default();
            layers.push(pixel, Layer { before, rgb: paint.rgb, opacity: paint.opacity });
        }
        Ok(layers)
    }

    /// The pixels of a frame's marks in a view.
    fn fragments(&mut self, work: &Work, view: usize) -> Vec<Fragment> {
        let frame = &work.frame;
        if frame.marks.is_empty() {
            return Vec::new();
        }
        let (display, index) = (&self.options.display, work.setting.projectors[view] as usize);
        // A frame whose rays are not its display's was refused before.
        let law = display.beam_law(index, frame.observer_in_display, frame.eta).ok();
        let Some(seen) = law.and_then(|law| View::new(law, &display.projectors[index].raster)) else {
            return Vec::new();
        };
        if frame.debug.is_none() {
            return self.pen.fragments(&frame.marks, &seen);
        }
        // A debug view shows no things that could be before or behind others.
        let through = |mark: &Mark| Mark { is_depth_combined: false, ..mark.clone() };
        self.pen.fragments(&frame.marks.iter().map(through).collect::<Vec<_>>(), &seen)
    }

    /// What the rays of those fragments that have a place meet before it, in their order.
    fn before(
        &mut self,
        work: &Work,
        view: usize,
        fragments: &[Fragment],
    ) -> Result<Vec<[f32; 4]>, DeviceError> {
        let short: Vec<ShortRay> = fragments.iter().filter_map(short_ray).collect();
        if short.is_empty() {
            return Ok(Vec::new());
        }
        let (setting, shelf) = (&work.setting, &self.shelf);
        self.device.cast_short(&ShortJob {
            scene: &setting.scene,
            rays: &setting.own_rays[view],
            needs: Needs { blends: shelf.blends, spreads: shelf.spreads, ..setting.needs },
            short: &short,
        })
    }
}

/// The part of a pixel's ray before a fragment of it.
fn short_ray(fragment: &Fragment) -> Option<ShortRay> {
    let FragmentPlace { ray, distance_m } = fragment.place?;
    // Kernels count from the screen.
    let to_screen_m = -ray.origin_in_display.z / ray.direction_in_display.z;
    Some(ShortRay { pixel: fragment.pixel, end_m: (distance_m - to_screen_m) as f32 })
}
