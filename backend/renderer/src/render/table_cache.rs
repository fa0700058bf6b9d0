//! The tables of the latest optics.

use crate::device::Device;
use needs::Needs;
use needs::tables::Tables;
use optics::Optics;
use std::sync::Arc;

/// The tables of the latest optics: they are made when these change.
#[derive(Debug, Default)]
pub(super) struct TableCache {
    made: Option<(Optics, Needs, Arc<Tables>)>,
    /// Whether the device has other ones.
    is_new: bool,
}

impl TableCache {
    pub(super) fn of(&mut self, optics: &Optics, needs: &Needs) -> Arc<Tables> {
        if let Some((made, for_needs, tables)) = &self.made
            && made == optics
            && for_needs == needs
        {
            return Arc::clone(tables);
        }
        let tables = Tables::new(optics, needs);
        let same = self.latest().filter(|latest| ***latest == tables).cloned();
        self.is_new |= same.is_none();
        let tables = same.unwrap_or_else(|| Arc::new(tables));
        self.made = Some((optics.clone(), *needs, Arc::clone(&tables)));
        tables
    }

    fn latest(&self) -> Option<&Arc<Tables>> {
        self.made.as_ref().map(|(_, _, tables)| tables)
    }

    /// Writes the tables that were asked for last, where the device has others.
    pub(super) fn write_if_new(&mut self, device: &mut Device) {
        if let Some(tables) = self.latest().filter(|_| self.is_new) {
            device.write_tables(Tables::clone(tables));
            self.is_new = false;
        }
    }
}
