//! Sites that serve equally many points each, and are each at the middle of their own: capacity-constrained point sets
//! (Balzer, Schlömer and Deussen 2009).
//!
//! As in their section 3, two sites swap a point for a point as long as that brings points nearer to their sites; then each
//! site moves to the centroid of its points; and all that again until nobody swaps. Points that would gain from a swap are
//! sorted by how much, and two sites whose points all lie too close to home are passed over. Two things differ, which both
//! save time only: sites begin with points from around them, not from anywhere; and points are an even sequence, not white
//! noise, so that the density has no noise of its own.

use super::near::Near;
use super::{Pattern, Place, Torus};

/// 2⁶⁴ divided by the plastic number and by its square: multiples of these fill a torus evenly, however many there are
/// (Roberts 2018, the sequence R2).
const EVEN: [u64; 2] = [0xC13F_A9A9_02A6_328F, 0x91E1_0DA5_C79E_7B1D];

/// What is wanted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Wish {
    /// Where.
    pub torus: Torus,
    /// Sites.
    pub sites: usize,
    /// Points that each serves.
    pub per_site: usize,
    /// Of the first places.
    pub seed: u64,
}

/// A point that would go to another site: what the sum of squares gains, and its place in the cell.
type Offer = (f64, usize);

/// Sites and their points.
pub struct Capacity {
    torus: Torus,
    per_site: usize,
    sites: Vec<Place>,
    /// All points, those of a site together.
    points: Vec<Place>,
    /// Of each site: the distance of its farthest point.
    radii: Vec<f64>,
    /// Sites that swapped in the last pass, and so moved: two that did not have nothing new for each other.
    stirred: Vec<bool>,
    /// What each point of two sites would gain by going to the other.
    gains: [Vec<f64>; 2],
}

impl Capacity {
    /// Sites at random, with points.
    ///
    /// # Panics
    /// If there are none.
    pub fn new(wish: Wish) -> Self {
        assert!(wish.sites > 0 && wish.per_site > 0, "sites that serve points");
        let mut sites = Pattern::white(wish.torus, wish.sites, wish.seed).places().to_vec();
        let even = |at: u64| EVEN.map(|step| ((at + wish.seed).wrapping_mul(step) >> 32) as u32);
        let mut points: Vec<Place> = (0..(wish.sites * wish.per_site) as u64).map(even).collect();
        share_out(&mut sites, &mut points, wish.torus.edges.map(f64::from));
        let mut capacity = Self {
            torus: wish.torus,
            per_site: wish.per_site,
            radii: vec![0.0; wish.sites],
            stirred: vec![true; wish.sites],
            gains: [(); 2].map(|()| vec![0.0; wish.per_site]),
            sites,
            points,
        };
        (0..wish.sites).for_each(|site| capacity.measure(site));
        capacity
    }

    /// Lets all swap that can, then moves sites to the middle of their points. How many points went; 0 is the end.
    pub fn pass(&mut self) -> u64 {
        let sites = self.sites.clone();
        let grid = Near::new(self.torus, &sites);
        let reach = self.radii.iter().copied().fold(0.0, f64::max);
        let before = std::mem::replace(&mut self.stirred, vec![false; sites.len()]);
        let (mut near, mut swaps) = (Vec::new(), 0);
        for a in 0..sites.len() {
            grid.within(sites[a], self.radii[a] + reach, &mut near);
            for b in near.iter().map(|&b| b as usize).filter(|&b| b > a) {
                let has_news = before[a] || before[b] || self.stirred[a] || self.stirred[b];
                let apart = self.torus.square(sites[a], sites[b]).sqrt();
                if has_news && apart < self.radii[a] + self.radii[b] {
                    swaps += self.swap(a, b);
                }
            }
        }
        for site in (0..sites.len()).filter(|&site| self.stirred[site]).collect::<Vec<_>>() {
            self.sites[site] = centroid(self.sites[site], self.cell(site));
            self.measure(site);
        }
        swaps
    }

