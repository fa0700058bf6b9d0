//! OME-XML in the first page's description: sizes, order of the pages, edges of a voxel (OME 2016-06).

use super::hyperstack::{Hyperstack, unit_mm};
use super::xml_depth::depth;
use roxmltree::{Document, Node};

/// Letters of the axes in the order of [`Hyperstack::counts`].
const AXES: [char; 3] = ['C', 'Z', 'T'];

/// Elements within each other that are believed; those of the format are some ten.
const DEEPEST: usize = 64;

/// Whether the description is OME-XML.
pub(super) fn is_ome(description: &str) -> bool {
    description.contains("<OME") && description.contains("<Pixels")
}

/// The stack; a sentence where it cannot be understood. A page holds `samples` of the channels.
pub(super) fn hyperstack(description: &str, pages: u32, samples: u32) -> Result<Hyperstack, String> {
    let text = description.trim_end_matches(['\0', ' ', '\n']);
    if depth(text) > DEEPEST {
        return Err(format!(
            "its OME-XML has elements more than {DEEPEST} deep in each other: save it again"
        ));
    }
    let document = Document::parse(text).map_err(|cause| format!("its OME-XML is damaged: {cause}"))?;
    let images: Vec<Node> = document.descendants().filter(|node| node.has_tag_name_any("Pixels")).collect();
    let [pixels] = images[..] else {
        return Err(format!(
            "it holds {} OME images: save the one to show in a file of its own",
            images.len()
        ));
    };
    let counts = counts(&pixels, samples)?;
    let page_count = Hyperstack::page_count(counts).filter(|&count| count <= pages);
    let order = order(&pixels)?;
    if page_count.is_none() {
        let [channels, slices, times] = counts;
        return Err(format!(
            "its OME-XML promises {channels} channels, {slices} slices and {times} points in time, and it has {pages} \
             pages: save them all in one file"
        ));
    }
    let mut stack = Hyperstack::in_order(counts, order);
    place_pages(&pixels, &mut stack, order, pages)?;
    stack.voxel_mm = ["X", "Y", "Z"].map(|axis| edge_mm(&pixels, axis));
    Ok(stack)
}

/// Names of elements without their name space, which has the version in it.
trait HasName {
    fn has_tag_name_any(&self, name: &str) -> bool;
}

impl HasName for Node<'_, '_> {
    fn has_tag_name_any(&self, name: &str) -> bool {
        self.is_element() && self.tag_name().name() == name
    }
}

fn number(node: &Node, name: &str) -> Result<Option<u32>, String> {
    let parse = |text: &str| {
        text.parse().map_err(|_| format!("its OME-XML has {name}={text:?}: a number is expected"))
    };
    node.attribute(name).map(parse).transpose()
}

/// Channels, slices and times in pages.
fn counts(pixels: &Node, samples: u32) -> Result<[u32; 3], String> {
    let size = |axis: char| Ok::<u32, String>(number(pixels, &format!("Size{axis}"))?.unwrap_or(1));
    let [channels, slices, times] = [size('C')?, size('Z')?, size('T')?];
    let in_page = if channels % samples == 0 { samples } else { 1 };
    Ok([channels / in_page, slices, times])
}

/// The axes from the fastest to the slowest.
fn order(pixels: &Node) -> Result<[usize; 3], String> {
    let text = pixels.attribute("DimensionOrder").unwrap_or("XYCZT");
    let axes: Vec<usize> =
        text.chars().skip(2).filter_map(|letter| AXES.iter().position(|&axis| axis == letter)).collect();
    match axes[..] {
        [a, b, c] if a != b && b != c && a != c => Ok([a, b, c]),
        _ => Err(format!("its OME-XML has DimensionOrder={text:?}: XYCZT or another order is expected")),
    }
}

