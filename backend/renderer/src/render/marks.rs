//! A frame's marks in what is shown of its pictures. What rays see of it is not touched: the next frame goes on from that.

use super::engine::Engine;
use super::work::Work;
use crate::device::{DeviceError, ShortJob};
use needs::Needs;
use overlay::{Fragment, View};
use protocol::Mark;
use twin::ShortRay;

impl Engine {
    /// Draws the marks of a frame into the picture of a view.
    pub(super) fn mark(&mut self, work: &Work, view: usize, rgba: &mut [f32]) -> Result<(), DeviceError> {
        let frame = &work.frame;
        if frame.marks.is_empty() {
            return Ok(());
        }
        let (display, index) = (&self.options.display, work.setting.projectors[view] as usize);
        // A frame whose rays are not its display's was refused before.
        let law = display.beam_law(index, frame.observer_in_display, frame.eta).ok();
        let Some(seen) = law.and_then(|law| View::new(law, &display.projectors[index].raster)) else {
            return Ok(());
        };
        // A debug view shows no things that could be before or behind others.
        let is_among = |mark: &&Mark| mark.is_depth_combined && frame.debug.is_none();
        let among = self.pen.fragments(frame.marks.iter().filter(is_among), &seen);
        self.combine(work, view, &among, rgba)?;
        self.pen.draw(frame.marks.iter().filter(|mark| !is_among(mark)), &seen, rgba);
        Ok(())
    }

    /// Puts fragments of marks where they belong among what the rays of their pixels meet.
    fn combine(
        &mut self,
        work: &Work,
        view: usize,
        fragments: &[Fragment],
        rgba: &mut [f32],
    ) -> Result<(), DeviceError> {
        if fragments.is_empty() {
            return Ok(());
        }
        let short: Vec<ShortRay> = fragments.iter().map(short_ray).collect();
        let (setting, shelf) = (&work.setting, &self.shelf);
        let before = self.device.cast_short(&ShortJob {
            scene: &setting.scene,
            rays: &setting.own_rays[view],
            needs: Needs { blends: shelf.blends, spreads: shelf.spreads, ..setting.needs },
            short: &short,
        })?;
        for (fragment, before) in fragments.iter().zip(before) {
            fragment.lay_behind(before, &mut rgba[4 * fragment.pixel as usize..][..4]);
        }
        Ok(())
    }
}

/// The part of a pixel's ray before a mark.
fn short_ray(fragment: &Fragment) -> ShortRay {
    let ray = &fragment.ray;
    // Kernels count from the screen.
    let to_screen_m = -ray.origin_in_display.z / ray.direction_in_display.z;
    ShortRay { pixel: fragment.pixel, end_m: (fragment.distance_m - to_screen_m) as f32 }
}
