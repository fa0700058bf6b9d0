//! A chain of enhancers, prepared for one ray.

use super::band_picker::Picker;
use super::clip_plane::Clip;
use super::layer_opacity::Layer;
use super::place::{Place, Sample, Zone, Zones};
use super::probe::Sphere;
use crate::Ray;
use crate::band::{Band, Linear, linear};
use glam::DVec3;
use optics::{Curve, Enhancer, MOST_ENHANCERS, Optics, Trapezoid};

#[derive(Clone, Copy, Debug)]
enum Link {
    Clip(Clip),
    Probe(Sphere),
    Picker(Picker, Trapezoid),
    Layer(Layer, Trapezoid),
}

/// The enhancers of a scene, in order, for rays that left the eye in one direction.
#[derive(Clone, Debug, Default)]
pub struct Chain {
    links: Vec<Link>,
    /// Whether the scene gives importance: without it all samples are equally important to every link.
    has_importance: bool,
}

impl Chain {
    /// The chain of `optics`, for a ray that left the eye along `view` (unit, display frame).
    pub fn new(optics: &Optics, view: DVec3) -> Self {
        let link = |enhancer: &Enhancer| match enhancer {
            Enhancer::ClipPlane(plane) => Link::Clip(Clip::new(*plane, view)),
            Enhancer::Probe(probe) => Link::Probe(Sphere::new(*probe, view)),
            Enhancer::BandPicker(picker) => Link::Picker(Picker::new(picker, view), picker.band),
            Enhancer::LayerOpacity(layer) => Link::Layer(Layer::new(layer, view), layer.band),
        };
        let has_importance = optics.mimda.is_some();
        Self { links: optics.enhancers.iter().map(link).collect(), has_importance }
    }

    /// Whether there is no enhancer.
    pub fn is_empty(&self) -> bool {
        self.links.is_empty()
    }

    /// The direction that a link compares gradients with; None if no link looks at gradients.
    pub fn looks_along(&self) -> Option<DVec3> {
        self.links.iter().find_map(|link| match link {
            Link::Probe(probe) => Some(probe.view),
            Link::Clip(_) | Link::Picker(..) | Link::Layer(..) => None,
        })
    }

    /// Whether a link looks at importance, accumulated or not.
    pub fn weighs_importance(&self) -> bool {
        self.links.iter().any(|link| matches!(link, Link::Probe(_)))
    }

    /// The scalars at which a link's law is not smooth.
    pub fn knots(&self) -> impl Iterator<Item = f64> + '_ {
        self.links.iter().flat_map(|link| link.band().map(|band| band.corners()).into_iter().flatten())
    }

    /// What each link's band has of the scalars in [s0, s1], on which it must be linear; at the point where they are
    /// equal.
    pub fn shares(&self, s0: f64, s1: f64) -> [Linear<f64>; MOST_ENHANCERS] {
        let mut shares = [Linear(0.0, 0.0); MOST_ENHANCERS];
        for (share, link) in shares.iter_mut().zip(&self.links) {
            if let Some(band) = link.band() {
                *share = share_of(band, s0, s1);
            }
        }
        shares
    }

    /// Importance over a band of the medium after the chain, with `told` before it.
    pub fn importance(&self, told: Linear<f64>, shares: &[Linear<f64>; MOST_ENHANCERS]) -> Linear<f64> {
        self.links.iter().zip(shares).fold(told, |told, (link, share)| match link {
            Link::Picker(picker, _) => picker.importance_on(told, *share),
            Link::Clip(_) | Link::Probe(_) | Link::Layer(..) => told,
        })
    }

    /// The t of a straight path at which a link's law is not smooth, in rising order.
    pub fn breaks(&self, way: &Ray) -> Vec<f64> {
        let mut breaks = Vec::new();
        for link in &self.links {
            match link {
                Link::Clip(clip) => breaks.extend(clip.breaks(way)),
                Link::Probe(probe) => breaks.extend(probe.breaks(way)),
                Link::Picker(..) | Link::Layer(..) => {}
            }
        }
        breaks.retain(|t| t.is_finite());
        breaks.sort_by(f64::total_cmp);
        breaks
    }

    /// The zones around a point that is not on the edge of one.
    pub fn zones(&self, point: DVec3) -> Zones {
        let mut zones = [Zone::Idle; MOST_ENHANCERS];
        for (zone, link) in zones.iter_mut().zip(&self.links) {
            *zone = match link {
                Link::Clip(clip) => clip.zone(point),
                Link::Probe(probe) => probe.zone(point),
                Link::Picker(picker, _) if picker.weight == 0.0 => Zone::Idle,
                Link::Layer(layer, _) if layer.factor == 1.0 => Zone::Idle,
                Link::Picker(..) | Link::Layer(..) => Zone::Everywhere,
            };
        }
        zones
    }

    /// Whether any link changes the light of samples in `band`.
    pub fn acts_in(&self, zones: &Zones, band: &Band) -> bool {
        let acts = |index: usize, link: &Link| match (link, band.shares[index]) {
            (Link::Layer(..), Linear(share, change)) => share != 0.0 || change != 0.0,
            (Link::Picker(..), Linear(share, change)) => share != 1.0 || change != 0.0,
            (Link::Clip(_) | Link::Probe(_), _) => true,
        };
        self.links.iter().enumerate().any(|(index, link)| zones[index] != Zone::Idle && acts(index, link))
    }

    /// What the chain makes of a sample in given zones.
    pub fn apply(&self, zones: &Zones, place: &Place) -> Sample {
        let at = |Linear(start, change): Linear<f64>| start + change * place.at;
        let importance = at(place.band.told);
        let mut sample = Sample { extinction: 1.0, colour: 1.0, importance, shading: 1.0 };
        for (index, link) in self.links.iter().enumerate() {
            let (zone, share) = (zones[index], at(place.band.shares[index]).clamp(0.0, 1.0));
            match link {
                Link::Clip(clip) => {
                    let (extinction, shading) = clip.factors(zone, place.point);
                    sample.extinction *= extinction;
                    sample.shading *= shading;
                }
                Link::Probe(probe) => {
                    let (extinction, colour) = probe.factors(zone, place, sample.importance);
                    sample.extinction *= extinction;
                    sample.colour *= colour;
                }
                Link::Picker(picker, _) => {
                    if self.has_importance {
                        sample.importance = picker.importance(sample.importance, share);
                    }
                    sample.extinction *= picker.factor(share);
                }
                Link::Layer(layer, _) => sample.extinction *= layer.factor(share),
            }
        }
        sample
    }
}

impl Link {
    fn band(&self) -> Option<Trapezoid> {
        match self {
            Self::Picker(_, band) | Self::Layer(_, band) => Some(*band),
            Self::Clip(_) | Self::Probe(_) => None,
        }
    }
}

/// A trapezoid over an interval on which it is linear. At a single point a steep flank belongs to the band.
fn share_of(band: Trapezoid, s0: f64, s1: f64) -> Linear<f64> {
    if s0 == s1 {
        return Linear(band.at(s0), 0.0);
    }
    let [a, b, c, d] = band.corners();
    let curve = Curve::new(vec![(a, 0.0), (b, 1.0), (c, 1.0), (d, 0.0)]);
    linear(&curve.expect("a trapezoid's corners are finite and rise"), s0, s1)
}
