//! The account of a frame in words and numbers.

use super::account::milliseconds;
use super::engine::Engine;
use super::work::Work;
use crate::present::Classes;
use protocol::{FrameReport, Upkeep};

/// Damaged bricks that a report names one by one.
const MOST_DAMAGES: usize = 16;

impl Engine {
    /// What both kinds of frames report; `short` says why a frame is not complete, damage apart.
    pub(super) fn frame_report(
        &self,
        work: &Work,
        short: Option<String>,
        upkeep: Option<Upkeep>,
    ) -> FrameReport {
        let damage = &self.stock.damage;
        let guessed = (work.known != Classes::ALL)
            .then(|| "some pixels are reconstructed from those beside them".to_owned());
        let cut = (work.account.cut > 0).then(|| {
            format!(
                "the GPU's driver left {} of {} rays before their end, as their loops go round too often for it: take \
                 --device cpu, or longer steps",
                work.account.cut, work.account.rays
            )
        });
        let shortfall: Vec<_> = short.or(guessed).into_iter().chain(cut).chain(self.damages()).collect();
        let shortfall = shortfall.join("; ");
        FrameReport {
            frame: work.frame.index,
            backend: self.options.backend,
            projectors: self.options.projectors.clone(),
            caster: work.setting.caster.caster.clone(),
            rays: work.account.rays,
            samples: work.account.samples,
            bricks_wanted: 0,
            bricks_resident: self.set.slots().used(),
            bricks_loaded: work.account.bricks_loaded,
            bytes_loaded: work.account.bytes_loaded,
            working_set_union: 0,
            working_set_sum: None,
            complete: shortfall.is_empty(),
            shortfall,
            damaged_bricks: damage.missed(),
            damaged: damage.sentences(MOST_DAMAGES),
            upkeep,
            refined: work.refined,
            stages: work.account.stages,
            total_ms: milliseconds(work.account.started),
        }
    }

    /// Why a live frame is not complete, by what rays of the frame before found, if it showed the same.
    pub(super) fn live_shortfall(&self, short: usize, is_known: bool, upkeep: &Upkeep) -> Option<String> {
        let Upkeep { in_flight, fading, .. } = upkeep;
        let (root, beside) = (self.set.cut().node(0), self.set.short_beside());
        if root.brick.is_none() && root.is_visible {
            Some("the volume's coarsest brick has not come yet".to_owned())
        } else if short > 0 {
            Some(format!(
                "{short} nodes are shown coarser than the display resolves, {in_flight} bricks are on their way"
            ))
        } else if beside > 0 {
            Some(format!(
                "{beside} nodes that no ray meets are too coarse for those beside them, {in_flight} bricks are on their way"
            ))
        } else if *fading > 0 {
            Some(format!("the detail of {fading} nodes is coming or going"))
        } else if self.easing.is_behind() {
            Some("the picture is on its way to the detail that has come".to_owned())
        } else {
            (!is_known).then(|| "it is not known yet what rays of this frame lack".to_owned())
        }
    }

    fn damages(&self) -> Option<String> {
        let damage = &self.stock.damage;
        let first = damage.sentences(1).pop()?;
        Some(match damage.missed() {
            1 => format!("a brick cannot be read, and what is coarser is shown in its place: {first}"),
            bricks => format!(
                "{bricks} bricks cannot be read, and what is coarser is shown in their place; the first of them: {first}"
            ),
        })
    }
}
