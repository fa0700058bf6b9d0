//! Building and reading stores: voxels and bricks per second, next to the rate of moving the same bytes with nothing in
//! between, and next to the errors at which they were measured.
//!
//! `cargo bench -p lightloom-tests --bench store`; LIGHTLOOM_BENCH_EDGE=n takes n³ voxels in place of 1024³, once, LIGHTLOOM_BENCH_HUGE=n
//! builds n³ voxels of procedural:sparse-vessels instead (4096: an hour and more on a slow machine, and room for the
//! store), and LIGHTLOOM_BENCH_DIR is the folder for the files.

use bricks::store::{BuildOptions, BuildReport, CodeBits, Codec, Store};
use bricks::volume::{ByteOrder, Element};
use bricks::{BrickSource, NodeKey};
use glam::{DVec3, UVec3};
use lightloom_tests::head::head;
use lightloom_tests::random::Random;
use lightloom_tests::results::{Program, Results};
use rayon::prelude::*;
use std::fs::File;
use std::io::{BufWriter, Read, Write};
use std::path::{Path, PathBuf};
use std::time::Instant;
use volumes::{ImportOptions, import};
use volumes::{RawLayout, Selection};

const MIB: f64 = (1 << 20) as f64;
/// Voxels along an edge of the head, where no other number is asked for.
const EDGE: u32 = 1024;
/// Builds of each kind; the median of them is shown.
const RUNS: usize = 3;
/// Bytes moved at once where nothing is done with them.
const COPY_BYTES: usize = 1 << 20;
/// Bricks read at random.
const READS: usize = 4000;

fn number(variable: &str) -> Option<u32> {
    std::env::var(variable).ok().map(|text| text.parse().expect("the variable is a number"))
}

fn main() -> Result<(), String> {
    let folder = match std::env::var_os("LIGHTLOOM_BENCH_DIR") {
        Some(folder) => tempfile::tempdir_in(folder),
        None => tempfile::tempdir(),
    }
    .expect("a folder for the files can be made");
    let program = Program::Bench("store");
    match number("LIGHTLOOM_BENCH_HUGE") {
        Some(edge) => {
            let mut results = Results::new(program, "store", "huge");
            huge(&mut results, folder.path(), edge);
            results.finish()
        }
        None => {
            let edge = number("LIGHTLOOM_BENCH_EDGE");
            let (part, runs) = if edge.is_some() { ("dense", 1) } else { ("build", RUNS) };
            let mut results = Results::new(program, "store", part);
            build_rates(&mut results, folder.path(), edge.unwrap_or(EDGE), runs);
            results.finish()
        }
    }
}

fn build_rates(results: &mut Results, folder: &Path, edge: u32, runs: usize) {
    let threads = rayon::current_num_threads();
    results.line(format!("{edge}³ voxels; median of {runs} runs, {threads} threads\n"));
    results.line("| stored | Mvoxel/s | copying alone | store, MiB | peak, MiB | CPU, s | RMS | largest |");
    results.line("| --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: |");
    let mut last = None;
    for element in [Element::U8, Element::I16] {
        let (raw, selection) = raw_head(folder, edge, element);
        let plans: &[(CodeBits, Codec)] = match element {
            Element::U8 => &[(CodeBits::Eight, Codec::Lz4)],
            _ => &[
                (CodeBits::Eight, Codec::Lz4),
                (CodeBits::Eight, Codec::Zstd),
                (CodeBits::Sixteen, Codec::Lz4),
            ],
        };
        for &(bits, codec) in plans {
            let out = folder.join("head.lloom");
            let (measured, report) = median_build(&raw, &selection, &out, (bits, codec), runs);
            let copying = copying_rate(&raw, &out, folder, edge);
            let (rate, bits) = (rate(edge, measured.wall_s), bits.bits());
            results.line(format!(
                "| {element} as {bits} bit, {codec:?} | {rate:.0} | {copying:.0} | {:.0} | {:.0} | {:.1} | {:.3} | {:.3} |",
                report.store_bytes as f64 / MIB,
                measured.peak_mib,
                measured.cpu_s,
                report.rms_error,
                report.max_error,
            ));
            last = Some(out);
        }
        std::fs::remove_file(&raw).expect("a file of this program can be removed");
    }
    read_rates(results, &last.expect("something was built"));
}

