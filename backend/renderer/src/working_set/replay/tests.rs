//! Laws of replays.

use super::*;
use crate::working_set::Demand;
use crate::working_set::test_world::{Random, World, optics, rule};
use glam::UVec3;
use protocol::VolumeRef;

pub(super) const FRAME_S: f64 = 1.0 / 30.0;
const FADE_S: f64 = 0.2;
/// All bricks of the test's volume fit.
const AMPLE: u64 = 1 << 30;

/// A disk that takes no time.
const INSTANT: DiskModel = DiskModel { bytes_per_s: f64::INFINITY, latency_s: 0.0, threads: 8 };
/// 300 bricks a second.
const SLOW: DiskModel = DiskModel { bytes_per_s: 300.0 * 65536.0, latency_s: 0.01, threads: 2 };

pub(super) const POLICY: Policy = Policy {
    cache_bytes: AMPLE,
    upload_bytes: AMPLE,
    disk: INSTANT,
    fade_s: FADE_S,
    order: FetchOrder::Deficit,
};

/// 16³ bricks of the finest level, in front of the screen and behind it.
pub(super) fn world() -> World {
    World::new(UVec3::splat(28 * 16), &mut Random(5))
}

pub(super) fn header(shape: &OctreeShape) -> TraceHeader {
    let rule = rule(shape, 0.0);
    TraceHeader {
        volume: VolumeRef::Store("made up".into()),
        dims: shape.dims(),
        display: "made up".into(),
        pixel_size_m: rule.pixel_size_m,
        angular_accuracy: rule.angular_accuracy,
    }
}

/// Rays that meet every finest node, each another number of them; the volume moves along z with `speed`.
pub(super) fn frames(world: &World, count: u32, speed: f64) -> Vec<TracedFrame> {
    let finest = world.shape.finest_depth();
    let nodes = world.shape.nodes(finest);
    let met: Vec<_> = nodes.map(|key| (key, 1 + key.cell.dot(UVec3::new(7, 11, 13)) % 29)).collect();
    let frame = |index| {
        let time_s = f64::from(index) * FRAME_S;
        let rule = rule(&world.shape, 0.1 + speed * time_s);
        TracedFrame {
            index,
            time_s,
            display_from_volume: rule.display_from_volume,
            lod_scale: rule.lod_scale,
            optics: optics(0.5).into(),
            demand: Demand::new(met.iter().copied()),
        }
    };
    (0..count).map(frame).collect()
}

fn run(world: &World, policy: &Policy, frames: &[TracedFrame]) -> ReplayRun {
    let summary = |key| world.summary(key);
    let volume = ReplayVolume { summary: &summary, brick_bytes: 65536 };
    let mut run = replay(&header(&world.shape), volume, policy, frames);
    run.frames.iter_mut().for_each(|frame| frame.update_ms = 0.0);
    run
}

#[test]
fn the_same_trace_and_policy_give_the_same_figures() {
    let world = world();
    let frames = frames(&world, 40, 0.2);
    let policy = Policy { cache_bytes: 20 << 20, disk: SLOW, order: FetchOrder::Arrival, ..POLICY };
    let first = run(&world, &policy, &frames);
    assert_eq!(first, run(&world, &policy, &frames));
    // The canary: another policy does not.
    assert_ne!(first, run(&world, &Policy { disk: INSTANT, ..policy }, &frames));
}

#[test]
fn with_room_and_an_instant_disk_all_is_fine_enough_within_the_fades_of_its_depths() {
    let world = world();
    let frames = frames(&world, 120, 0.0);
    let account = Account::of(&[run(&world, &POLICY, &frames)]);
    // A family appears once the one above it is complete; rays report it a frame later.
    let depths = f64::from(world.shape.finest_depth());
    let fade_s = Moment::fade_of(FADE_S, true);
    let most_s = depths * (fade_s + 3.0 * FRAME_S);
    let seconds = account.seconds_to_rest.unwrap();
    assert!(seconds > fade_s && seconds <= most_s, "{seconds} s of at most {most_s}");
    assert_eq!((account.deficit_at_end, account.loaded_again, account.collapses), (0.0, 0, 0));
    assert_eq!(account.bytes_read, account.bricks_loaded * 65536);
    let at_once = Account::of(&[run(&world, &Policy { fade_s: 0.0, ..POLICY }, &frames)]);
    assert!(at_once.seconds_to_rest.unwrap() <= 2.0 * depths * FRAME_S);
    assert_eq!(at_once.bricks_loaded, account.bricks_loaded);
}