    /// Swaps points of two sites as long as that brings them nearer; how many.
    fn swap(&mut self, a: usize, b: usize) -> u64 {
        let [site_a, site_b] = [self.sites[a], self.sites[b]];
        let (low, high) = self.points.split_at_mut(b * self.per_site);
        let cell_a = &mut low[a * self.per_site..(a + 1) * self.per_site];
        let cell_b = &mut high[..self.per_site];
        let [gains_a, gains_b] = &mut self.gains;
        let most_a = gain(self.torus, cell_a, [site_a, site_b], gains_a);
        let most_b = gain(self.torus, cell_b, [site_b, site_a], gains_b);
        if most_a + most_b <= 0.0 {
            return 0;
        }
        let (offers_a, offers_b) = (offers(gains_a, most_b), offers(gains_b, most_a));
        let pairs = offers_a.iter().zip(&offers_b);
        let mut swaps = 0;
        for (&(_, a), &(_, b)) in pairs.take_while(|(a, b)| a.0 + b.0 > 0.0) {
            std::mem::swap(&mut cell_a[a], &mut cell_b[b]);
            swaps += 1;
        }
        for site in [a, b] {
            self.stirred[site] = true;
            self.measure(site);
        }
        swaps
    }

    /// The points of a site.
    fn cell(&self, site: usize) -> &[Place] {
        &self.points[site * self.per_site..(site + 1) * self.per_site]
    }

    /// Measures how far the points of a site are.
    fn measure(&mut self, site: usize) {
        let squares = self.cell(site).iter().map(|&point| self.torus.square(point, self.sites[site]));
        self.radii[site] = squares.fold(0.0, f64::max).sqrt();
    }

    /// The sum of the squares of the distances of all points from their sites, which no swap and no move raises.
    pub fn energy(&self) -> f64 {
        let of = |site: usize| {
            self.cell(site).iter().map(|&point| self.torus.square(point, self.sites[site])).sum::<f64>()
        };
        (0..self.sites.len()).map(of).sum()
    }

    /// The sites.
    pub fn pattern(&self) -> Pattern {
        Pattern::new(self.torus, self.sites.clone())
    }
}

impl Pattern {
    /// Sites after passes until nobody swaps, or as many as there may be at most; and how many there were.
    pub fn capacity_constrained(wish: Wish, most_passes: u32) -> (Self, u32) {
        let (mut capacity, mut passes) = (Capacity::new(wish), 1);
        while capacity.pass() > 0 && passes < most_passes {
            passes += 1;
        }
        (capacity.pattern(), passes)
    }
}

/// Gives each site as many points as all others, from around it: halves both along the longer edge, again and again.
fn share_out(sites: &mut [Place], points: &mut [Place], edges: [f64; 2]) {
    let half = sites.len() / 2;
    if half == 0 {
        return;
    }
    let axis = usize::from(edges[1] > edges[0]);
    let along = |place: &Place| [place[axis], place[1 - axis]];
    let middle = half * (points.len() / sites.len());
    sites.select_nth_unstable_by_key(half, along);
    points.select_nth_unstable_by_key(middle, along);
    let share = half as f64 / sites.len() as f64;
    let of = |share: f64| std::array::from_fn(|i| if i == axis { share * edges[i] } else { edges[i] });
    let (low_sites, high_sites) = sites.split_at_mut(half);
    let (low_points, high_points) = points.split_at_mut(middle);
    share_out(low_sites, low_points, of(share));
    share_out(high_sites, high_points, of(1.0 - share));
}

/// Writes how much nearer, in squares, each point is to the second site than to its own, the first; the most.
fn gain(torus: Torus, cell: &[Place], [own, other]: [Place; 2], gains: &mut [f64]) -> f64 {
    let mut most = f64::NEG_INFINITY;
    for (gain, &point) in gains.iter_mut().zip(cell) {
        *gain = torus.square(point, own) - torus.square(point, other);
        most = if *gain > most { *gain } else { most };
    }
    most
}

/// The points that some point of the other site may swap with, those that gain most first.
fn offers(gains: &[f64], most_of_other: f64) -> Vec<Offer> {
    let all = gains.iter().enumerate().map(|(at, &gain)| (gain, at));
    let mut offers: Vec<Offer> = all.filter(|offer| offer.0 + most_of_other > 0.0).collect();
    offers.sort_unstable_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
    offers
}

