//! Where bricks come from, and what is known of those that cannot be read.

use super::RenderError;
use super::account::{Account, milliseconds};
use super::damage::Damage;
use super::rules::FrameRules;
use super::shelf::Shelf;
use crate::device::Device;
use crate::working_set::{Arrival, Fetched, Loader, Supply, WorkingSet};
use bricks::is_shown;
use bricks::{BrickError, BrickErrorKind, BrickSource, NodeKey, OctreeShape};
use optics::Optics;
use protocol::StopAsked;
use std::sync::Arc;
use std::time::Instant;

/// The volume, its loader, and its damage.
pub(super) struct Stock {
    pub(super) source: Arc<dyn BrickSource>,
    pub(super) shape: OctreeShape,
    pub(super) damage: Damage,
    pub(super) loader: Arc<Loader>,
}

/// How bricks are handed over.
#[derive(Clone, Copy)]
pub(super) enum Delivery<'a> {
    /// What has come, up to so many bytes; the rest follows in later frames.
    AsItComes {
        /// Bytes that one frame may move to the device.
        upload_bytes: u64,
    },
    /// All that is wanted, however long it takes, unless somebody asks to leave off.
    All(StopAsked<'a>),
}

/// Bricks that are waited for at a time: enough to keep a disk busy.
const WAITED_FOR: usize = 64;

impl Stock {
    pub(super) fn new(source: Arc<dyn BrickSource>, loader: Loader) -> Self {
        Self { shape: source.shape(), source, damage: Damage::default(), loader: Arc::new(loader) }
    }

    /// Those of some nodes that lie in the volume and show something.
    pub(super) fn shown<'a>(
        &self,
        keys: &'a [NodeKey],
        optics: &'a Optics,
    ) -> impl Iterator<Item = NodeKey> + use<'a> {
        let (shape, source) = (self.shape, Arc::clone(&self.source));
        keys.iter().copied().filter(move |&key| shape.contains(key) && is_shown(optics, source.summary(key)))
    }

    /// # Errors
    /// The root shows something and its brick cannot be read: then there is nothing to draw any node from.
    pub(super) fn check_root(&self, set: &WorkingSet) -> Result<(), RenderError> {
        let lost = self.damage.of(NodeKey::ROOT).filter(|_| set.cut().lacks(0));
        lost.map_or(Ok(()), |error| Err(error.clone().into()))
    }
}

/// Takes bricks from the stock to the shelf, for one step of a working set.
pub(super) struct Clerk<'a> {
    stock: &'a mut Stock,
    shelf: &'a mut Shelf,
    device: &'a mut Device,
    rules: &'a FrameRules<'a>,
    delivery: Delivery<'a>,
    /// Bricks that were asked for and are not wanted any more.
    pub(super) cancelled: u64,
    load_ms: f64,
    upload_ms: f64,
    bricks: u64,
    bytes: u64,
    lost: Option<BrickError>,
}

impl<'a> Clerk<'a> {
    pub(super) fn new(
        stock: &'a mut Stock,
        shelf: &'a mut Shelf,
        device: &'a mut Device,
        rules: &'a FrameRules<'a>,
        delivery: Delivery<'a>,
    ) -> Self {
        Self {
            stock,
            shelf,
            device,
            rules,
            delivery,
            cancelled: 0,
            load_ms: 0.0,
            upload_ms: 0.0,
            bricks: 0,
            bytes: 0,
            lost: None,
        }
    }

    /// Adds what the step took, of `whole_ms` in all, to the frame's account.
    ///
    /// # Errors
    /// The loader's threads have ended, or the root's brick is damaged.
    pub(super) fn settle_up(self, account: &mut Account, whole_ms: f64) -> Result<(), RenderError> {
        account.stages.load_ms += self.load_ms;
        account.stages.upload_ms += self.upload_ms;
        account.stages.refine_ms += whole_ms - self.load_ms - self.upload_ms;
        account.bricks_loaded += self.bricks;
        account.bytes_loaded += self.bytes;
        self.lost.map_or(Ok(()), |error| Err(error.into()))
    }

    /// What is away is asked for again after a while; what is damaged is not.
    fn take(&mut self, set: &mut WorkingSet, (key, fetched): Fetched) {
        let brick = match fetched {
            Ok(brick) => brick,
            Err(error) => return self.note_failure(set, key, error),
        };
        let started = Instant::now();
        self.stock.damage.forget(key);
        if let Arrival::Slot(slot) = set.arrived(key, brick.low, brick.span) {
            self.bricks += 1;
            self.bytes += brick.bytes;
            self.shelf.fill(set.cut(), set.cut().find(key), slot, brick, self.rules, self.device);
        }
        self.upload_ms += milliseconds(started);
    }

    fn note_failure(&mut self, set: &mut WorkingSet, key: NodeKey, error: BrickError) {
        let is_damaged = error.kind == BrickErrorKind::Damaged;
        let is_first = set.failed(key, error.kind);
        if key == NodeKey::ROOT && is_damaged {
            self.lost = Some(error.clone());
        }
        if is_first {
            self.stock.damage.learn(key, error);
        }
    }
}

impl Supply for Clerk<'_> {
    fn want(&mut self, set: &WorkingSet, ahead: &[NodeKey]) {
        if let Delivery::AsItComes { .. } = self.delivery {
            self.cancelled = self.stock.loader.want(set.wanted(), ahead) as u64;
        }
    }

    fn deliver(&mut self, set: &mut WorkingSet) {
        let started = Instant::now();
        match self.delivery {
            Delivery::AsItComes { upload_bytes } => {
                for fetched in self.stock.loader.arrived(upload_bytes) {
                    self.take(set, fetched);
                }
            }
            Delivery::All(stop) => {
                // No more than there are slots for, so that it does not matter which comes first.
                let keys: Vec<NodeKey> = set.wanted().iter().copied().take(set.slots().free()).collect();
                let loader = Arc::clone(&self.stock.loader);
                for some in keys.chunks(WAITED_FOR) {
                    if stop() {
                        break;
                    }
                    if let Err(error) = loader.fetch(some, |fetched| self.take(set, fetched)) {
                        self.lost = Some(error);
                    }
                }
            }
        }
        self.load_ms += milliseconds(started) - self.upload_ms;
    }
}
