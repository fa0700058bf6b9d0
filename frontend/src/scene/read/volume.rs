//! Which volume a scene file names, and where it puts it.

use crate::scene::error::Checked;
use crate::scene::file::{Lengths, PlacementTable, VolumeTable, Voxels};
use crate::scene::names::PROCEDURAL_PREFIX;
use crate::scene::placement::rotation_from_deg;
use crate::scene::text::SceneText;
use crate::scene::volume::LARGEST_EDGE;
use crate::scene::{Placement, Size, VolumeAxes, VolumeAxis, VolumeSource};
use glam::{DVec3, UVec3};
use std::ops::Range;
use std::path::Path;
use toml::Spanned;

/// Of a volume, metres or times its own: sizes that f32 distinguishes from nothing and from everything.
const SIZES: std::ops::RangeInclusive<f64> = 1e-6..=1e6;

impl SceneText {
    pub(super) fn volume(&self, table: &VolumeTable, folder: &Path) -> Checked<VolumeSource> {
        let source = table.source.get_ref();
        let Some(name) = source.strip_prefix(PROCEDURAL_PREFIX) else {
            return match &table.size {
                Some(size) => Err(self.wrong(size.span(), "a store has its own size; remove this line")),
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
            Voxels::Each(edges) => UVec3::from_array(edges),
        };
        if dims.min_element() < 1 || dims.max_element() > LARGEST_EDGE {
            return Err(self.wrong(size.span(), format!("give sizes from 1 to {LARGEST_EDGE} voxels")));
        }
        Ok(VolumeSource::Procedural { name: name.clone(), dims })
    }

    pub(super) fn voxel_size(&self, lengths: &Spanned<Lengths>) -> Checked<DVec3> {
        let size = match *lengths.get_ref() {
            Lengths::All(edge) => DVec3::splat(edge),
            Lengths::Each(edges) => DVec3::from_array(edges),
        };
        let usable = size.is_finite() && size.min_element() > 0.0;
        usable.then_some(size).ok_or_else(|| self.wrong(lengths.span(), "give finite lengths above 0"))
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

    /// Which way the volume stands; None if the file leaves it to the volume.
    fn axes(&self, place: &PlacementTable, table: Range<usize>) -> Checked<Option<VolumeAxes>> {
        if place.up.is_none() && place.front.is_none() && place.right.is_none() {
            return Ok(None);
        }
        let up = place.up.as_ref().map_or(VolumeAxis::PlusY, |up| *up.get_ref());
        let span = place.up.as_ref().map_or(table, Spanned::span);
        let axes = VolumeAxes::new(up, place.front.unwrap_or(VolumeAxis::PlusZ), place.right);
        let message = "up, front and right must be three different axes of the volume";
        axes.map(Some).ok_or_else(|| self.wrong(span, message))
    }
}
