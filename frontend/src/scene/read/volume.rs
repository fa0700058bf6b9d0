//! Which volume a scene file names, and where it puts it.

use crate::scene::error::Checked;
use crate::scene::file::{Lengths, PlacementTable, VolumeTable, Voxels};
use crate::scene::names::PROCEDURAL_PREFIX;
use crate::scene::placement::rotation_from_deg;
use crate::scene::text::SceneText;
use crate::scene::volume::LARGEST_EDGE;
use crate::scene::{Placement, Size, VolumeAxes, VolumeSource};
use glam::{DVec3, UVec3};
use std::ops::Range;
use std::path::Path;
use toml::Spanned;

/// Of a volume, metres or times its own: sizes that f32 distinguishes from nothing and from everything.
const SIZES: std::ops::RangeInclusive<f64> = 1e-6..=1e6;

/// Of a voxel, metres.
const EDGES_M: std::ops::RangeInclusive<f64> = 1e-12..=1e6;

impl SceneText {
    pub(super) fn volume(&self, table: &VolumeTable, folder: &Path) -> Checked<VolumeSource> {
        let source = table.source.get_ref();
        let Some(name) = source.strip_prefix(PROCEDURAL_PREFIX) else {
            return match &table.size {
                Some(size) => Err(self.wrong(size.span(), "a store has its own size; remove this line")),
                None if source.trim().is_empty() => {
                    let message = format!("it is empty; give a .lloom store or {PROCEDURAL_PREFIX}NAME");
                    Err(self.wrong(table.source.span(), message))
                }
                None => Ok(VolumeSource::Store(folder.join(source))),
            };
        };
        let volume =
            VolumeSource::procedural(name).map_err(|e| self.wrong(table.source.span(), e.to_string()))?;
        let (Some(size), VolumeSource::Procedural { name, .. }) = (&table.size, &volume) else {
            return Ok(volume);
        };
        let dims = match *size.get_ref() {
            Voxels::All(edge) => UVec3::splat(edge),
            Voxels::Each(edges) => UVec3::from_array(edges.0),
        };
        if dims.min_element() < 1 || dims.max_element() > LARGEST_EDGE {
            return Err(self.wrong(size.span(), format!("give sizes from 1 to {LARGEST_EDGE} voxels")));
        }
        Ok(VolumeSource::Procedural { name: name.clone(), dims })
    }

    pub(super) fn voxel_size(&self, lengths: &Spanned<Lengths>) -> Checked<DVec3> {
        let size = match *lengths.get_ref() {
            Lengths::All(edge) => DVec3::splat(edge),
            Lengths::Each(edges) => DVec3::from_array(edges.0),
        };
        let is_usable = size.to_array().iter().all(|edge| EDGES_M.contains(edge));
        let message = "give lengths from 1e-12 to 1e6 metres";
        is_usable.then_some(size).ok_or_else(|| self.wrong(lengths.span(), message))
    }

    pub(super) fn placement(&self, table: &Spanned<PlacementTable>) -> Checked<Placement> {
        let place = table.get_ref();
        let size = match (&place.longest_m, &place.scale) {
            (Some(longest), None) => Size::LongestM(self.within(longest, SIZES)?),
            (None, Some(scale)) => Size::Scale(self.within(scale, SIZES)?),
            (Some(_), Some(scale)) => {
                return Err(self.wrong(scale.span(), "longest_m is given too; keep exactly one of the two"));
            }
            (None, None) => return Err(self.wrong(table.span(), "add exactly one of longest_m and scale")),
        };
        let centre_m = self.optional_point(&place.centre_m)?.unwrap_or(DVec3::ZERO);
        let deg = self.optional_point(&place.rotation_deg)?.unwrap_or(DVec3::ZERO);
        let axes = self.axes(place, table.span())?;
        Ok(Placement { centre_m, rotation: rotation_from_deg(deg), axes, size })
    }

    /// Which way the volume stands, as far as the file says.
    fn axes(&self, place: &PlacementTable, table: Range<usize>) -> Checked<VolumeAxes> {
        let given = [&place.up, &place.front, &place.right];
        let [up, front, right] = given.map(|axis| axis.as_ref().map(|axis| *axis.get_ref()));
        let span = given.iter().find_map(|axis| axis.as_ref()).map_or(table, Spanned::span);
        let message = "up, front and right must be three different axes of the volume";
        VolumeAxes::new(up, front, right).ok_or_else(|| self.wrong(span, message))
    }
}
