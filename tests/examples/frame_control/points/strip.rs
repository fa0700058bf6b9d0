//! A strip of stills: what few rays show.

use super::plan::{Plan, Way};
use super::shots::{Shots, Truth};
use crate::PAGE;
use lightloom_tests::results;
use renderer::output::{Picture, PictureRef, write_png};

/// Columns: these shares, and the complete picture.
const COLUMNS: [usize; 3] = [0, 1, 2];
/// Rows.
const ROWS: [Way; 3] = [Way::Filled, Way::AtOnce, Way::Levels];

/// Writes it beside the page, if the environment asks for results.
pub fn write(plan: &Plan, shots: &Shots) -> Result<(), String> {
    let Some(folder) = results::folder() else { return Ok(()) };
    let levels = plan.levels(shots, 0);
    let complete = shots.seen(&shots.complete(0, Truth::Middles));
    let rows = ROWS.map(|way| {
        let made = |&share: &usize| plan.made((shots, 0), &levels, way, share);
        let seen = COLUMNS.iter().filter_map(made).map(|(made, _)| shots.seen(&made));
        seen.chain([complete.clone()]).collect::<Vec<Picture>>()
    });
    let (width, height) = (complete.width as usize, complete.height as usize);
    let across = COLUMNS.len() + 1;
    let mut rgba = Vec::with_capacity(4 * across * width * ROWS.len() * height);
    for row in &rows {
        for y in 0..height {
            row.iter().for_each(|picture| rgba.extend(&picture.rgba[4 * y * width..4 * (y + 1) * width]));
        }
    }
    let size = [across * width, ROWS.len() * height].map(|along| along as u32);
    let view = PictureRef::new(size[0], size[1], &rgba).map_err(|error| error.to_string())?;
    write_png(&folder.join(format!("{PAGE}-points.png")), view).map_err(|error| error.to_string())
}
