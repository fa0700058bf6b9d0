//! Flat surfaces as polygons of pixels.

use crate::polygon::cut;
use crate::view::{FLAT_PX, MOST_HALVINGS, View};
use glam::{DVec2, DVec3};

/// The picture of a surface, with as many corners as bent edges need. None beyond the horizon of a calibration.
pub(crate) fn polygon(corners: &[DVec3], view: &View) -> Option<Vec<DVec2>> {
    let corners = cut(corners, |p| view.margins(p).x);
    let corners = cut(&corners, |p| view.margins(p).y);
    let mut out = Vec::new();
    for (i, &a) in corners.iter().enumerate() {
        let b = corners[(i + 1) % corners.len()];
        edge([(a, view.pixel(a)?), (b, view.pixel(b)?)], view, MOST_HALVINGS, &mut out)?;
    }
    Some(out)
}

/// Points of an edge with their pixels, its end left out.
fn edge([a, b]: [(DVec3, DVec2); 2], view: &View, halvings: u32, out: &mut Vec<DVec2>) -> Option<()> {
    let middle = 0.5 * (a.0 + b.0);
    let middle = (middle, view.pixel(middle)?);
    if halvings == 0 || (middle.1 - 0.5 * (a.1 + b.1)).length() <= FLAT_PX {
        out.push(a.1);
        return Some(());
    }
    edge([a, middle], view, halvings - 1, out)?;
    edge([middle, b], view, halvings - 1, out)
}