fn rate(edge: u32, seconds: f64) -> f64 {
    f64::from(edge).powi(3) / seconds / 1e6
}

/// The head as a raw file, and what it holds.
fn raw_head(folder: &Path, edge: u32, element: Element) -> (PathBuf, Selection) {
    let (path, dims) = (folder.join(format!("head-{element}.raw")), UVec3::splat(edge));
    let mut file = BufWriter::new(File::create(&path).expect("the folder can be written to"));
    for z in 0..edge {
        let row = |y: u32| (0..edge).map(move |x| head(UVec3::new(x, y, z), dims));
        let slab: Vec<i16> = (0..edge).into_par_iter().flat_map_iter(row).collect();
        let bytes: Vec<u8> = match element {
            // Windowed as a viewer does it.
            Element::U8 => {
                slab.iter().map(|&v| ((f64::from(v) + 1000.0) / 10.0).clamp(0.0, 255.0) as u8).collect()
            }
            _ => slab.iter().flat_map(|v| v.to_le_bytes()).collect(),
        };
        file.write_all(&bytes).expect("the disk has room");
    }
    file.flush().expect("the disk has room");
    let byte_order = ByteOrder::Little;
    let raw = RawLayout { dims, element, byte_order, spacing_mm: DVec3::ONE, header_skip_bytes: 0 };
    (path, Selection { raw: Some(raw), ..Default::default() })
}

#[derive(Clone, Copy)]
struct Measured {
    wall_s: f64,
    cpu_s: f64,
    peak_mib: f64,
}

fn median_build(
    raw: &Path,
    selection: &Selection,
    out: &Path,
    (bits, codec): (CodeBits, Codec),
    runs: usize,
) -> (Measured, BuildReport) {
    let build = BuildOptions { bits, codec, memory_bytes: 768 << 20, ..Default::default() };
    let options = ImportOptions { build, ..Default::default() };
    let mut runs: Vec<_> = (0..runs)
        .map(|_| measure(|| import(raw, selection, out, &options, &|_, _| {}).expect("it imports")))
        .collect();
    runs.sort_by(|(a, _), (b, _)| a.wall_s.total_cmp(&b.wall_s));
    runs.swap_remove(runs.len() / 2)
}

fn measure<T>(work: impl FnOnce() -> T) -> (Measured, T) {
    // Linux forgets the peak so far; elsewhere none is known.
    let _ = std::fs::write("/proc/self/clear_refs", "5");
    let (started, cpu) = (Instant::now(), cpu_seconds());
    let done = work();
    let wall_s = started.elapsed().as_secs_f64();
    (Measured { wall_s, cpu_s: cpu_seconds() - cpu, peak_mib: peak_mib() }, done)
}

/// Seconds of all threads so far, in the program and in the system.
fn cpu_seconds() -> f64 {
    let stat = std::fs::read_to_string("/proc/self/stat").unwrap_or_default();
    let fields: Vec<&str> = stat.rsplit(')').next().unwrap_or_default().split_whitespace().collect();
    let ticks = |at: usize| fields.get(at).and_then(|text| text.parse::<f64>().ok()).unwrap_or(f64::NAN);
    (ticks(11) + ticks(12)) / 100.0
}

fn peak_mib() -> f64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let peak = status
        .lines()
        .find_map(|line| line.strip_prefix("VmHWM:"))
        .map(|rest| rest.trim_end_matches("kB").trim());
    peak.and_then(|text| text.parse::<f64>().ok()).unwrap_or(f64::NAN) / 1024.0
}

/// What the disk allows: reading the source and writing as many bytes as the store has, in million voxels per second.
fn copying_rate(raw: &Path, store: &Path, folder: &Path, edge: u32) -> f64 {
    let mut left = std::fs::metadata(store).expect("the store is there").len();
    let started = Instant::now();
    let mut source = File::open(raw).expect("the source is there");
    let copy = folder.join("copy");
    let mut target = File::create(&copy).expect("the folder can be written to");
    let mut bytes = vec![0; COPY_BYTES];
    loop {
        let read = source.read(&mut bytes).expect("the source can be read");
        if read == 0 && left == 0 {
            break;
        }
        let part = left.min(COPY_BYTES as u64);
        target.write_all(&bytes[..part as usize]).expect("the disk has room");
        left -= part;
    }
    target.sync_all().expect("the disk takes it");
    let rate = rate(edge, started.elapsed().as_secs_f64());
    std::fs::remove_file(copy).expect("a file of this program can be removed");
    rate
}

