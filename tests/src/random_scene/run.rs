//! Many random scenes: each can be made again from seed and number.

use super::{Difference, Found, RandomScene, Wanted, check, display, scenes};
use proptest::strategy::{Strategy, ValueTree};
use proptest::test_runner::{Config, RngAlgorithm, TestRng, TestRunner};
use std::fmt;
use std::panic::{AssertUnwindSafe, catch_unwind};

/// Times that a case that fails is made simpler, and drawn again.
const SIMPLER: usize = 60;

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
}

/// What came of them.
#[derive(Clone, Debug, Default)]
pub struct Summary {
    /// Scenes drawn.
    pub cases: u64,
    /// Of them compared with the truth, and with something to see.
    pub compared: u64,
    /// Of these with nothing steep.
    pub tame: u64,
    /// The scene whose kernel and twin differ most, of all and of those with nothing steep.
    pub rounding: [Option<Worst>; 2],
    /// The scene farthest from the truth, likewise.
    pub truth: [Option<Worst>; 2],
    /// Cases that failed, with what is wrong.
    pub failed: Vec<String>,
}

/// The worst case of a kind.
#[derive(Clone, Debug)]
pub struct Worst {
    /// Its number.
    pub case: u64,
    /// By how much.
    pub difference: Difference,
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
            let simplest = simplest(&display, &mut tree);
            summary.failed.push(told(plan, case, &found, simplest.as_ref()));
        }
        summary.add(case, scene, &found);
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
) -> Option<RandomScene> {
    let mut simplest = None;
    let mut fails = true;
    for _ in 0..SIMPLER {
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
        let (is_tame, is_lit) = (scene.is_tame(), found.lit > 0);
        self.cases += 1;
        self.compared += u64::from(is_lit);
        self.tame += u64::from(is_lit && is_tame);
        let keep = |worst: &mut Option<Worst>, difference: Option<Difference>| {
            let Some(difference) = difference else { return };
            if worst.as_ref().is_none_or(|worst| worst.difference.mean < difference.mean) {
                *worst = Some(Worst { case, difference, scene: scene.clone() });
            }
        };
        keep(&mut self.rounding[usize::from(is_tame)], found.rounding);
        keep(&mut self.truth[usize::from(is_tame)], found.truth);
    }
}

impl fmt::Display for Summary {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let Self { cases, compared, tame, failed, .. } = self;
        let fails = failed.len();
        writeln!(
            f,
            "{cases} scenes, {compared} lit and compared with the truth, {tame} of these tame, {fails} failed"
        )?;
        let kinds = [("kernel and twin", &self.rounding), ("truth", &self.truth)];
        for (what, worst) in kinds {
            for (worst, of) in worst.iter().zip(["steep", "tame"]) {
                if let Some(Worst { case, difference, .. }) = worst {
                    writeln!(f, "{what}, worst of the {of} scenes: case {case}: {difference}")?;
                }
            }
        }
        Ok(())
    }
}