/// Moves pages to where the TiffData elements, if there are any, say that they lie.
fn place_pages(pixels: &Node, stack: &mut Hyperstack, order: [usize; 3], pages: u32) -> Result<(), String> {
    let data: Vec<Node> = pixels.children().filter(|node| node.has_tag_name_any("TiffData")).collect();
    // One that says nothing, or none at all, means all pages in their order.
    if data.iter().all(|data| data.attribute("IFD").is_none() && data.attribute("PlaneCount").is_none()) {
        return Ok(());
    }
    let counts = stack.counts;
    stack.pages.fill(None);
    for data in data {
        let mut place = [number(&data, "FirstC")?, number(&data, "FirstZ")?, number(&data, "FirstT")?]
            .map(Option::unwrap_or_default);
        let first = number(&data, "IFD")?;
        let count = number(&data, "PlaneCount")?.unwrap_or(if first.is_some() { 1 } else { pages });
        let first = first.unwrap_or(0);
        for page in (first..first.saturating_add(count)).take_while(|&page| page < pages) {
            if place.iter().zip(counts).any(|(place, count)| *place >= count) {
                break;
            }
            let [c, z, t] = place;
            stack.pages[(c + counts[0] * (z + counts[1] * t)) as usize] = Some(page);
            step(&mut place, counts, order);
        }
    }
    Ok(())
}

/// To the next page's place.
fn step(place: &mut [u32; 3], counts: [u32; 3], order: [usize; 3]) {
    for (i, &axis) in order.iter().enumerate() {
        place[axis] += 1;
        if place[axis] < counts[axis] || i == 2 {
            return;
        }
        place[axis] = 0;
    }
}

fn edge_mm(pixels: &Node, axis: &str) -> Option<f64> {
    let size: f64 = pixels.attribute(format!("PhysicalSize{axis}").as_str())?.parse().ok()?;
    let unit = pixels.attribute(format!("PhysicalSize{axis}Unit").as_str()).unwrap_or("µm");
    Some(size * unit_mm(unit)?)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn xml(attributes: &str, data: &str) -> String {
        format!(
            "<?xml version=\"1.0\"?><OME xmlns=\"http://www.openmicroscopy.org/Schemas/OME/2016-06\"><Image>\
             <Pixels {attributes}>{data}</Pixels></Image></OME>"
        )
    }

    #[test]
    fn sizes_order_and_units() {
        let sizes = "SizeC=\"2\" SizeZ=\"3\" SizeT=\"1\" DimensionOrder=\"XYZCT\"";
        let edges = "PhysicalSizeX=\"0.5\" PhysicalSizeZ=\"2000\" PhysicalSizeZUnit=\"nm\"";
        let stack = hyperstack(&xml(&format!("{sizes} {edges}"), "<TiffData/>"), 6, 1).unwrap();
        assert_eq!(stack.counts, [2, 3, 1]);
        assert_eq!(stack.pages, [0, 3, 1, 4, 2, 5].map(Some));
        assert_eq!(stack.voxel_mm, [Some(0.5e-3), None, Some(2e-3)]);
    }

    #[test]
    fn pages_lie_where_they_are_said_to() {
        let data = "<TiffData IFD=\"1\" FirstZ=\"0\"/><TiffData IFD=\"0\" FirstZ=\"1\" PlaneCount=\"1\"/>";
        let stack = hyperstack(&xml("SizeZ=\"2\"", data), 2, 1).unwrap();
        assert_eq!(stack.pages, [Some(1), Some(0)]);
    }

    /// The parser would overflow the stack.
    #[test]
    fn deep_xml_is_refused() {
        let said = |depth: usize| {
            let deep = format!("{}{}", "<a>".repeat(depth), "</a>".repeat(depth));
            hyperstack(&xml("SizeZ=\"1\"", &deep), 1, 1)
        };
        assert!(said(50).is_ok());
        assert!(said(1_000_000).unwrap_err().contains("64 deep"));
    }

    #[test]
    fn what_cannot_be_is_said() {
        let said = |attributes, pages| hyperstack(&xml(attributes, ""), pages, 1).unwrap_err();
        assert!(said("SizeZ=\"4294967295\" SizeC=\"4294967295\"", 2).contains("promises"));
        assert!(said("SizeZ=\"-1\"", 2).contains("a number"));
        assert!(said("DimensionOrder=\"XYZZZ\"", 2).contains("DimensionOrder"));
        assert!(hyperstack("<OME><Pixels", 1, 1).unwrap_err().contains("damaged"));
    }
}
