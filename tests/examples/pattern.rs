//! Makes a capacity-constrained pattern and writes it to a file; says how even it is, and how long that takes.
//!
//! `cargo run --release -p lightloom-tests --example pattern -- SITES POINTS_PER_SITE SEED FILE`, on a torus of 4 : 3. The
//! file in `tests/data` is of `16384 1024 1`.

use lightloom_tests::points::{Capacity, Torus, Wish};
use std::time::Instant;

const TORUS: Torus = Torus { edges: [4, 3] };

fn main() -> Result<(), String> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [sites, per_site, seed, file] = &arguments[..] else {
        return Err("give SITES POINTS_PER_SITE SEED FILE".to_owned());
    };
    let number = |text: &String| text.parse::<usize>().map_err(|_| format!("{text:?} is no number"));
    let wish =
        Wish { torus: TORUS, sites: number(sites)?, per_site: number(per_site)?, seed: number(seed)? as u64 };
    let began = Instant::now();
    let mut capacity = Capacity::new(wish);
    let mut passes = 0;
    loop {
        let swaps = capacity.pass();
        passes += 1;
        if swaps == 0 {
            break;
        }
        if passes % 25 == 1 {
            println!("pass {passes}: {swaps} swaps, {:.0} s", began.elapsed().as_secs_f64());
        }
    }
    let pattern = capacity.pattern();
    println!("{passes} passes in {:.1} s", began.elapsed().as_secs_f64());
    println!(
        "closest two, of a hexagonal lattice's: {:.3}; power of low frequencies, of white noise's: {:.4}",
        pattern.normalised_radius(),
        pattern.low_power(),
    );
    std::fs::write(file, pattern.to_bytes()).map_err(|error| format!("{file}: {error}"))
}
