//! Whether the estimates of error can be trusted: ζ against what is truly wrong, τ against what has truly changed.

use super::{PAGE, PROGRAM};
use frontend::report::plot::{Chart, Mark, Point, Series, Stroke};
use frontend::tune::Footage;
use lightloom_tests::random::Random;
use lightloom_tests::results::{Results, folder};
use protocol::ProjectorImage;
use renderer::refine::{ERROR_UNIT, Filled, Grain, Order, UNITS, change_at, fill, sparse};

/// Pictures of each scenario that are looked at.
const PICTURES: usize = 150;
const SEED: u64 = 17;

/// Less than this counts as nothing: a thousandth of the least code.
const LEAST_PLOTTED: f64 = 1e-3 / 255.0;

/// An estimate, and what it stands for.
type Pair = (f64, f64);

pub fn compare(footage: &[Footage]) -> Result<(), String> {
    let mut results = Results::new(PROGRAM, PAGE, "estimates");
    results.line("| scenario | ζ: rank correlation | ζ / true mean error, median (5 % to 95 %) | τ: rank correlation | τ / true mean change, median (5 % to 95 %) |");
    results.line("| --- | ---: | ---: | ---: | ---: |");
    let mut random = Random(SEED);
    let (mut all_spatial, mut all_temporal) = (Vec::new(), Vec::new());
    let (mut space, mut time) = (Vec::new(), Vec::new());
    for (place, one) in footage.iter().enumerate() {
        let picture = &one.pictures(0)[0];
        let order = Order::new(Grain::Pixels, [picture.width, picture.height]);
        let spatial: Vec<Pair> = (0..PICTURES).map(|_| spatial(one, &order, &mut random)).collect();
        let temporal: Vec<Pair> = (0..PICTURES).map(|_| temporal(one, &order, &mut random)).collect();
        results.line(row(&one.name, &spatial, &temporal));
        space.push(dots(&one.name, place, footage.len(), &spatial));
        time.push(dots(&one.name, place, footage.len(), &temporal));
        all_spatial.extend(spatial);
        all_temporal.extend(temporal);
    }
    results.line(row("*all together*", &all_spatial, &all_temporal));
    if let Some(folder) = folder() {
        for (file, what, series) in [("zeta", "ζ", space), ("tau", "τ", time)] {
            let path = folder.join(format!("{PAGE}-{file}.svg"));
            let svg = chart(what, series).svg();
            std::fs::write(&path, svg).map_err(|error| format!("{}: {error}", path.display()))?;
        }
    }
    results.finish()
}

/// One scenario's pairs; those of nothing have no place on axes of magnitudes.
fn dots(name: &str, place: usize, count: usize, pairs: &[Pair]) -> Series {
    let is_seen = |pair: &&Pair| pair.0 > LEAST_PLOTTED && pair.1 > LEAST_PLOTTED;
    let point = |&(estimate, truth): &Pair| {
        let [x, y] = [truth, estimate].map(|of| 255.0 * of);
        Point { x, y, title: format!("{name}: {y:.3} said, {x:.3} true") }
    };
    Series::new(name, pairs.iter().filter(is_seen).map(point).collect()).ramp(place, count).mark(Mark::Dot)
}

/// What an estimate says against what is true.
fn chart(what: &str, mut series: Vec<Series>) -> Chart {
    let xs = series.iter().flat_map(|one| one.points.iter().map(|point| point.x));
    let [low, high] = xs.fold([f64::MAX, f64::MIN], |[low, high], x| [low.min(x), high.max(x)]);
    let equal = [low, high].map(|x| Point { x, y: x, title: "as it is".to_owned() });
    series.push(Series::new("as it is", equal.to_vec()).stroke(Stroke::Dashed));
    Chart {
        title: format!("{what} against what is true"),
        x_label: "true mean distance of pixels, units of 1/255".to_owned(),
        y_label: format!("{what}, units of 1/255"),
        series,
    }
}

