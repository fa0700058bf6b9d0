//! Parts of the way to a picture: what is cast of it, what is shown of it, and how far the newest state is from it.

use super::RenderError;
use super::account::{Account, milliseconds};
use super::complete::Complete;
use super::engine::Engine;
use super::refining::FewPixels;
use super::rules::FrameRules;
use super::setting::Setting;
use super::work::{Pending, Work};
use crate::device::{CastJob, DeviceError, DevicePicture, Gather, NEVER, Part};
use crate::refine::{Filled, Grain, Order, change_at, fill, sparse};
use crate::working_set::Moment;
use needs::Needs;
use protocol::{FrameState, Pace, Refined, Refinement, Stages};
use rayon::prelude::*;
use std::ops::Range;
use std::sync::Arc;
use std::time::Instant;

impl Engine {
    /// What units cast of each view, one lattice after the other.
    pub(super) fn casts_of(&mut self, setting: &Setting, units: &Range<u32>) -> Vec<Pending> {
        let mut all: Vec<Pending> = Vec::new();
        for order in self.orders_of(setting) {
            for (place, (lattice, tiles)) in order.casts(units).into_iter().enumerate() {
                if all.len() == place {
                    let views = 0..setting.rays.len();
                    all.push(Pending { views, lattice, counts: true, mends: false, tiles: Vec::new() });
                }
                all[place].tiles.push(tiles);
            }
        }
        all
    }

    /// The order of each view.
    fn orders_of(&mut self, setting: &Setting) -> Vec<Arc<Order>> {
        let grain = if setting.caster.fans.is_some() { Grain::Rows } else { Grain::Pixels };
        setting.rays.iter().map(|rays| self.refining.order(grain, rays.raster)).collect()
    }

    /// A part of the way to a picture is cast: makes what is shown of it, and tells what may be wrong with that.
    pub(super) fn refine(&mut self, work: &mut Work) -> Result<(), RenderError> {
        let Some(Refinement { to, .. }) = work.frame.refinement else { return Ok(()) };
        if work.frame.pace == Pace::Complete {
            let mended = work.mended.take();
            self.refining.mended = mended.or(self.refining.mended.take());
            work.mended = self.refining.mended.clone().filter(|_| to >= Refinement::UNITS);
        }
        let orders = self.orders_of(&work.setting);
        let cast: Result<Vec<Vec<f32>>, DeviceError> = (0..work.setting.rays.len())
            .map(|view| Ok(self.device.picture(DevicePicture::Cast(work.picture_of(view)))?.into_owned()))
            .collect();
        let cast = cast?;
        let before = &self.refining.before;
        let mut last = std::mem::take(&mut self.refining.filled);
        last.resize_with(cast.len(), Filled::default);
        let make = |(view, (cast, last)): (usize, (Vec<f32>, Filled))| {
            let before = before.get(view).filter(|before| before.rgba.len() == cast.len());
            fill(cast, before, last, &orders[view], to)
        };
        let filled: Vec<Filled> = cast.into_par_iter().zip(last).enumerate().map(make).collect();
        let mut refined = Refined { done: to, ..Refined::default() };
        let mut few = Vec::new();
        for (one, order) in filled.iter().zip(&orders) {
            refined.pixels += one.rgba.len() as u64 / 4;
            refined.spatial += one.spatial;
            few.push(sparse(&one.rgba, order.size(), order.first()));
        }
        let begins = self.refining.done == 0;
        let before = std::mem::replace(&mut self.refining.few, few);
        let (newest, started) = (work.newest.take(), Instant::now());
        (refined.change, refined.compared) = match newest {
            Some(newest) => self.glance(work, &orders, newest)?,
            // What began this picture changed so much.
            None if begins && before.len() == orders.len() => changes(&self.refining.few, &before),
            None => (0, 0),
        };
        work.account.stages.cast_ms += milliseconds(started);
        self.refining.filled = filled;
        self.refining.done = to;
        work.refined = Some(refined);
        Ok(())
    }

