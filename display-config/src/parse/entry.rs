//! Projectors listed one by one.

use super::finish::finish;
use super::output;
use super::raw::RawProjector;
use super::source::Source;
use crate::raster::is_strictly_convex;
use crate::text::ListOf;
use crate::{ConfigError, Homography, Projector, Raster};
use glam::{DMat3, DVec2};
use std::ops::Range;
use toml::Spanned;

pub(super) fn projectors(
    source: &Source<'_>,
    raw: &[Spanned<RawProjector>],
    screen: DVec2,
) -> Result<Vec<Projector>, ConfigError> {
    let mut projectors: Vec<Projector> = Vec::with_capacity(raw.len());
    for entry in raw {
        let projector = projector(source, entry, screen)?;
        check_against_earlier(source, &projectors, &projector, entry.get_ref())?;
        projectors.push(projector);
    }
    check_backends(source, raw)?;
    Ok(projectors)
}

fn projector(
    source: &Source<'_>,
    entry: &Spanned<RawProjector>,
    screen: DVec2,
) -> Result<Projector, ConfigError> {
    let raw = entry.get_ref();
    let (width, height) = source.raster_size(&raw.width_px, &raw.height_px)?;
    let (key, span, screen_from_pixel) =
        placement(source, entry, DVec2::new(width.into(), height.into()), screen)?;
    let output = raw.output.as_ref().map(|output| output::of_entry(source, output)).transpose()?;
    let raster = Raster { width, height, screen_from_pixel, output };
    if !raster.is_regular() {
        return Err(ConfigError::SingularRaster { place: source.place(key, span) });
    }
    Ok(Projector {
        name: source.name("name", &raw.name)?,
        centre_in_display: source.centre("centre_m", &raw.centre_m)?,
        raster,
        backend: *raw.backend.get_ref(),
        finish: finish(source, raw.finish.as_ref())?,
    })
}

/// Where the raster falls, with the key that says so.
type Placement = (&'static str, Range<usize>, Homography);

fn placement(
    source: &Source<'_>,
    entry: &Spanned<RawProjector>,
    pixels: DVec2,
    screen: DVec2,
) -> Result<Placement, ConfigError> {
    let raw = entry.get_ref();
    let has_mesh = raw.finish.as_ref().is_some_and(|finish| finish.mesh.is_some());
    match (&raw.screen_rect_m, &raw.homography, &raw.corners_m) {
        (Some(rectangle), None, None) => of_rectangle(source, rectangle, pixels),
        (None, Some(rows), None) => of_rows(source, rows),
        (None, None, Some(corners)) => of_corners(source, corners, pixels),
        // A mesh takes its light from a picture of the whole screen: the one that row planes draw, and black beside it.
        (None, None, None) if has_mesh => {
            Ok(("projector", entry.span(), Homography::of_rectangle(pixels, -screen / 2.0, screen)))
        }
        (rectangle, rows, corners) => {
            let given = [rectangle.is_some(), rows.is_some(), corners.is_some()];
            let count = given.into_iter().filter(|&is_given| is_given).count();
            Err(ConfigError::Placement { place: source.place("projector", entry.span()), count })
        }
    }
}

fn of_rectangle(
    source: &Source<'_>,
    rectangle: &Spanned<ListOf<f64, 4>>,
    pixels: DVec2,
) -> Result<Placement, ConfigError> {
    let (key, span) = ("screen_rect_m", rectangle.span());
    source.all_finite(key, span.clone(), &rectangle.get_ref().0)?;
    let [left, bottom, width, height] = rectangle.get_ref().0;
    if width <= 0.0 || height <= 0.0 {
        let expected = "[left, bottom, width, height] with a width and a height above 0";
        return Err(source.out_of_range(key, span, width.min(height), expected));
    }
    let map = Homography::of_rectangle(pixels, DVec2::new(left, bottom), DVec2::new(width, height));
    Ok((key, span, map))
}

fn of_rows(source: &Source<'_>, rows: &Spanned<ListOf<ListOf<f64, 3>, 3>>) -> Result<Placement, ConfigError> {
    let (key, span) = ("homography", rows.span());
    let rows = rows.get_ref().0.map(|row| row.0);
    source.all_finite(key, span.clone(), rows.as_flattened())?;
    Ok((key, span, Homography(DMat3::from_cols_array_2d(&rows).transpose())))
}

fn of_corners(
    source: &Source<'_>,
    corners: &Spanned<ListOf<ListOf<f64, 2>, 4>>,
    pixels: DVec2,
) -> Result<Placement, ConfigError> {
    let (key, span) = ("corners_m", corners.span());
    let corners = corners.get_ref().0.map(|corner| corner.0);
    source.all_finite(key, span.clone(), corners.as_flattened())?;
    let corners = corners.map(DVec2::from_array);
    let map = if is_strictly_convex(corners) { Homography::of_corners(pixels, corners) } else { None };
    let map = map.ok_or_else(|| ConfigError::SingularRaster { place: source.place(key, span.clone()) })?;
    Ok((key, span, map))
}

fn check_against_earlier(
    source: &Source<'_>,
    earlier: &[Projector],
    projector: &Projector,
    raw: &RawProjector,
) -> Result<(), ConfigError> {
    if earlier.iter().any(|other| other.name == projector.name) {
        let place = source.place("name", raw.name.span());
        return Err(ConfigError::DuplicateName { place, name: projector.name.clone() });
    }
    output::check_against_earlier(source, earlier, projector, raw)
}

fn check_backends(source: &Source<'_>, raw: &[Spanned<RawProjector>]) -> Result<(), ConfigError> {
    let numbers = || raw.iter().map(|entry| &entry.get_ref().backend);
    let Some(highest) = numbers().max_by_key(|number| *number.get_ref()) else { return Ok(()) };
    // With n projectors a gapless highest number is below n, so the search is short whatever the file says.
    let missing = (0..*highest.get_ref()).find(|wanted| numbers().all(|number| number.get_ref() != wanted));
    match missing {
        Some(missing) => Err(ConfigError::BackendGap {
            place: source.place("backend", highest.span()),
            highest: *highest.get_ref(),
            missing,
        }),
        None => Ok(()),
    }
}
