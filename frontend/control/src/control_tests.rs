//! Laws of frame control.

use super::*;
use crate::{Budget, Weights};
use proptest::prelude::*;

const UNITS: u32 = 64;
const TICK: Duration = Duration::from_millis(16);

fn changed() -> News {
    News { has_changed: true, has_detail: false }
}

/// A tick that has found something.
fn found(done: u32, spatial: f64, change: Option<f64>) -> Found {
    let has_changed = done > 1 && change.is_some();
    Found { done, spatial, change, news: News { has_changed, has_detail: false } }
}

fn by(rho: f64, theta: f64, chi: f64) -> Control {
    Control::new(Rule::Errors(Weights { rho, theta, chi }), UNITS)
}

/// A control with a complete picture on the screens.
fn at_rest(mut control: Control) -> Control {
    assert_eq!(control.next(changed(), TICK), Work::Begin);
    assert!(control.found(found(1, 0.5, None), TICK), "whatever comes first is shown");
    assert_eq!(control.next(News::default(), TICK), Work::Refine { from: 1 });
    assert!(control.found(found(UNITS, 0.0, None), TICK));
    assert_eq!(control.next(News::default(), TICK), Work::Rest);
    control
}

#[test]
fn a_complete_picture_rests_until_something_changes() {
    let mut control = at_rest(by(0.6, 0.0, 0.0));
    for _ in 0..1000 {
        assert_eq!(control.next(News::default(), TICK), Work::Rest);
    }
    assert_eq!(control.next(changed(), TICK), Work::Begin);
}

#[test]
fn a_picture_is_given_up_when_the_newest_is_farther_from_it_than_it_may_err() {
    for (rho, change, gives_up) in
        [(0.5, 0.09, false), (0.5, 0.11, true), (0.6, 0.08, true), (0.0, 9.0, false), (1.0, 1e-9, true)]
    {
        let mut control = at_rest(by(rho, 0.0, 0.0));
        assert_eq!(control.next(changed(), TICK), Work::Begin);
        control.found(found(1, 0.2, Some(0.3)), TICK);
        assert_eq!(control.next(changed(), TICK), Work::Refine { from: 1 });
        let shows = control.found(found(4, 0.1, Some(change)), TICK);
        assert_eq!(shows, gives_up, "ρ {rho}: a restart triggers show, and nothing else does");
        let next = control.next(changed(), TICK);
        assert_eq!(next == Work::Begin, gives_up, "ρ {rho}: {next:?}");
    }
}

#[test]
fn without_a_change_nothing_is_given_up() {
    let mut control = at_rest(by(1.0, 1.0, 0.0));
    control.next(changed(), TICK);
    control.found(found(1, 0.2, Some(0.3)), TICK);
    for done in 2..UNITS {
        assert_eq!(control.next(News::default(), TICK), Work::Refine { from: done - 1 });
        control.found(found(done, 0.2, Some(0.0)), TICK);
    }
}

#[test]
fn a_newer_picture_is_shown_by_what_it_is_ahead_and_what_it_lacks() {
    // 0.3 ahead of a complete one.
    for (theta, spatial, shows) in
        [(0.0, 0.01, false), (0.5, 0.29, true), (0.5, 0.31, false), (1.0, 0.9, true)]
    {
        let mut control = at_rest(by(0.0, theta, 0.0));
        control.next(changed(), TICK);
        assert_eq!(control.found(found(1, spatial, Some(0.3)), TICK), shows, "ϑ {theta}, ζ {spatial}");
    }
}

#[test]
fn a_pause_lasts_a_second_at_most() {
    let mut control = by(0.6, 0.0, 0.1);
    control.next(changed(), Duration::ZERO);
    control.found(found(1, 0.05, None), Duration::ZERO);
    let mut now = Duration::ZERO;
    let mut rested = 0;
    while control.next(News::default(), now) == Work::Rest {
        now += TICK;
        rested += 1;
    }
    assert_eq!(rested, 63, "a second of 16 ms");
    assert_eq!(control.next(News::default(), now), Work::Refine { from: 1 });
}

#[test]
fn fixed_rules_give_up_at_their_target_and_only_for_something_new() {
    let period = Duration::from_millis(100);
    let mut rate = at_rest(Control::new(Rule::Rate { period }, UNITS));
    rate.next(changed(), TICK);
    assert!(!rate.found(found(1, 0.5, Some(0.2)), TICK));
    assert_eq!(rate.next(changed(), 2 * TICK), Work::Refine { from: 1 });
    assert!(!rate.found(found(2, 0.5, Some(0.2)), 2 * TICK));
    rate.next(changed(), 8 * TICK);
    assert!(rate.found(found(3, 0.5, Some(0.2)), 8 * TICK));
    assert_eq!(rate.next(changed(), 8 * TICK), Work::Begin);

    let mut quality = at_rest(Control::new(Rule::Quality { share: 0.25 }, UNITS));
    quality.next(changed(), TICK);
    assert!(!quality.found(found(8, 0.5, Some(0.2)), TICK));
    quality.next(changed(), TICK);
    assert!(quality.found(found(16, 0.5, Some(0.2)), TICK));
    assert_eq!(quality.next(changed(), TICK), Work::Begin);
}