    /// How far what rays would see of another state is from the pictures, at the pixels of the first unit.
    fn glance(
        &mut self,
        work: &Work,
        orders: &[Arc<Order>],
        newest: FrameState,
    ) -> Result<(u64, u64), RenderError> {
        let Some(first) = orders.first().map(|order| order.first()) else { return Ok((0, 0)) };
        let setting = Setting::new(self, &newest)?;
        let views = setting.rays.len();
        // Of another caster, or on another raster, the pixels are not the same.
        let are_cast_alike = setting.caster.fans.is_some() == work.setting.caster.fans.is_some()
            && setting.rays.iter().zip(&work.setting.rays).all(|(a, b)| a.raster == b.raster);
        if !are_cast_alike {
            return Ok((0, 0));
        }
        match newest.pace {
            Pace::Complete => self.look_until_complete(newest, setting, first)?,
            Pace::Live { .. } => self.look_at_what_there_is(&newest, &setting, first)?,
        }
        let mut few = Vec::new();
        for (view, order) in orders.iter().enumerate() {
            let picture = self.device.picture(DevicePicture::Cast(views + view))?;
            few.push(sparse(&picture, order.size(), first));
        }
        Ok(changes(&few, &self.refining.few))
    }

    /// Casts a few pixels of another state by the bricks that are there.
    fn look_at_what_there_is(
        &mut self,
        newest: &FrameState,
        setting: &Setting,
        lattice: twin::Lattice,
    ) -> Result<(), RenderError> {
        self.lay_out(newest, setting, &mut Stages::default());
        self.refining.is_disturbed = true;
        self.device.cast(&CastJob {
            scene: &setting.scene,
            views: &setting.rays,
            first_picture: setting.rays.len(),
            sharing: setting.caster.sharing(newest),
            needs: Needs { blends: self.shelf.blends, spreads: self.shelf.spreads, ..setting.needs },
            part: Part::Every(lattice),
            mends: false,
            gather: Gather::Own,
            counts: false,
            stop: NEVER,
        })?;
        Ok(())
    }

    /// The same, with all bricks that these pixels need: so it does not matter which are there, or who draws what else.
    fn look_until_complete(
        &mut self,
        newest: FrameState,
        setting: Setting,
        lattice: twin::Lattice,
    ) -> Result<(), RenderError> {
        self.tables.write_if_new(&mut self.device);
        let account = Account::new(setting.rays());
        let frame = FrameState { sub_frame: None, refinement: None, ..newest };
        let mut look = Work { glance: Some(lattice), ..Work::new(frame, setting, account, &self.device) };
        let mut course = Complete::default();
        self.refining.is_disturbed = true;
        loop {
            if !look.pending.is_empty() {
                look.cast(self, NEVER)?;
            } else if course.next(&mut look, self, NEVER)?.is_some() {
                return Ok(());
            }
        }
    }

    /// Gives the device back what a picture is cast with, where something else was looked at meanwhile.
    pub(super) fn restore(&mut self, work: &mut Work) -> Result<(), RenderError> {
        if std::mem::take(&mut self.refining.is_disturbed) {
            self.lay_out(&work.frame, &work.setting, &mut work.account.stages);
        }
        Ok(())
    }

    /// Writes tables and index of a state, by the working set as it is.
    fn lay_out(&mut self, frame: &FrameState, setting: &Setting, stages: &mut Stages) {
        self.tables.write_if_new(&mut self.device);
        let Engine { set, stock, shelf, device, live, .. } = self;
        let rules = setting.rules(frame);
        let source = Arc::clone(&stock.source);
        let summary = |key| source.summary(key);
        let moment = Moment {
            rules: rules.for_index(&stock.shape, shelf.blank_slot()),
            summary: &summary,
            now_s: live.now_s(frame),
            is_still: false,
            fade_s: 0.0,
            most_in_flight: 0,
        };
        shelf.refresh_cells(set.cut(), &rules);
        let blends = rules.blends || (frame.quality.blended && set.blends());
        shelf.write_live(set, &moment, &FrameRules { blends, ..rules }, device, stages);
    }
}

/// The sum of how far pixels are apart, and how many there are.
fn changes(now: &[FewPixels], before: &[FewPixels]) -> (u64, u64) {
    now.iter()
        .zip(before)
        .fold((0, 0), |(sum, count), (now, before)| (sum + change_at(now, before), count + now.len() as u64))
}
