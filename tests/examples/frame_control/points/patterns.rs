//! The patterns that are compared, and how even they are.

use lightloom_tests::points::{Pattern, Torus, Wish};
use lightloom_tests::results::Results;
use std::path::Path;
use std::time::Instant;

/// The pictures are as high to their width.
const TORUS: Torus = Torus { edges: [4, 3] };
/// As Balzer et al. do.
const POINTS_PER_SITE: usize = 1024;
const SEED: u64 = 1;
const MOST_PASSES: u32 = 10_000;
/// The pattern of the paper's 16,384 sites, and the command that made it.
const FULL: &str = "data/points_16384.bin";

/// What is compared.
pub struct Patterns {
    /// 16,384 sites, from a file.
    pub full: Pattern,
    /// 243: level 4 has 3.24 for each of 160 × 120 pixels, as the paper's has for its screen.
    pub small: Pattern,
    /// 300 and 150: their levels have powers of 1/2 for each of 160 × 120 pixels.
    pub even: [Pattern; 2],
    /// 300 in the cells of a grid.
    pub jittered: Pattern,
}

impl Patterns {
    /// Reads or makes them.
    pub fn new(results: &mut Results) -> Result<Self, String> {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(FULL);
        let bytes = std::fs::read(&path).map_err(|error| format!("{}: {error}", path.display()))?;
        results.line("| pattern | sites | closest two, of a hexagonal lattice's | power of low frequencies | passes | made in, s |");
        results.line("| --- | ---: | ---: | ---: | ---: | ---: |");
        let full = Pattern::from_bytes(&bytes)?;
        row(results, "capacity-constrained, from a file", &full, "– | –");
        let mut made = |sites| {
            let (wish, began) =
                (Wish { torus: TORUS, sites, per_site: POINTS_PER_SITE, seed: SEED }, Instant::now());
            let (pattern, passes) = Pattern::capacity_constrained(wish, MOST_PASSES);
            let took = format!("{passes} | {:.1}", began.elapsed().as_secs_f64());
            row(results, "capacity-constrained", &pattern, &took);
            pattern
        };
        let (small, even) = (made(243), [300, 150].map(&mut made));
        let jittered = Pattern::jittered(TORUS, [20, 15], SEED);
        row(results, "one in each cell of 20 × 15", &jittered, "– | –");
        row(results, "white noise", &Pattern::white(TORUS, 300, SEED), "– | –");
        results.line("");
        Ok(Self { full, small, even, jittered })
    }
}

fn row(results: &mut Results, name: &str, pattern: &Pattern, made: &str) {
    results.line(format!(
        "| {name} | {} | {:.3} | {:.4} | {made} |",
        pattern.places().len(),
        pattern.normalised_radius(),
        pattern.low_power(),
    ));
}
