//! Many random scenes: each can be made again from seed and number.

use super::{Difference, Found, RandomScene, Verdict, Wanted, check, display, scenes};
use proptest::strategy::{Strategy, ValueTree};
use proptest::test_runner::{Config, RngAlgorithm, TestRng, TestRunner};
use std::fmt;
use std::panic::{AssertUnwindSafe, catch_unwind};

/// After so many cases a run says how far it is.
const TOLD: u64 = 50;

/// Share of the pixels whose truth the reference may fail to find, as rays that strong refraction scatters. Here as below, a
/// quarter above the most of forty scenes in a row of 1,360.
const UNKNOWN: f64 = 0.007;
/// Share of the pixels that may be excused by their condition.
const ILL: f64 = 0.007;
/// Share of the pixels that may need shorter steps.
const UNSEEN: f64 = 0.002;
/// Share of the pixels that row planes may show otherwise: of 300 scenes it was 0.9 %.
const OFF_BY_PLANES: f64 = 0.02;
/// Share of the lit pixels of which a fault of a code may go unseen.
const BLUNT: f64 = 0.15;

/// Which scenes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Plan {
    /// What all cases follow from.
    pub seed: u64,
    /// The first case's number.
    pub first: u64,
    /// How many.
    pub cases: u64,
    /// The features they may have.
    pub wanted: Wanted,
    /// Times that a case that fails is made simpler, and drawn again.
    pub tries: usize,
}

/// What came of them.
#[derive(Clone, Debug, Default)]
pub struct Summary {
    /// Scenes drawn.
    pub cases: u64,
    /// Of them with something to see.
    pub lit: u64,
    /// Of these compared with the truth.
    pub compared: u64,
    /// Of these with nothing steep.
    pub tame: u64,
    /// Pixels whose truth is known, and those of which it is not.
    pub known: [usize; 2],
    /// Of some pixels that show anything, those of which a fault of a code would be seen, and all.
    pub sharp: [usize; 2],
    /// All devices' pixels together.
    pub verdict: Verdict,
    /// Pixels of row planes together.
    pub by_planes: Verdict,
    /// Scenes whose pictures by row planes would have failed if they were by rays.
    pub failed_by_planes: Vec<u64>,
    /// The scene whose kernel and twin differ most, of all and of those with nothing steep.
    pub rounding: [Option<Worst<Difference>>; 2],
    /// The scene with most pixels off the truth.
    pub truth: Option<Worst<Verdict>>,
    /// Cases that failed, with what is wrong.
    pub failed: Vec<String>,
}

/// The worst case of a kind.
#[derive(Clone, Debug)]
pub struct Worst<D> {
    /// Its number.
    pub case: u64,
    /// By how much.
    pub difference: D,
    /// The scene.
    pub scene: RandomScene,
}

/// Draws the scenes of a plan one after the other.
pub fn run(plan: &Plan) -> Summary {
    let display = display();
    let mut summary = Summary::default();
    for case in plan.first..plan.first + plan.cases {
        let mut tree = tree(plan, case);
        let scene = tree.current();
        let found = drawn(&display, &scene);
        if !found.wrong.is_empty() {
            println!("case {case} fails: {}", found.wrong.join("; "));
            let simplest = simplest(&display, &mut tree, plan.tries);
            summary.failed.push(told(plan, case, &found, simplest.as_ref()));
        }
        summary.add(case, scene, &found);
        if summary.cases.is_multiple_of(TOLD) && summary.cases < plan.cases {
            println!("{} of {} cases, {} failed", summary.cases, plan.cases, summary.failed.len());
        }
    }
    summary
}

fn tree(plan: &Plan, case: u64) -> impl ValueTree<Value = RandomScene> {
    let mut seed = [0; 32];
    seed[..8].copy_from_slice(&plan.seed.to_le_bytes());
    seed[8..16].copy_from_slice(&case.to_le_bytes());
    let rng = TestRng::from_seed(RngAlgorithm::ChaCha, &seed);
    let mut runner = TestRunner::new_with_rng(Config::default(), rng);
    scenes(plan.wanted).new_tree(&mut runner).expect("the strategy refuses nothing")
}

/// A scene's check; a panic within is one more thing that is wrong.
fn drawn(display: &display_config::Display, scene: &RandomScene) -> Found {
    catch_unwind(AssertUnwindSafe(|| check(display, scene))).unwrap_or_else(|panic| {
        let told = panic.downcast_ref::<String>().map(String::as_str);
        let told = told.or(panic.downcast_ref::<&str>().copied()).unwrap_or("no message");
        Found { wrong: vec![format!("panic: {told}")], ..Found::default() }
    })
}

