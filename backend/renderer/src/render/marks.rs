//! A frame's marks in what is shown of its pictures. What rays see of it is not touched: the next frame goes on from that.

use super::engine::Engine;
use super::work::Work;
use crate::device::{DeviceError, ShortJob, ShortView};
use crate::present::Layers;
use layout::present::Layer;
use needs::Needs;
use overlay::{Fragment, FragmentPlace, View};
use protocol::Mark;
use twin::ShortRay;

impl Engine {
    /// What the marks of a frame lay into the pictures of some views.
    pub(super) fn layers(
        &mut self,
        work: &Work,
        views: impl Iterator<Item = usize> + Clone,
    ) -> Result<Vec<Layers>, DeviceError> {
        let fragments: Vec<Vec<Fragment>> = views.clone().map(|view| self.fragments(work, view)).collect();
        let before = self.before(work, views.zip(&fragments))?;
        let layers = fragments.into_iter().zip(before).map(|(fragments, before)| {
            let mut layers = Layers::default();
            let mut before = before.into_iter();
            for Fragment { pixel, paint, place } in fragments {
                let before = place.and_then(|_| before.next()).unwrap_or_default();
                layers.push(pixel, Layer { before, rgb: paint.rgb, opacity: paint.opacity });
            }
            layers
        });
        Ok(layers.collect())
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

    /// What the rays of those fragments that have a place meet before it, view by view in their order.
    fn before<'a>(
        &mut self,
        work: &Work,
        fragments: impl Iterator<Item = (usize, &'a Vec<Fragment>)>,
    ) -> Result<Vec<Vec<[f32; 4]>>, DeviceError> {
        let (setting, shelf) = (&work.setting, &self.shelf);
        let views: Vec<ShortView> = fragments
            .map(|(view, fragments)| ShortView {
                rays: &setting.own_rays[view],
                short: fragments.iter().filter_map(short_ray).collect(),
            })
            .collect();
        if views.iter().all(|view| view.short.is_empty()) {
            return Ok(vec![Vec::new(); views.len()]);
        }
        self.device.cast_short(&ShortJob {
            scene: &setting.scene,
            needs: Needs { blends: shelf.blends, spreads: shelf.spreads, ..setting.needs },
            views: &views,
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
