//! How the views of a display share planes: in fans, one for each distance of projectors and grid on the screen.

use crate::Fan;
use crate::raster::{RasterWarp, in_common};
use twin::ProjectorRays;

/// Views in fans: each view belongs to one.
#[derive(Clone, Debug)]
pub struct Fans {
    fans: Vec<Fan>,
    /// Of each view: the rays that planes cast for it, and the way from their raster to its own where that is another.
    views: Vec<(ProjectorRays<f32>, Option<RasterWarp>)>,
}

/// Views that are to share planes.
struct Group {
    views: Vec<usize>,
    /// Whether their pictures are resampled from a common raster.
    is_resampled: bool,
}

impl Fans {
    /// Of all views of a display; or why planes cannot serve them.
    ///
    /// Views whose rasters are the same and level share planes that are cast on these very rasters. All others at one distance from
    /// the screen share planes on an upright raster that covers theirs, and are resampled from it.
    ///
    /// # Errors
    /// There is no view, projectors do not lie behind the screen, or rasters are too far from each other.
    pub fn of(views: &[ProjectorRays<f32>]) -> Result<Self, &'static str> {
        if views.is_empty() {
            return Err("there are no views");
        }
        let mut found: Vec<_> = views.iter().map(|&view| (view, None)).collect();
        let mut fans = Vec::new();
        for group in groups(views) {
            let mut rays: Vec<_> = group.views.iter().map(|&view| views[view]).collect();
            if group.is_resampled {
                let common = in_common(&rays).ok_or("their rasters are too far from each other")?;
                for (&view, both) in group.views.iter().zip(common.0.iter().zip(common.1)) {
                    found[view] = (*both.0, Some(both.1));
                }
                rays = common.0;
            }
            let warps = group.views.iter().map(|&view| found[view].1).collect();
            fans.push(Fan::of(rays, warps, group.views)?);
        }
        Ok(Self { fans, views: found })
    }

    /// Some of the views alone, numbered anew in this order. What planes show of each stays as it is.
    #[must_use]
    pub fn only(&self, views: &[usize]) -> Self {
        let fans = self.fans.iter().map(|fan| fan.only(views)).filter(|fan| !fan.views.is_empty());
        Self { fans: fans.collect(), views: views.iter().map(|&view| self.views[view]).collect() }
    }

    /// The fans, each of some views.
    pub fn iter(&self) -> impl Iterator<Item = &Fan> {
        self.fans.iter()
    }

    /// How many there are.
    pub fn count(&self) -> usize {
        self.fans.len()
    }

    /// Of each view: the rays that planes cast.
    pub fn rays(&self) -> impl Iterator<Item = ProjectorRays<f32>> + '_ {
        self.views.iter().map(|view| view.0)
    }

    /// The way to a view's own raster, where planes cast another.
    pub fn warp(&self, view: usize) -> Option<&RasterWarp> {
        self.views.get(view)?.1.as_ref()
    }

    /// Views whose pictures are resampled.
    pub fn resampled(&self) -> usize {
        self.views.iter().filter(|view| view.1.is_some()).count()
    }

    /// Whether every grid goes as far from the viewers as z.
    pub fn reaches(&self, z: f64) -> bool {
        self.fans.iter().all(|fan| fan.reaches(z))
    }
}