/// Opening, and bricks at random: first from the disk, then from the page cache.
fn read_rates(results: &mut Results, path: &Path) {
    results.line("\n| reading | |\n| --- | ---: |");
    let is_cold = forget(path);
    let started = Instant::now();
    let store = Store::open(path).expect("the store opens");
    let state = if is_cold { "cold" } else { "perhaps warm: the page cache cannot be emptied here" };
    results.line(format!("| opening, {state} | {:.2} ms |", started.elapsed().as_secs_f64() * 1e3));
    let nodes = stored_nodes(&store);
    for name in [state, "warm"] {
        let started = Instant::now();
        for &node in &nodes {
            store.brick(node).expect("the brick is whole");
        }
        let rate = nodes.len() as f64 / started.elapsed().as_secs_f64();
        results.line(format!("| bricks/s at random, one thread, {name} | {rate:.0} |"));
    }
    let started = Instant::now();
    nodes.par_iter().for_each(|&node| drop(store.brick(node).expect("the brick is whole")));
    let rate = nodes.len() as f64 / started.elapsed().as_secs_f64();
    results.line(format!("| bricks/s at random, all threads, warm | {rate:.0} |"));
    let started = Instant::now();
    let found = store.verify(&|_, _| {});
    assert!(found.damages.is_empty(), "{:?}", found.damages);
    let rate = found.bytes as f64 / MIB / started.elapsed().as_secs_f64();
    results.line(format!("| checking all | {rate:.0} MiB/s |"));
}

/// Bricks of the finest level that hold several values, and so take bytes, drawn at random from a fixed seed.
fn stored_nodes(store: &Store) -> Vec<NodeKey> {
    let depth = store.shape().finest_depth();
    let bricks = store.shape().level_bricks(depth);
    let mut random = Random(7);
    let mut random = |below: u32| random.below(u64::from(below)) as u32;
    let mut nodes = Vec::new();
    while nodes.len() < READS {
        let cell = UVec3::new(random(bricks.x), random(bricks.y), random(bricks.z));
        let node = NodeKey { depth, cell };
        let summary = store.summary(node);
        if summary.min < summary.max {
            nodes.push(node);
        }
    }
    nodes
}

/// Empties the page cache, where this process may.
fn forget(path: &Path) -> bool {
    File::open(path).and_then(|file| file.sync_all()).is_ok()
        && std::fs::write("/proc/sys/vm/drop_caches", "3").is_ok()
}

fn huge(results: &mut Results, folder: &Path, edge: u32) {
    let out = folder.join("vessels.lloom");
    let build = BuildOptions { memory_bytes: 1 << 30, ..Default::default() };
    let options = ImportOptions { build, procedural_dims: UVec3::splat(edge), ..Default::default() };
    let started = Instant::now();
    let progress = |done: u64, total: u64| {
        if done.is_multiple_of(256) {
            eprintln!("{done} of {total} slabs after {:.0} s", started.elapsed().as_secs_f64());
        }
    };
    let (measured, report) = measure(|| {
        import(Path::new("procedural:sparse-vessels"), &Selection::default(), &out, &options, &progress)
            .expect("it builds")
    });
    results.line(format!("{edge}³ voxels of sparse vessels, 8 bits, LZ4\n\n| | |\n| --- | ---: |"));
    results.line(format!("| time | {:.0} s |", measured.wall_s));
    results.line(format!("| rate | {:.0} Mvoxel/s |", rate(edge, measured.wall_s)));
    results.line(format!("| store | {:.1} MiB |", report.store_bytes as f64 / MIB));
    results.line(format!("| bricks stored | {} of {} |", report.stored_bricks, report.nodes));
    results.line(format!("| peak memory | {:.0} MiB |", measured.peak_mib));
    for (level, error) in report.levels.iter().enumerate() {
        let of_16_bits = 65535.0 / (report.value_range.1 - report.value_range.0);
        results.line(format!(
            "| level {level}: RMS, largest error, in 1/65535 of the range | {:.2}, {:.1} |",
            error.rms * of_16_bits,
            error.max * of_16_bits
        ));
    }
    read_rates(results, &out);
}