fn row(name: &str, spatial: &[Pair], temporal: &[Pair]) -> String {
    let cells = |pairs: &[Pair]| {
        let mut ratios: Vec<f64> =
            pairs.iter().filter(|pair| pair.1 > 1e-6).map(|pair| pair.0 / pair.1).collect();
        ratios.sort_by(f64::total_cmp);
        let at = |share: f64| ratios.get((share * ratios.len() as f64) as usize).copied().unwrap_or(f64::NAN);
        format!("{:.3} | {:.2} ({:.2} to {:.2})", rank_correlation(pairs), at(0.5), at(0.05), at(0.95))
    };
    format!("| {name} | {} | {} |", cells(spatial), cells(temporal))
}

fn instant(footage: &Footage, random: &mut Random) -> usize {
    random.below(footage.len() as u64) as usize
}

/// ζ of a picture of which some units are cast, and the mean distance from the complete one.
fn spatial(footage: &Footage, order: &Order, random: &mut Random) -> Pair {
    let (instant, done) = (instant(footage, random), 1 + random.below(u64::from(UNITS) - 1) as u32);
    let (mut estimate, mut truth, mut pixels) = (0, 0.0, 0);
    for image in footage.pictures(instant) {
        let filled = fill(image.rgba.clone(), None, Filled::default(), order, done);
        estimate += filled.spatial;
        truth += distance(&filled.rgba, &image.rgba);
        pixels += image.rgba.len() / 4;
    }
    (estimate as f64 * ERROR_UNIT / pixels as f64, truth / pixels as f64)
}

/// τ between two instants, and the mean distance of all their pixels.
fn temporal(footage: &Footage, order: &Order, random: &mut Random) -> Pair {
    let from = instant(footage, random);
    let to = (from + 1 + random.below(20) as usize).min(footage.len() - 1);
    let (mut estimate, mut compared, mut truth, mut pixels) = (0, 0, 0.0, 0);
    for (a, b) in footage.pictures(from).iter().zip(footage.pictures(to)) {
        let few = |image: &ProjectorImage| sparse(&image.rgba, order.size(), order.first());
        let (few_a, few_b) = (few(a), few(b));
        estimate += change_at(&few_a, &few_b);
        compared += few_a.len();
        truth += distance(&a.rgba, &b.rgba);
        pixels += a.rgba.len() / 4;
    }
    (estimate as f64 * ERROR_UNIT / compared as f64, truth / pixels as f64)
}

/// The sum over pixels of how far their colours are apart.
fn distance(a: &[f32], b: &[f32]) -> f64 {
    let pixels = a.chunks_exact(4).zip(b.chunks_exact(4));
    pixels.map(|(a, b)| (0..3).map(|i| f64::from(a[i] - b[i]).powi(2)).sum::<f64>().sqrt()).sum()
}

/// Spearman's: how well the order of the estimates is that of the truths; 1 is the same, 0 none.
fn rank_correlation(pairs: &[Pair]) -> f64 {
    let ranks = |of: fn(&Pair) -> f64| {
        let mut order: Vec<usize> = (0..pairs.len()).collect();
        order.sort_by(|&a, &b| of(&pairs[a]).total_cmp(&of(&pairs[b])));
        let mut ranks = vec![0.0; pairs.len()];
        // Equal ones share the mean of their ranks.
        for group in order.chunk_by(|&a, &b| of(&pairs[a]) == of(&pairs[b])) {
            let first = order.iter().position(|at| *at == group[0]).unwrap_or(0) as f64;
            group.iter().for_each(|&at| ranks[at] = first + 0.5 * (group.len() - 1) as f64);
        }
        ranks
    };
    let (a, b) = (ranks(|pair| pair.0), ranks(|pair| pair.1));
    let mean = 0.5 * (pairs.len() as f64 - 1.0);
    let product =
        |a: &[f64], b: &[f64]| -> f64 { a.iter().zip(b).map(|(a, b)| (a - mean) * (b - mean)).sum() };
    product(&a, &b) / (product(&a, &a) * product(&b, &b)).sqrt()
}