/// Which views share planes.
fn groups(views: &[ProjectorRays<f32>]) -> Vec<Group> {
    let mut groups: Vec<Group> = Vec::new();
    let is_at = |a: usize, b: usize| views[a].beam[1..] == views[b].beam[1..];
    for (view, rays) in views.iter().enumerate() {
        let is_resampled = !is_level(rays);
        let has_room = |group: &&mut Group| {
            let first = group.views[0];
            let is_same = rays.screen_from_pixel == views[first].screen_from_pixel
                && rays.raster == views[first].raster;
            group.is_resampled == is_resampled && is_at(view, first) && (is_resampled || is_same)
        };
        match groups.iter_mut().find(has_room) {
            Some(group) => group.views.push(view),
            None => groups.push(Group { views: vec![view], is_resampled }),
        }
    }
    // A level raster that no other view has shares planes with those that are resampled.
    let is_alone = |group: &Group| group.views.len() == 1 || group.is_resampled;
    let (alone, mut shared): (Vec<_>, Vec<_>) = groups.into_iter().partition(is_alone);
    let mut joined: Vec<Group> = Vec::new();
    for mut group in alone {
        match joined.iter_mut().find(|known| is_at(known.views[0], group.views[0])) {
            Some(known) => {
                known.is_resampled = true;
                known.views.append(&mut group.views);
            }
            None => joined.push(group),
        }
    }
    joined.iter_mut().for_each(|group| group.views.sort_unstable());
    shared.append(&mut joined);
    shared
}

/// Whether a view's rows lie along the screen, from the left to the right.
fn is_level(view: &ProjectorRays<f32>) -> bool {
    let [across, down, corner] = view.screen_from_pixel.map(|column| column.0);
    let is_upright = across[1..] == [0.0, 0.0] && [down[0], down[2]] == [0.0, 0.0] && corner[2] == 1.0;
    is_upright && across[0] > 0.0
}

#[cfg(test)]
mod tests {
    use super::*;
    use twin::vector::Vec3;

    fn view(offset: f32, slope: f32, turn: f32) -> ProjectorRays<f32> {
        let columns = [[0.008, turn, 0.0], [0.0, -0.008, 0.0], [-0.32, 0.24, 1.0]];
        ProjectorRays {
            screen_from_pixel: columns.map(Vec3),
            beam: [offset, slope, 0.0, 3.0],
            raster: [80, 60],
        }
    }

    fn found(views: &[ProjectorRays<f32>]) -> Vec<(Vec<usize>, bool)> {
        let fans = Fans::of(views).unwrap();
        let is_resampled = |fan: &Fan| fans.warp(fan.views[0]).is_some();
        fans.iter().map(|fan| (fan.views.clone(), is_resampled(fan))).collect()
    }

    #[test]
    fn views_of_one_distance_and_raster_share_planes() {
        let all = [view(0.0, 1.5, 0.0), view(0.1, 2.0, 0.0), view(0.2, 1.5, 0.0), view(0.3, 2.0, 0.0)];
        assert_eq!(found(&all), [(vec![0, 2], false), (vec![1, 3], false)]);
    }

    #[test]
    fn tilted_views_and_those_alone_in_their_raster_are_resampled_together() {
        let smaller = ProjectorRays { raster: [79, 60], ..view(0.4, 1.5, 0.0) };
        let all =
            [view(0.0, 1.5, 0.0), view(0.1, 1.5, 1e-4), view(0.2, 1.5, 0.0), smaller, view(0.3, 1.5, 2e-4)];
        assert_eq!(found(&all), [(vec![0, 2], false), (vec![1, 3, 4], true)]);
        // Alone, it is cast as it is.
        assert_eq!(found(&all[3..4]), [(vec![0], false)]);
    }

    #[test]
    fn some_of_the_views_keep_the_grid_of_all() {
        let all = [view(0.0, 1.5, 3e-4), view(0.1, 2.0, 0.0), view(0.2, 1.5, 2e-4)];
        let fans = Fans::of(&all).unwrap();
        let some = fans.only(&[2]);
        assert_eq!((some.count(), some.resampled()), (1, 1));
        assert_eq!(some.warp(0), fans.warp(2));
        assert!(some.rays().eq(fans.rays().skip(2)));
        assert_eq!(fans.only(&[1]).resampled(), 0);
    }

    #[test]
    fn projectors_before_the_screen_are_refused() {
        assert!(Fans::of(&[view(0.0, -0.5, 0.0)]).unwrap_err().contains("behind the screen"));
        assert!(Fans::of(&[]).is_err());
    }
}
