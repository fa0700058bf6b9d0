//! What frame control asks of back-ends, and what it shows.

use super::*;
use control::Weights;
use glam::{DAffine3, DVec3};
use optics::{Curve, Optics};
use protocol::{Mark, MarkShape, Paint};

const NOW: Duration = Duration::from_secs(1);

fn state(index: u32, x: f64) -> FrameState {
    let optics = Optics::grey(Curve::constant(1.0));
    let place = DAffine3::from_translation(DVec3::new(x, 0.0, 0.0));
    FrameState { index, time_s: f64::from(index), ..FrameState::still(DVec3::Z, place, optics) }
}

fn controlled(units: u32) -> Controlled {
    let weights = Weights { rho: 0.6, theta: 0.0, chi: 0.0 };
    Controlled::new(Rule::Errors(weights), Budget::Fixed(units))
}

/// A back-end has drawn a task: so far from the newest state, and so wrong.
fn answer(controlled: &mut Controlled, task: &Task, [spatial, change]: [u64; 2], has_detail: bool) -> bool {
    let done = task.frame.refinement.unwrap().to;
    let compared = u64::from(task.newest.is_some() || done == controlled.budget.units());
    let spatial = if done == Refinement::UNITS { 0 } else { spatial * Refined::UNIT / 100 };
    let change = change * Refined::UNIT / 100;
    let refined = Refined { done, pixels: 1, spatial, compared, change, has_detail };
    let report = FrameReport { frame: task.frame.index, refined: Some(refined), ..FrameReport::default() };
    controlled.drawn(&report);
    controlled.finished(NOW)
}

#[test]
fn a_still_world_is_cast_once_and_rests() {
    let mut controlled = controlled(16);
    let mut shown = Vec::new();
    for index in 0..6 {
        let Some(task) = controlled.next(state(index, 0.0), NOW, || false) else {
            shown.push(None);
            continue;
        };
        assert!(task.newest.is_none());
        let to = task.frame.refinement.unwrap().to;
        shown.push(answer(&mut controlled, &task, [40 - u64::from(to) / 2, 0], false).then_some(to));
    }
    assert_eq!(shown, [Some(16), Some(32), Some(48), Some(64), None, None]);
    let summary = controlled.summary();
    assert_eq!((summary.begun, summary.shown, summary.shown_complete), (1, 4, 1));
    assert!((summary.idle_share - 2.0 / 6.0).abs() < 1e-12);
}

#[test]
fn what_moves_is_looked_at_and_begun_anew_when_it_is_far() {
    let mut controlled = controlled(8);
    let first = controlled.next(state(0, 0.0), NOW, || false).unwrap();
    answer(&mut controlled, &first, [20, 0], false);
    let second = controlled.next(state(1, 0.1), NOW, || false).unwrap();
    assert_eq!(
        second.frame.display_from_volume,
        state(0, 0.0).display_from_volume,
        "it goes on with the old state"
    );
    assert_eq!(
        second.newest.as_ref().map(|newest| newest.display_from_volume),
        Some(state(1, 0.1).display_from_volume)
    );
    assert!(!answer(&mut controlled, &second, [20, 5], false));
    let third = controlled.next(state(2, 0.2), NOW, || false).unwrap();
    assert_eq!(third.frame.refinement.unwrap(), Refinement { configuration: 1, to: 24 });
    assert!(answer(&mut controlled, &third, [20, 15], false), "a restart triggers show");
    let fourth = controlled.next(state(3, 0.3), NOW, || true).unwrap();
    assert_eq!(fourth.frame.refinement.unwrap(), Refinement { configuration: 2, to: 8 });
    assert_eq!(fourth.frame.display_from_volume, state(3, 0.3).display_from_volume);
    assert!(fourth.frame.welcomes_planes && fourth.newest.is_none());
    answer(&mut controlled, &fourth, [20, 0], false);
    let fifth = controlled.next(state(4, 0.4), NOW, || false).unwrap();
    assert!(fifth.newest.is_some_and(|newest| newest.welcomes_planes), "both are cast alike");
}

#[test]
fn a_picture_of_rows_begins_with_every_eighth() {
    let mut controlled = controlled(2);
    let first = controlled.next(state(0, 0.0), NOW, || true).unwrap();
    assert_eq!(first.frame.refinement.unwrap().to, 2, "nobody knows yet who casts");
    let caster = Caster::Planes { views: 8, fans: 1, resampled: 0 };
    controlled.drawn(&FrameReport { caster, ..FrameReport::default() });
    controlled.finished(NOW);
    let second = controlled.next(state(1, 0.0), NOW, || true).unwrap();
    assert_eq!(second.frame.refinement.unwrap().to, 4, "what goes on does so by its budget");
    controlled.finished(NOW);
    for index in 2..40 {
        let _ = controlled.next(state(index, 0.0), NOW, || true);
        controlled.finished(NOW);
    }
    let moved = controlled.next(state(99, 0.5), NOW, || true).unwrap();
    assert_eq!(moved.frame.refinement.unwrap().to, 8);
}

#[test]
fn marks_move_over_a_picture_that_rests() {
    let mut controlled = controlled(64);
    let task = controlled.next(state(0, 0.0), NOW, || false).unwrap();
    assert!(answer(&mut controlled, &task, [0, 0], false));
    let paint = Paint { rgb: [1.0; 3], opacity: 1.0 };
    let shape = MarkShape::Stroke { points_in_display: vec![DVec3::X], radius_m: 0.01 };
    let marked = FrameState { marks: vec![Mark { shape, paint, is_depth_combined: false }], ..state(1, 0.0) };
    let task = controlled.next(marked.clone(), NOW, || false).unwrap();
    assert_eq!(task.frame.refinement.unwrap(), Refinement { configuration: 1, to: 64 });
    assert_eq!(task.frame.marks, marked.marks);
    assert!(controlled.finished(NOW), "it is shown, whatever rays see");
    assert!(controlled.next(FrameState { index: 2, ..marked }, NOW, || false).is_none());
}

#[test]
fn detail_begins_a_picture_anew() {
    let mut controlled = controlled(64);
    let task = controlled.next(state(0, 0.0), NOW, || false).unwrap();
    answer(&mut controlled, &task, [0, 0], true);
    let task = controlled.next(state(1, 0.0), NOW, || false).unwrap();
    assert_eq!(task.frame.refinement.unwrap().configuration, 2);
    assert!((task.frame.time_s - 1.0).abs() < 1e-12, "fades go by the time of what is cast");
    answer(&mut controlled, &task, [0, 1], false);
    assert!(controlled.next(state(2, 0.0), NOW, || false).is_none());
    assert_eq!(controlled.summary().begun_for_detail, 1);
}