/// The middle of points around a site.
fn centroid(site: Place, points: &[Place]) -> Place {
    std::array::from_fn(|i| {
        let ways = points.iter().map(|point| i64::from(point[i].wrapping_sub(site[i]).cast_signed()));
        let mean = ways.sum::<i64>() as f64 / points.len() as f64;
        site[i].wrapping_add_signed(mean.round() as i32)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    const WISH: Wish = Wish { torus: Torus { edges: [4, 3] }, sites: 108, per_site: 64, seed: 1 };
    /// What rounding of squares, and of centroids to 2⁻³² of an edge, may raise the energy by, relatively.
    const ROUNDING: f64 = 1e-12;
    const MOST_PASSES: u32 = 2000;

    #[test]
    fn capacities_stay_equal_and_no_point_is_lost() {
        let mut capacity = Capacity::new(WISH);
        let points = |capacity: &Capacity| capacity.points.iter().copied().collect::<BTreeSet<Place>>();
        let before = points(&capacity);
        assert_eq!(before.len(), WISH.sites * WISH.per_site);
        while capacity.pass() > 0 {
            assert_eq!(points(&capacity), before, "each point is one site's");
            assert!((0..WISH.sites).all(|site| capacity.cell(site).len() == WISH.per_site));
        }
    }

    #[test]
    fn the_energy_never_rises_and_comes_to_rest() {
        let mut capacity = Capacity::new(WISH);
        let (mut last, mut passes) = (capacity.energy(), 0);
        let first = last;
        while capacity.pass() > 0 {
            let energy = capacity.energy();
            assert!(energy <= last * (1.0 + ROUNDING), "{energy} after {last}");
            (last, passes) = (energy, passes + 1);
            assert!(passes < MOST_PASSES, "it goes on for ever");
        }
        assert!(last < 0.6 * first, "{last} of {first}");
        assert_eq!(capacity.pass(), 0);
    }

    #[test]
    fn at_rest_no_two_points_want_to_swap_and_sites_are_in_the_middle() {
        let mut capacity = Capacity::new(WISH);
        while capacity.pass() > 0 {}
        for a in 0..WISH.sites {
            assert_eq!(centroid(capacity.sites[a], capacity.cell(a)), capacity.sites[a]);
            for b in a + 1..WISH.sites {
                // All pairs, near and far: nobody was passed over wrongly.
                let (own, other) = (capacity.sites[a], capacity.sites[b]);
                let mut gains = vec![0.0; WISH.per_site];
                let most_a = gain(WISH.torus, capacity.cell(a), [own, other], &mut gains);
                let most_b = gain(WISH.torus, capacity.cell(b), [other, own], &mut gains);
                assert!(most_a + most_b <= 0.0, "{a} and {b}");
            }
        }
    }

    #[test]
    fn a_lattice_of_sites_with_their_own_points_stays() {
        // 12 × 9 sites in the middle of 8 × 8 points.
        let at = |index: usize, count: usize| ((2 * index as u64 + 1) * (1 << 31) / count as u64) as u32;
        let mut capacity = Capacity::new(WISH);
        for site in 0..WISH.sites {
            let (x, y) = (site % 12, site / 12);
            capacity.sites[site] = [at(x, 12), at(y, 9)];
            for point in 0..WISH.per_site {
                let place = [at(8 * x + point % 8, 96), at(8 * y + point / 8, 72)];
                capacity.points[site * WISH.per_site + point] = place;
            }
            capacity.measure(site);
        }
        assert_eq!(capacity.pass(), 0);
    }

    #[test]
    fn a_centroid_is_found_over_the_edge() {
        let points = [[u32::MAX - 9, 10], [10, 20]];
        assert_eq!(centroid([u32::MAX, 15], &points), [0, 15]);
    }

    #[test]
    fn the_same_seed_gives_the_same_bytes_and_another_seed_others() {
        let made = |seed| Pattern::capacity_constrained(Wish { seed, ..WISH }, MOST_PASSES).0.to_bytes();
        assert_eq!(made(1), made(1));
        assert_ne!(made(1), made(2));
    }
}
