//! The chain of enhancers of a kernel, with the glue between them.

use optics::{Enhancer, MOST_ENHANCERS};
use std::fmt::Write;

/// An enhancer's module. A new one takes a variant here and in [`Enhancer`], a WGSL file, and its twin.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum EnhancerKind {
    /// Clip plane with view-dependent context.
    ClipPlane,
    /// Context-preserving probe.
    Probe,
    /// View-dependent band picker.
    BandPicker,
    /// Layer opacity by view direction.
    LayerOpacity,
}

impl EnhancerKind {
    /// All there are.
    pub const ALL: [Self; 4] = [Self::ClipPlane, Self::Probe, Self::BandPicker, Self::LayerOpacity];

    /// Of an enhancer.
    pub fn of(enhancer: &Enhancer) -> Self {
        match enhancer {
            Enhancer::ClipPlane(_) => Self::ClipPlane,
            Enhancer::Probe(_) => Self::Probe,
            Enhancer::BandPicker(_) => Self::BandPicker,
            Enhancer::LayerOpacity(_) => Self::LayerOpacity,
        }
    }

    /// What the names of its functions begin with.
    fn prefix(self) -> &'static str {
        match self {
            Self::ClipPlane => "clip_plane",
            Self::Probe => "probe",
            Self::BandPicker => "band_picker",
            Self::LayerOpacity => "layer_opacity",
        }
    }

    fn wgsl(self) -> &'static str {
        match self {
            Self::ClipPlane => include_str!("../../wgsl/enhance/clip_plane.wgsl"),
            Self::Probe => include_str!("../../wgsl/enhance/probe.wgsl"),
            Self::BandPicker => include_str!("../../wgsl/enhance/band_picker.wgsl"),
            Self::LayerOpacity => include_str!("../../wgsl/enhance/layer_opacity.wgsl"),
        }
    }

    /// Whether it looks at gradients.
    fn needs_gradient(self) -> bool {
        match self {
            Self::Probe => true,
            Self::ClipPlane | Self::BandPicker | Self::LayerOpacity => false,
        }
    }

    /// Whether it looks at bands of scalars.
    fn needs_band(self) -> bool {
        match self {
            Self::BandPicker | Self::LayerOpacity => true,
            Self::ClipPlane | Self::Probe => false,
        }
    }
}

/// The enhancers of a kernel, in order.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Chain([Option<EnhancerKind>; MOST_ENHANCERS]);

impl Chain {
    /// None.
    pub const EMPTY: Self = Self([None; MOST_ENHANCERS]);

    /// Of a scene; enhancers that do nothing are left out.
    pub fn of(enhancers: &[Enhancer]) -> Self {
        let mut kinds = enhancers.iter().filter(|e| !e.is_neutral()).map(EnhancerKind::of);
        Self(std::array::from_fn(|_| kinds.next()))
    }

    /// Of given kinds; those beyond [`MOST_ENHANCERS`] are dropped.
    pub fn of_kinds(kinds: &[EnhancerKind]) -> Self {
        Self(std::array::from_fn(|i| kinds.get(i).copied()))
    }

    /// The links, in order.
    pub fn kinds(&self) -> impl Iterator<Item = EnhancerKind> + '_ {
        self.0.iter().flatten().copied()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.0[0].is_none()
    }

    /// Whether a link looks at gradients.
    pub fn needs_gradient(&self) -> bool {
        self.kinds().any(EnhancerKind::needs_gradient)
    }

    /// The modules of the links, each once, with the functions that the casting modules call.
    pub(super) fn wgsl(&self, has_importance: bool) -> String {
        if self.is_empty() {
            return include_str!("../../wgsl/enhance/none.wgsl").to_owned();
        }
        let mut text = String::from(include_str!("../../wgsl/enhance/chain.wgsl"));
        text += if has_importance {
            include_str!("../../wgsl/enhance/importance.wgsl")
        } else {
            include_str!("../../wgsl/enhance/no_importance.wgsl")
        };
        if self.kinds().any(EnhancerKind::needs_band) {
            text += include_str!("../../wgsl/enhance/band.wgsl");
        }
        for kind in EnhancerKind::ALL.into_iter().filter(|&kind| self.kinds().any(|k| k == kind)) {
            text += kind.wgsl();
        }
        text + &self.glue()
    }

    /// The chain itself: each hook calls the links in order.
    fn glue(&self) -> String {
        let links: Vec<&str> = self.kinds().map(EnhancerKind::prefix).collect();
        let each = |line: &dyn Fn(usize, &str) -> String| {
            links
                .iter()
                .enumerate()
                .fold(String::new(), |text, (i, name)| text + "    " + &line(i, name) + "\n")
        };
        let spread = |(i, kind): (usize, EnhancerKind)| {
            let name = kind.prefix();
            kind.needs_gradient().then(|| format!("{name}_spread(links[{i}], chain.link{i}.breaks, t)"))
        };
        let spreads: Vec<String> =
            std::iter::once("0.0".to_owned()).chain(self.kinds().enumerate().filter_map(spread)).collect();
        let mut text = String::new();
        write!(
            text,
            "
// The chain of this kernel.
struct Chain {{
    view: vec3<f32>,
{members}}}

var<private> chain: Chain;

const CHAIN_NEEDS_GRADIENT: bool = {needs_gradient};

fn chain_spread(t: f32) -> f32 {{
    return {spreads};
}}

fn start_chain(ray: Ray) {{
    chain.view = ray.direction_in_display;
{start}}}

fn follow_chain(ray: Ray) {{
{follow}}}

fn next_break(t: f32) -> f32 {{
    var next = FAR;
{breaks}    return next;
}}

fn enhance(plain: Sample, ray: Ray, t: f32, s0: f32, s1: f32, gradients: Gradients) -> Sample {{
    let place = Place(point_in_display(ray, t), {gradient}, s0, s1, chain.view);
    var sample = plain;
{at}    return sample;
}}

fn end_chain(plain: Accumulated) -> Accumulated {{
    var front = plain;
{end}    return front;
}}
",
            members = each(&|i, _| format!("link{i}: LinkState,")),
            needs_gradient = self.needs_gradient(),
            spreads = spreads.join(" + "),
            start = each(&|i, name| format!("chain.link{i}.weights = {name}_start(links[{i}], chain.view);")),
            follow = each(&|i, name| format!(
                "chain.link{i}.breaks = {name}_breaks(links[{i}], chain.link{i}.weights, ray);"
            )),
            breaks = each(&|i, _| format!("next = min(next, first_beyond(chain.link{i}.breaks, t));")),
            gradient = if self.needs_gradient() { "gradients.at" } else { "vec3<f32>(0.0)" },
            at = each(&|i, name| format!(
                "sample = {name}_at(links[{i}], chain.link{i}.weights, sample, place);"
            )),
            end = each(&|i, name| format!("front = {name}_end(links[{i}], chain.link{i}.weights, front);")),
        )
        .expect("writing to a String does not fail");
        text
    }
}
