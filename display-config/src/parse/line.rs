//! Projectors generated on a line.

use super::finish::finish;
use super::output;
use super::raw::{Covers, RawLine};
use super::source::Source;
use crate::wiring::even_shares;
use crate::{ConfigError, Homography, Projector, Raster};
use glam::{DVec2, DVec3};

/// More projectors than any display has: a larger count is a mistake.
const MOST: u32 = 65_536;

/// `count` projectors evenly from one centre to another (one alone: in the middle), each covering the whole screen,
/// shared contiguously among the back-ends.
pub(super) fn projectors(
    source: &Source<'_>,
    raw: &RawLine,
    screen: DVec2,
) -> Result<Vec<Projector>, ConfigError> {
    let count = count(source, raw)?;
    let backend_of = backends(source, raw, count)?;
    let ends = (source.centre("from_m", &raw.from_m)?, source.centre("to_m", &raw.to_m)?);
    let raster = raster(source, raw, screen)?;
    let outputs = output::of_line(source, raw, &backend_of)?;
    let finish = finish(source, raw.finish.as_ref())?;
    let digits = (count - 1).to_string().len();
    (0..count)
        .zip(backend_of.into_iter().zip(outputs))
        .map(|(index, (backend, output))| {
            let centre_in_display = on_line(ends, index, count);
            if centre_in_display.z == 0.0 {
                return Err(ConfigError::ProjectorInScreenPlane {
                    place: source.place("to_m", raw.to_m.span()),
                });
            }
            let name = format!("projector-{index:0digits$}");
            let (raster, finish) = (Raster { output, ..raster.clone() }, finish.clone());
            Ok(Projector { name, centre_in_display, raster, backend, finish })
        })
        .collect()
}

fn count(source: &Source<'_>, raw: &RawLine) -> Result<u32, ConfigError> {
    let expected = "a number of projectors from 1 to 65536";
    let count = source.at_least_one("count", &raw.count, expected)?;
    if count > MOST {
        return Err(source.out_of_range("count", raw.count.span(), f64::from(count), expected));
    }
    Ok(count)
}

/// The back-end of each projector.
fn backends(source: &Source<'_>, raw: &RawLine, projectors: u32) -> Result<Vec<u32>, ConfigError> {
    let backends = source.at_least_one("backends", &raw.backends, "a number of back-ends, 1 or more")?;
    if backends > projectors {
        let place = source.place("backends", raw.backends.span());
        return Err(ConfigError::TooManyLineBackends { place, backends, projectors });
    }
    let shares = even_shares(projectors as usize, backends as usize);
    Ok((0..backends).zip(shares).flat_map(|(backend, share)| share.map(move |_| backend)).collect())
}

fn raster(source: &Source<'_>, raw: &RawLine, screen: DVec2) -> Result<Raster, ConfigError> {
    let (width, height) = source.raster_size(&raw.width_px, &raw.height_px)?;
    let pixels = DVec2::new(f64::from(width), f64::from(height));
    let screen_from_pixel = match raw.covers {
        Covers::Screen => Homography::of_rectangle(pixels, -screen / 2.0, screen),
    };
    Ok(Raster { width, height, screen_from_pixel, output: None })
}

fn on_line((from, to): (DVec3, DVec3), index: u32, count: u32) -> DVec3 {
    let share = if count == 1 { 0.5 } else { f64::from(index) / f64::from(count - 1) };
    // Both ends come out exact, which from + share · (to − from) does not promise.
    from * (1.0 - share) + to * share
}
