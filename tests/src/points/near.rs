//! Which sites are near a place, by a grid over the torus.

use super::{Place, Torus};

/// Sites by the cells of a grid, about one in each.
pub struct Near<'a> {
    torus: Torus,
    sites: &'a [Place],
    /// Cells along x and y.
    cells: [u64; 2],
    /// Of each cell, where its sites begin in `order`; one more at the end.
    starts: Vec<usize>,
    order: Vec<u32>,
}

impl<'a> Near<'a> {
    pub fn new(torus: Torus, sites: &'a [Place]) -> Self {
        let spacing = torus.spacing(sites.len().max(1));
        let cells = torus.edges.map(|edge| ((f64::from(edge) * Torus::STEPS / spacing) as u64).max(1));
        let cell_of = |site: &Place| {
            let [x, y] = [0, 1].map(|i| (u64::from(site[i]) * cells[i]) >> 32);
            (y * cells[0] + x) as usize
        };
        let mut order: Vec<u32> = (0..sites.len() as u32).collect();
        order.sort_by_key(|&site| cell_of(&sites[site as usize]));
        let mut starts = vec![0; (cells[0] * cells[1]) as usize + 1];
        sites.iter().for_each(|site| starts[cell_of(site) + 1] += 1);
        (1..starts.len()).for_each(|cell| starts[cell] += starts[cell - 1]);
        Self { torus, sites, cells, starts, order }
    }

    /// Writes into `near` the sites that are nearer to a place than a distance, in order of their numbers.
    pub fn within(&self, place: Place, distance: f64, near: &mut Vec<u32>) {
        near.clear();
        let [columns, rows] = [0, 1].map(|axis| self.range(place, distance, axis));
        for row in rows.0..rows.0 + rows.1 {
            for column in columns.0..columns.0 + columns.1 {
                let cell = ((row % self.cells[1]) * self.cells[0] + column % self.cells[0]) as usize;
                near.extend(&self.order[self.starts[cell]..self.starts[cell + 1]]);
            }
        }
        let square = distance * distance;
        near.retain(|&site| self.torus.square(place, self.sites[site as usize]) < square);
        near.sort_unstable();
    }

    /// The first cell along an axis that a distance reaches, and how many there are.
    fn range(&self, place: Place, distance: f64, axis: usize) -> (u64, u64) {
        let cell = f64::from(self.torus.edges[axis]) * Torus::STEPS / self.cells[axis] as f64;
        let reach = (distance / cell).ceil() as u64;
        let count = self.cells[axis];
        let own = (u64::from(place[axis]) * count) >> 32;
        if 2 * reach + 1 >= count { (0, count) } else { (own + count - reach, 2 * reach + 1) }
    }
}

#[cfg(test)]
mod tests {
    use super::super::Pattern;
    use super::*;

    #[test]
    fn nobody_who_is_near_is_missed() {
        let torus = Torus { edges: [4, 3] };
        for count in [1, 7, 100, 500] {
            let pattern = Pattern::white(torus, count, 3);
            let (sites, mut found) = (pattern.places(), Vec::new());
            let near = Near::new(torus, sites);
            for spacings in [0.3, 1.0, 2.5, 40.0] {
                let distance = spacings * torus.spacing(count);
                for &place in sites.iter().take(20) {
                    near.within(place, distance, &mut found);
                    let is_near =
                        |&site: &u32| torus.square(place, sites[site as usize]) < distance * distance;
                    assert_eq!(found, (0..count as u32).filter(is_near).collect::<Vec<_>>());
                }
            }
        }
    }
}