#[test]
fn what_a_replay_met_is_met_again_by_the_same_policy() {
    let world = world();
    let policy = Policy { cache_bytes: 30 << 20, upload_bytes: 1 << 20, disk: SLOW, ..POLICY };
    let (header, summary) = (header(&world.shape), |key| world.summary(key));
    let volume = ReplayVolume { summary: &summary, brick_bytes: 65536 };
    let given = frames(&world, 60, 0.15);
    let mut recorder = Replay::new(&header, volume, policy);
    let record = |frame| {
        recorder.play(frame);
        let demand = Demand::new(recorder.met.iter().map(|met| (met.key, met.rays)));
        TracedFrame { demand, ..frame.clone() }
    };
    let recorded: Vec<TracedFrame> = given.iter().map(record).collect();
    assert_ne!(recorded, given);
    let first = run(&world, &policy, &given);
    assert!(first.frames.iter().any(|frame| frame.shortfall.is_some_and(|s| s.mean > 0.5)));
    assert_eq!(run(&world, &policy, &recorded), first);
}

#[test]
fn what_comes_keeps_within_disk_upload_and_cache() {
    let world = world();
    let frames = frames(&world, 50, 0.1);
    let policy = Policy { cache_bytes: 8 << 20, upload_bytes: 2 << 16, disk: SLOW, ..POLICY };
    let run = run(&world, &policy, &frames);
    let mut loaded = 0;
    for frame in &run.frames {
        loaded += frame.bricks_loaded;
        let most = (SLOW.bytes_per_s / 65536.0 * (frame.time_s - SLOW.latency_s)).max(0.0);
        assert!(loaded as f64 <= most, "{loaded} bricks by {} s", frame.time_s);
        assert!(frame.bricks_loaded <= 2 && frame.bricks_resident <= 128);
    }
    assert!(loaded > 50 && run.bricks_read >= loaded);
}

#[test]
fn a_small_cache_stays_coarse_and_a_moving_view_loads_again() {
    let world = world();
    let still = frames(&world, 120, 0.0);
    let small = Policy { cache_bytes: 6 << 20, ..POLICY };
    let account = Account::of(&[run(&world, &small, &still)]);
    assert_eq!(account.seconds_to_rest, None);
    let ample = Account::of(&[run(&world, &POLICY, &still)]);
    assert!(account.mean_deficit > ample.mean_deficit && account.deficit_at_end > 0.0);
    // There and back again.
    let mut moving = frames(&world, 120, -0.05);
    let back: Vec<_> = moving.iter().rev().map(|frame| frame.display_from_volume).collect();
    moving.iter_mut().zip(back).skip(60).for_each(|(frame, place)| frame.display_from_volume = place);
    let again =
        |cache_bytes| Account::of(&[run(&world, &Policy { cache_bytes, ..POLICY }, &moving)]).loaded_again;
    assert_eq!(again(AMPLE), 0, "what stays in the cache is not loaded twice");
    assert!(again(16 << 20) > 0);
}

#[test]
fn a_still_view_ends_with_the_same_bricks_in_whatever_order_they_came() {
    let world = world();
    let frames = frames(&world, 900, 0.0);
    let of = |order| Account::of(&[run(&world, &Policy { disk: SLOW, order, ..POLICY }, &frames)]);
    let [by_deficit, by_rays, by_arrival] =
        [FetchOrder::Deficit, FetchOrder::Rays, FetchOrder::Arrival].map(of);
    for account in [by_deficit, by_rays, by_arrival] {
        assert_eq!((account.deficit_at_end, account.loaded_again), (0.0, 0));
        assert_eq!(account.bricks_loaded, by_deficit.bricks_loaded);
    }
    // The canary: the order does something on the way there.
    assert_ne!(by_deficit.mean_deficit, by_rays.mean_deficit);
    assert_ne!(by_deficit.mean_deficit, by_arrival.mean_deficit);
}

#[test]
fn without_rays_there_is_no_deficit_and_the_root_alone() {
    let world = world();
    let mut frames = frames(&world, 5, 0.0);
    frames.iter_mut().for_each(|frame| frame.demand = Demand::default());
    let run = run(&world, &POLICY, &frames);
    assert!(run.frames.iter().all(|frame| frame.shortfall.is_none()));
    assert_eq!(run.bricks_read, 1);
}

#[test]
fn an_endless_wish_for_detail_has_a_number() {
    let world = world();
    let mut frames = frames(&world, 60, 0.0);
    frames.iter_mut().for_each(|frame| frame.lod_scale = 0.0);
    let account = Account::of(&[run(&world, &Policy { fade_s: 0.0, ..POLICY }, &frames)]);
    assert!(account.mean_deficit > 0.0 && account.mean_deficit.is_finite());
    assert_eq!(account.deficit_at_end, 0.0);
}
