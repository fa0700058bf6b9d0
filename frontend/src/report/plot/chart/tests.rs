//! Laws of a plot.

use super::super::{Mark, Point};
use super::*;
use proptest::prelude::*;
use roxmltree::{Document, Node};

fn series(name: &str, points: &[(f64, f64)]) -> Series {
    let point = |&(x, y): &(f64, f64)| Point { x, y, title: format!("{x} & {y}") };
    Series::new(name, points.iter().map(point).collect())
}

fn chart(series: Vec<Series>) -> Chart {
    Chart { title: "a < b".into(), x_label: "seconds".into(), y_label: "error & more".into(), series }
}

fn number(node: &Node, name: &str) -> f64 {
    node.attribute(name).unwrap().parse().unwrap()
}

/// The places of all shapes and lines inside the box and beside it in the legend.
fn places(document: &Document) -> Vec<(f64, f64)> {
    let mut found = Vec::new();
    for node in document.descendants().filter(Node::is_element) {
        match node.tag_name().name() {
            "circle" => found.push((number(&node, "cx"), number(&node, "cy"))),
            "polyline" => {
                for pair in node.attribute("points").unwrap().split(' ').filter(|pair| !pair.is_empty()) {
                    let (x, y) = pair.split_once(',').unwrap();
                    found.push((x.parse().unwrap(), y.parse().unwrap()));
                }
            }
            _ => {}
        }
    }
    found
}

#[test]
fn names_and_titles_cannot_break_it() {
    let named = series("<&\">", &[(1.0, 2.0), (3.0, 4.0)]).mark(Mark::Diamond).stroke(Stroke::Dashed);
    let svg = chart(vec![named.label("it's"), series("none", &[])]).svg();
    let document = Document::parse(&svg).unwrap();
    let texts = document.descendants().filter(|node| node.tag_name().name() == "text");
    let texts: Vec<_> = texts.filter_map(|node| node.text()).collect();
    for words in ["a < b", "error & more", "<&\">", "it's"] {
        assert!(texts.contains(&words), "{words} is not in {texts:?}");
    }
    assert!(!svg.contains("NaN") && !svg.contains("inf"), "{svg}");
}

#[test]
fn every_mark_has_its_shape_and_a_wide_line_lies_behind() {
    for mark in [Mark::Dot, Mark::Square, Mark::Diamond, Mark::Triangle, Mark::Ring] {
        let svg = chart(vec![series("s", &[(1.0, 1.0)]).mark(mark)]).svg();
        // One at the point, one in the legend.
        assert_eq!(svg.matches("class=\"plot-mark").count() + svg.matches("class=\"plot-ring").count(), 2);
    }
    let thin = series("thin", &[(1.0, 1.0), (2.0, 2.0)]).stroke(Stroke::Thin);
    let wide = series("wide", &[(1.0, 1.0), (2.0, 2.0)]).stroke(Stroke::Wide);
    let svg = chart(vec![thin, wide]).svg();
    assert!(svg.find("\"plot-wide").unwrap() < svg.find("\"plot-line").unwrap());
}

#[test]
fn many_series_make_room_for_their_legend() {
    let many: Vec<Series> = (0..40).map(|i| series(&i.to_string(), &[(1.0, 1.0)]).mark(Mark::Dot)).collect();
    let svg = chart(many).svg();
    let document = Document::parse(&svg).unwrap();
    let height = number(&document.root_element(), "height");
    assert!(places(&document).iter().all(|place| place.1 < height - FOOT), "{height}");
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 60, rng_seed: proptest::test_runner::RngSeed::Fixed(11), failure_persistence: None, ..Default::default() })]

    #[test]
    fn all_points_lie_inside_the_box(
        points in proptest::collection::vec((-9.0f64..5.0, prop_oneof![Just(f64::NAN), -9.0f64..5.0]), 1..30)
    ) {
        let points: Vec<(f64, f64)> =
            points.iter().map(|(x, y)| (10f64.powf(*x), 10f64.powf(*y))).chain([(0.0, -1.0)]).collect();
        let svg = chart(vec![series("s", &points).mark(Mark::Dot).stroke(Stroke::Thin)]).svg();
        let document = Document::parse(&svg).unwrap();
        let bottom = TOP + LEAST_HEIGHT;
        let all = places(&document);
        // Each point and each corner of its line, and in the legend a dot and both ends of a piece of line.
        prop_assert_eq!(all.len(), 2 * points.len() + 3);
        let is_inside = |&(x, y): &(f64, f64)| (SIDES.0..=SIDES.1).contains(&x) && (TOP..=bottom).contains(&y);
        prop_assert_eq!(all.iter().filter(|place| is_inside(place)).count(), 2 * points.len());
    }
}
