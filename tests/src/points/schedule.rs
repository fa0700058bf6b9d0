//! Tiles in their order, what each costs, and pictures in which two levels meet.
//!
//! From the coarsest level to the finest, each from the middle of the picture outward. A tile casts its own samples, and
//! those copies beyond its border that its pixels need and nobody has cast: neighbours find these done. Where a tile lies
//! beside one that is not done, its opacity over the coarser level rises with the distance from that.

use super::level::Reconstructed;
use super::samples::CHANNELS;
use super::{Level, Samples};

/// The levels of a picture, and the order of their tiles.
pub struct Schedule {
    levels: Vec<Level>,
    /// Levels with tiles.
    tiles: Vec<(usize, u32)>,
    /// Rays that are cast once so many tiles are done.
    rays: Vec<u64>,
    /// Opacity rises over so many distances between samples of the coarser level.
    border: f64,
}

/// A complete level, and how much of the next lies over it.
#[derive(Clone, Debug, PartialEq)]
pub struct Mix {
    base: usize,
    /// Of each pixel; empty if the next level has nothing yet.
    opacities: Vec<f32>,
}

impl Schedule {
    /// Of levels, coarsest first, that meet in borders of some width, in distances between samples of the coarser one.
    pub fn new(levels: Vec<Level>, border: f64) -> Self {
        let numbered = levels.iter().enumerate();
        let tiles: Vec<(usize, u32)> = numbered
            .flat_map(|(at, level)| from_the_middle(level.samples()).into_iter().map(move |tile| (at, tile)))
            .collect();
        let (mut rays, mut sum) = (vec![0], 0);
        for (at, level) in levels.iter().enumerate() {
            let own: Vec<u32> = tiles.iter().filter(|tile| tile.0 == at).map(|tile| tile.1).collect();
            for cost in costs(level, &own) {
                sum += cost;
                rays.push(sum);
            }
        }
        Self { levels, tiles, rays, border }
    }

    /// Its levels.
    pub fn levels(&self) -> &[Level] {
        &self.levels
    }

    /// All tiles.
    pub fn tiles(&self) -> usize {
        self.tiles.len()
    }

    /// Rays that are cast once so many tiles are done.
    pub fn rays(&self, done: usize) -> u64 {
        self.rays[done]
    }

    /// The most tiles that so many rays do.
    pub fn affordable(&self, rays: u64) -> usize {
        self.rays.partition_point(|&cast| cast <= rays) - 1
    }

    /// What is shown once so many tiles are done.
    ///
    /// # Panics
    /// If none is.
    pub fn mix(&self, done: usize) -> Mix {
        let top = self.tiles[done - 1].0;
        let is_complete = self.tiles.get(done).is_none_or(|tile| tile.0 > top);
        if is_complete || top == 0 {
            return Mix { base: top, opacities: Vec::new() };
        }
        let samples = self.levels[top].samples();
        let mut is_done = vec![false; (samples.across() * samples.across()) as usize];
        self.tiles[..done]
            .iter()
            .filter(|tile| tile.0 == top)
            .for_each(|tile| is_done[tile.1 as usize] = true);
        let width = self.border * self.levels[top - 1].samples().spacing();
        let [columns, rows] = samples.size();
        let pixels = (0..rows).flat_map(|y| (0..columns).map(move |x| [x, y]));
        let opacities = pixels.map(|pixel| opacity(samples, &is_done, pixel, width)).collect();
        Mix { base: top - 1, opacities }
    }
}

impl Mix {
    /// The picture, of those of all levels.
    pub fn of(&self, levels: &[Reconstructed]) -> Reconstructed {
        let mut made = levels[self.base].clone();
        for (pixel, &opacity) in self.opacities.iter().enumerate().filter(|(_, opacity)| **opacity > 0.0) {
            let over = |under: &mut f32, over: f32| *under += opacity * (over - *under);
            let channels = CHANNELS * pixel..CHANNELS * (pixel + 1);
            let finer = &levels[self.base + 1];
            made.rgba[channels.clone()].iter_mut().zip(&finer.rgba[channels]).for_each(|(a, &b)| over(a, b));
            over(&mut made.deviations[pixel], finer.deviations[pixel]);
        }
        made
    }
}

/// The tiles of a level by their distance from the middle.
fn from_the_middle(samples: &Samples) -> Vec<u32> {
    let across = i64::from(samples.across());
    let mut tiles: Vec<u32> = (0..samples.across() * samples.across()).collect();
    let distance = |&tile: &u32| {
        let along = |at: i64, i: usize| i64::from(samples.size()[i]) * (2 * at + 1 - across);
        let (x, y) = (along(i64::from(tile) % across, 0), along(i64::from(tile) / across, 1));
        x * x + y * y
    };
    tiles.sort_by_key(distance);
    tiles
}

/// Rays that each of some tiles casts, one after the other.
fn costs(level: &Level, tiles: &[u32]) -> Vec<u64> {
    let samples = level.samples();
    let mut needs: Vec<Vec<u32>> = vec![Vec::new(); tiles.len()];
    (0..samples.count() as u32).for_each(|ray| needs[samples.tile_of_ray(ray) as usize].push(ray));
    let width = samples.size()[0];
    for pixel in 0..width * samples.size()[1] {
        let tile = samples.tile_of_pixel([pixel % width, pixel / width]);
        needs[tile as usize].extend(level.rays(pixel as usize).iter().map(|ray| ray.0));
    }
    let mut is_cast = vec![false; samples.count()];
    let mut cost = |&tile: &u32| {
        let new = |&&ray: &&u32| !std::mem::replace(&mut is_cast[ray as usize], true);
        needs[tile as usize].iter().filter(new).count() as u64
    };
    tiles.iter().map(&mut cost).collect()
}

