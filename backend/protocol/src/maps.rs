//! The numbers of a display's maps as bytes: they are too many for the body of a message.
//!
//! Projector by projector: x and y of each point of its mesh as f32, the shares of its blend map as u16, those of its map
//! of black as u16; all little-endian. The body has their sizes.

use display_config::{BlackLevel, Display, Finish, LightMap, MapFault, Mesh};
use glam::Vec2;
use std::borrow::Cow;

/// The bytes of all maps; none where there are no maps.
pub(crate) fn bytes_of(display: &Display) -> Vec<u8> {
    let mut bytes = Vec::new();
    for Finish { mesh, blend, black, .. } in display.projectors.iter().map(|projector| &projector.finish) {
        let points = mesh.iter().flat_map(|mesh| mesh.points()).flat_map(|point| point.to_array());
        bytes.extend(points.flat_map(f32::to_le_bytes));
        let maps = blend.iter().chain(black.iter().filter_map(map_of));
        bytes.extend(maps.flat_map(|map| map.shares()).flat_map(|share| share.to_le_bytes()));
    }
    bytes
}

/// Gives the maps of a display that came without their numbers these numbers.
///
/// # Errors
/// They are too few, too many, or make no maps.
pub(crate) fn fill(display: &mut Display, mut bytes: &[u8]) -> Result<(), Cow<'static, str>> {
    for projector in &mut display.projectors {
        let finish = &mut projector.finish;
        if let Some(mesh) = &mut finish.mesh {
            *mesh = mesh_of(mesh.size(), &mut bytes)?;
        }
        let black = finish.black.iter_mut().filter_map(|black| match black {
            BlackLevel::Map(map) => Some(map),
            BlackLevel::Level(_) => None,
        });
        for map in finish.blend.iter_mut().chain(black) {
            *map = light_map(map.size(), &mut bytes)?;
        }
    }
    match bytes.len() {
        0 => Ok(()),
        more => Err(format!("{more} bytes follow it").into()),
    }
}

fn map_of(black: &BlackLevel) -> Option<&LightMap> {
    match black {
        BlackLevel::Map(map) => Some(map),
        BlackLevel::Level(_) => None,
    }
}

fn mesh_of([columns, rows]: [u32; 2], bytes: &mut &[u8]) -> Result<Mesh, Cow<'static, str>> {
    let number = |bytes: &[u8]| f32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]]);
    let points = taken([columns, rows], 8, bytes)?.chunks_exact(8);
    let points = points.map(|point| Vec2::new(number(point), number(&point[4..]))).collect();
    Mesh::new(columns, rows, points).map_err(|fault| said("mesh", &fault))
}

fn light_map([width, height]: [u32; 2], bytes: &mut &[u8]) -> Result<LightMap, Cow<'static, str>> {
    let shares = taken([width, height], 2, bytes)?.chunks_exact(2);
    let shares = shares.map(|share| u16::from_le_bytes([share[0], share[1]])).collect();
    LightMap::new(width, height, shares).map_err(|fault| said("map", &fault))
}

fn said(what: &str, fault: &MapFault) -> Cow<'static, str> {
    format!("a {what}, {fault}").into()
}

/// The next `each` bytes for each of the numbers of a grid.
fn taken<'a>(
    [across, down]: [u32; 2],
    each: u64,
    bytes: &mut &'a [u8],
) -> Result<&'a [u8], Cow<'static, str>> {
    let needed = (u64::from(across) * u64::from(down)).saturating_mul(each);
    let split = usize::try_from(needed).ok().and_then(|needed| bytes.split_at_checked(needed));
    let (taken, rest) = split.ok_or("the numbers of its maps are cut short")?;
    *bytes = rest;
    Ok(taken)
}