/// The simplest scene that still fails, as far as the tries reach.
fn simplest(
    display: &display_config::Display,
    tree: &mut impl ValueTree<Value = RandomScene>,
    tries: usize,
) -> Option<RandomScene> {
    let mut simplest = None;
    let mut fails = true;
    for _ in 0..tries {
        let has_more = if fails { tree.simplify() } else { tree.complicate() };
        if !has_more {
            break;
        }
        let scene = tree.current();
        fails = !drawn(display, &scene).wrong.is_empty();
        if fails {
            simplest = Some(scene);
        }
    }
    simplest
}

fn told(plan: &Plan, case: u64, found: &Found, simplest: Option<&RandomScene>) -> String {
    let again =
        format!("LIGHTLOOM_RANDOM_SEED={} LIGHTLOOM_RANDOM_FIRST={case} LIGHTLOOM_RANDOM_CASES=1", plan.seed);
    let scene = tree(plan, case).current();
    let simpler = simplest.map(|scene| format!("\na simpler one: {scene:#?}")).unwrap_or_default();
    format!("{}\nagain by {again}\n{scene:#?}{simpler}", found.wrong.join("\n"))
}

impl Summary {
    fn add(&mut self, case: u64, scene: RandomScene, found: &Found) {
        let is_tame = scene.is_tame();
        self.cases += 1;
        self.lit += u64::from(found.lit > 0);
        self.compared += u64::from(found.truth.is_some());
        self.tame += u64::from(found.truth.is_some() && is_tame);
        for i in 0..2 {
            self.known[i] += found.truth.map_or(0, |known| known[i]);
            self.sharp[i] += found.sharp[i];
        }
        let worst = &mut self.rounding[usize::from(is_tame)];
        if let Some(difference) = found.rounding
            && worst.as_ref().is_none_or(|worst| worst.difference.mean < difference.mean)
        {
            *worst = Some(Worst { case, difference, scene: scene.clone() });
        }
        found.by_rays.iter().for_each(|verdict| self.verdict = self.verdict.and(verdict));
        found.by_planes.iter().for_each(|verdict| self.by_planes = self.by_planes.and(verdict));
        self.failed_by_planes.extend(found.by_planes.filter(|verdict| !verdict.holds()).map(|_| case));
        for &verdict in &found.by_rays {
            if self.truth.as_ref().is_none_or(|worst| worst.difference.off() < verdict.off()) {
                self.truth = Some(Worst { case, difference: verdict, scene: scene.clone() });
            }
        }
    }

    /// What too many scenes have for the comparison to mean anything, a sentence each.
    pub fn shortcomings(&self) -> Vec<&'static str> {
        let share = |part: usize, of: usize| part as f64 / of.max(1) as f64;
        let Self {
            cases,
            lit,
            known: [known, unknown],
            sharp: [sharp, asked],
            ref verdict,
            ref by_planes,
            ..
        } = *self;
        let all = [
            (4 * lit < 3 * cases, "too few show anything"),
            (share(unknown, known + unknown) > UNKNOWN, "too many pixels have no truth"),
            (share(verdict.ill, verdict.pixels) > ILL, "too many pixels are ill-conditioned"),
            (share(verdict.unseen, verdict.pixels) > UNSEEN, "too many pixels need shorter steps"),
            (
                share(by_planes.off(), by_planes.pixels) > OFF_BY_PLANES,
                "too many pixels of row planes are off",
            ),
            (share(asked - sharp, asked) > BLUNT, "too few pixels would show a fault of a code"),
        ];
        all.into_iter().filter(|(is_short, _)| *is_short).map(|(_, what)| what).collect()
    }
}

impl fmt::Display for Summary {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let Self { cases, lit, compared, tame, failed, known: [known, unknown], sharp, .. } = self;
        let fails = failed.len();
        writeln!(
            f,
            "{cases} scenes, {lit} lit, {compared} of these compared with the truth, {tame} of these tame, {fails} failed"
        )?;
        writeln!(f, "truth known of {known} pixels, unknown of {unknown}")?;
        writeln!(f, "of {} lit pixels a fault of a code would be seen in {}", sharp[1], sharp[0])?;
        writeln!(f, "rays, all devices: {}", self.verdict)?;
        let of_planes = self.failed_by_planes.len();
        writeln!(
            f,
            "row planes, off in {of_planes} scenes, {:?}: {}",
            self.failed_by_planes, self.by_planes
        )?;
        for (worst, of) in self.rounding.iter().zip(["steep", "tame"]) {
            if let Some(Worst { case, difference, .. }) = worst {
                writeln!(f, "kernel and twin, worst of the {of} scenes: case {case}: {difference}")?;
            }
        }
        if let Some(Worst { case, difference, .. }) = &self.truth {
            writeln!(f, "truth, worst: case {case}: {difference}")?;
        }
        Ok(())
    }
}
