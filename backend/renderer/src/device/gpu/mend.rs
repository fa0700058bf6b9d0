//! Pixels that cannot be resampled well from what planes have cast, on the GPU: each gets a ray of its own.

use super::cast_short::AT_A_TIME;
use super::device::GpuDevice;
use crate::device::job::ViewJob;
use crate::device::mend::{bends_of, pixels_near};
use crate::device::{CastJob, CastOutcome, DeviceError, DevicePicture, ShortView};
use crate::present::Bends;
use layout::{CUT, MISSING};
use planes::Fans;
use std::sync::Arc;
use twin::ShortRay;

impl GpuDevice {
    /// Mends pictures of the fans' views, as far as the job's `stop` allows.
    pub(super) fn mend(&mut self, job: &CastJob, fans: &Fans) -> Result<CastOutcome, DeviceError> {
        let context = Arc::clone(&self.context);
        let mut outcome = CastOutcome::nothing(job);
        for (index, view) in job.view_jobs() {
            let Some(warp) = fans.warp(index) else { continue };
            // Looking for bends goes through all of the picture.
            if (job.stop)() {
                outcome.left[index] = view.tiles.into_owned();
                continue;
            }
            for picture in self.pictures.read(&context, &[DevicePicture::Cast(view.picture)])? {
                let bends = bends_of(&picture, warp, job.scene);
                self.mend_view(job, (index, &view), &bends, &mut outcome)?;
            }
        }
        let rays = outcome.mended.iter().map(|patch| patch.len() as u64).sum();
        let outcome = self.bring_back(job, &[], outcome)?;
        Ok(CastOutcome { rays, ..outcome })
    }

    fn mend_view(
        &mut self,
        job: &CastJob,
        (index, view): (usize, &ViewJob),
        bends: &Bends,
        outcome: &mut CastOutcome,
    ) -> Result<(), DeviceError> {
        let mut tiles = view.tiles.iter().peekable();
        while tiles.peek().is_some() && !(job.stop)() {
            let mut of_tiles = Vec::new();
            let mut short = Vec::new();
            while short.len() < AT_A_TIME
                && let Some(tile) = tiles.next()
            {
                let pixels = pixels_near(view, bends, tile);
                of_tiles.push((tile, pixels.len()));
                short.extend(pixels.iter().map(|(x, y)| ShortRay::whole(y * view.rays.raster[0] + x)));
            }
            let list = ShortView { rays: view.rays, short };
            let (colours, counts) =
                self.cast_listed(job.needs, &[(&list, 0..list.short.len())], job.gather)?;
            outcome.cut += counts.iter().filter(|&count| count & CUT != 0).count() as u64;
            outcome.mended[index].extend(list.short.iter().map(|ray| ray.pixel).zip(colours));
            let mut counts = counts.as_slice();
            for (tile, rays) in of_tiles {
                let own = counts.split_off(..rays).expect("each ray has one");
                if job.counts && own.iter().any(|count| count & MISSING != 0) {
                    outcome.missing_tiles[index].push(tile);
                }
            }
        }
        outcome.left[index].extend(tiles);
        Ok(())
    }
}