#[test]
fn detail_that_changes_little_waits_for_the_complete_picture() {
    let detail = News { has_changed: false, has_detail: true };
    let mut control = at_rest(by(0.6, 0.0, 0.0));
    assert_eq!(control.next(detail, TICK), Work::Begin);
    control.found(Found { done: 1, spatial: 0.2, change: Some(1e-4), news: detail }, TICK);
    for done in 2..=UNITS {
        assert_eq!(control.next(detail, TICK), Work::Refine { from: done - 1 });
        control.found(Found { done, spatial: 0.2 / f64::from(done), change: None, news: detail }, TICK);
    }
    assert_eq!(control.next(detail, TICK), Work::Begin);
}

fn rules() -> impl Strategy<Value = Rule> {
    let weights = (0.0..=1.0, 0.0..=1.0, 0.0..=1.0);
    prop_oneof![
        weights.prop_map(|(rho, theta, chi)| Rule::Errors(Weights { rho, theta, chi })),
        (1_u64..2000).prop_map(|ms| Rule::Rate { period: Duration::from_millis(ms) }),
        (0.01..=1.0).prop_map(|share| Rule::Quality { share }),
    ]
}

/// What a tick may find, and whether the world has moved before it.
fn ticks() -> impl Strategy<Value = Vec<(u32, f64, f64, bool, bool)>> {
    let error = prop_oneof![Just(0.0), 0.0..1e-6, 0.0..2.0];
    proptest::collection::vec((1_u32..40, error.clone(), error, any::<bool>(), any::<bool>()), 0..60)
}

proptest! {
    /// From any state of errors, with inputs still, a complete picture is shown within bounded steps, and then all rests.
    #[test]
    fn a_still_world_comes_to_its_complete_picture(rule in rules(), ticks in ticks()) {
        let mut control = Control::new(rule, UNITS);
        let (mut now, mut done) = (Duration::ZERO, 0);
        // Whether the world is ahead of what is cast: from the beginning on, until something is begun.
        let mut is_behind = true;
        for (count, spatial, change, moves, has_detail) in ticks {
            is_behind |= moves;
            let news = News { has_changed: is_behind, has_detail };
            now += TICK;
            match control.next(news, now) {
                Work::Rest => continue,
                Work::Begin => (done, is_behind) = (count.min(UNITS), false),
                Work::Refine { from } => {
                    prop_assert_eq!(from, done);
                    done = (done + count).min(UNITS);
                }
            }
            let spatial = if done == UNITS { 0.0 } else { spatial };
            let news = News { has_changed: is_behind, has_detail };
            control.found(Found { done, spatial, change: Some(change), news }, now);
        }
        let mut is_complete_shown = false;
        for _ in 0..2 * UNITS + 70 {
            now += TICK;
            let news = News { has_changed: is_behind, has_detail: false };
            match control.next(news, now) {
                Work::Rest => {}
                Work::Begin => (done, is_behind) = (1, false),
                Work::Refine { .. } => done += 1,
            }
            let spatial = if done == UNITS { 0.0 } else { 0.3 };
            let news = News { has_changed: is_behind, has_detail: false };
            let shows = done <= UNITS && control.found(Found { done, spatial, change: None, news }, now);
            is_complete_shown |= shows && done == UNITS;
            if done == UNITS {
                break;
            }
        }
        prop_assert!(is_complete_shown || done == UNITS);
        prop_assert_eq!(control.next(News::default(), now), Work::Rest);
    }

    /// However fast the world moves, something is shown: a picture is given up only once it is, or is complete.
    #[test]
    fn a_world_that_never_rests_is_shown(rule in rules(), unit_ms in 1_u64..500) {
        let mut control = Control::new(rule, UNITS);
        let mut budget = Budget::of_time(TICK);
        let (mut now, mut done, mut shown, mut begun) = (Duration::ZERO, 0, 0, 0);
        for _ in 0..20 * UNITS {
            let units = budget.units();
            match control.next(News { has_changed: true, has_detail: false }, now) {
                Work::Rest => prop_assert!(false, "something has changed"),
                Work::Begin => { done = 0; begun += 1; }
                Work::Refine { .. } => {}
            }
            let cast = units.min(UNITS - done);
            done += cast;
            let took = Duration::from_millis(unit_ms) * cast;
            now += took;
            budget.took(cast, took, took);
            let spatial = 0.1 * f64::from(UNITS - done) / f64::from(UNITS);
            let news = News { has_changed: true, has_detail: false };
            shown += u32::from(control.found(Found { done, spatial, change: Some(0.05), news }, now));
        }
        prop_assert!(shown + 1 >= begun, "{begun} begun, {shown} shown");
    }
}