/// How much of a pixel is the finer level's: 0 where its tile is not done, less than 1 near one that is not.
fn opacity(samples: &Samples, is_done: &[bool], pixel: [u32; 2], width: f64) -> f32 {
    let across = i64::from(samples.across());
    let tile = samples.tile_of_pixel(pixel);
    if !is_done[tile as usize] {
        return 0.0;
    }
    let own = [tile, tile].map(i64::from);
    let own = [own[0] % across, own[1] / across];
    let mut least = f64::INFINITY;
    for row in (own[1] - 1).max(0)..=(own[1] + 1).min(across - 1) {
        for column in (own[0] - 1).max(0)..=(own[0] + 1).min(across - 1) {
            if !is_done[(row * across + column) as usize] {
                least = least.min(distance(samples, pixel, [column, row]));
            }
        }
    }
    if least < width { (least / width) as f32 } else { 1.0 }
}

/// How far the middle of a pixel is from a tile, pixels.
fn distance(samples: &Samples, pixel: [u32; 2], tile: [i64; 2]) -> f64 {
    let along = |i: usize| {
        let edge = f64::from(samples.size()[i]) / f64::from(samples.across());
        let (place, begin) = (f64::from(pixel[i]) + 0.5, tile[i] as f64 * edge);
        (begin - place).max(place - begin - edge).max(0.0)
    };
    along(0).hypot(along(1))
}

#[cfg(test)]
mod tests {
    use super::super::{Kernel, Pattern, Torus};
    use super::*;

    const SIZE: [u32; 2] = [80, 60];

    fn schedule(border: f64) -> Schedule {
        let pattern = Pattern::jittered(Torus { edges: [4, 3] }, [8, 6], 1);
        let level =
            |depth| Level::new(Samples::new(&pattern, SIZE, 5, depth), Kernel { least: 2, falloff: 2.0 });
        Schedule::new((0..4).map(level).collect(), border)
    }

    /// Levels of one colour each, its number.
    fn flat(schedule: &Schedule) -> Vec<Reconstructed> {
        let pixels = (SIZE[0] * SIZE[1]) as usize;
        let of =
            |at: usize| Reconstructed { rgba: vec![at as f32; 4 * pixels], deviations: vec![0.0; pixels] };
        (0..schedule.levels().len()).map(of).collect()
    }

    #[test]
    fn tiles_go_from_coarse_to_fine_and_outward_and_cast_every_ray_once() {
        let schedule = schedule(1.0);
        assert_eq!(schedule.tiles(), 1 + 4 + 16 + 64);
        assert!(schedule.tiles.is_sorted_by_key(|tile| tile.0));
        let middle = &schedule.tiles[21..25];
        assert!(middle.iter().all(|tile| [27, 28, 35, 36].contains(&tile.1)), "{middle:?}");
        let mut sum = 0;
        for (depth, end) in [1, 5, 21, 85].into_iter().enumerate() {
            sum += 48 << (2 * depth);
            assert_eq!(schedule.rays(end), sum);
            assert_eq!((schedule.affordable(sum), schedule.affordable(sum - 1)), (end, end - 1));
        }
        // The first tile of a level also casts copies around it, and the last finds some of its own done.
        assert!(schedule.rays(22) - schedule.rays(21) > 48 && schedule.rays(85) - schedule.rays(84) < 48);
    }

    #[test]
    fn weights_of_two_levels_add_up_to_one_and_go_from_none_to_all() {
        for border in [0.0, 0.5, 2.0] {
            let schedule = schedule(border);
            let levels = flat(&schedule);
            for done in 1..=schedule.tiles() {
                let mix = schedule.mix(done);
                let Mix { base, opacities } = &mix;
                assert!(opacities.iter().all(|opacity| (0.0..=1.0).contains(opacity)));
                let made = mix.of(&levels);
                for (pixel, colour) in made.rgba.chunks_exact(4).enumerate() {
                    let opacity = opacities.get(pixel).copied().unwrap_or(0.0);
                    assert!((colour[0] - (*base as f32 + opacity)).abs() < 1e-6);
                }
            }
            assert_eq!(schedule.mix(85).of(&levels), levels[3]);
            assert_eq!(schedule.mix(21).of(&levels), levels[2]);
        }
    }

    #[test]
    fn opacity_rises_with_the_distance_from_what_is_not_done() {
        let schedule = schedule(0.5);
        // The four tiles in the middle of level 2: pixels 20 to 60 and 15 to 45.
        let Mix { base, opacities } = schedule.mix(5 + 4);
        assert_eq!(base, 1);
        let row: Vec<f32> = (15..41).map(|x| opacities[30 * 80 + x]).collect();
        assert!(
            row.is_sorted() && row[..5].iter().all(|&opacity| opacity == 0.0) && row[25] == 1.0,
            "{row:?}"
        );
        // Half the distance between samples of level 1, which has 192 of them.
        let width = 0.5 * (80.0_f64 * 60.0 / 192.0).sqrt();
        assert!((f64::from(row[6]) - 1.5 / width).abs() < 1e-6);
        // The rim of the picture is no border.
        let whole = schedule.mix(20).opacities;
        assert_eq!(
            whole[0] * whole[79] * whole[59 * 80] * whole[59 * 80 + 79],
            0.0,
            "the last tile is a corner"
        );
        assert_eq!(whole.iter().filter(|&&opacity| opacity == 0.0).count(), 20 * 15);
    }
}
