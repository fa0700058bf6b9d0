//! One kernel: a filter, and what a scene needs.

use super::{chain, constants, debug_view};
use needs::tables::Tables;
use needs::{Chain, Compositing, Levels, Needs, Shading, Way};
use optics::{DebugView, EnhancerKind, MimdaForm};

/// How voxels are interpolated.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Filter {
    /// By the texture unit.
    Hardware,
    /// By two gathers and f32 arithmetic.
    Gathered,
    /// By eight fetches and f32 arithmetic, where a format cannot be gathered.
    Exact,
}

/// What one kernel is made for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct KernelKey {
    /// Which rays it casts.
    pub rays: KernelRays,
    /// Interpolation.
    pub filter: Filter,
    /// How tables are looked up.
    pub lookup: Lookup,
    /// What the scene needs.
    pub needs: Needs,
}

/// Which rays a kernel casts.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum KernelRays {
    /// Those of the pixels of tiles.
    OfTiles,
    /// A list of rays that end early.
    Short,
    /// Those of the pixels of tiles, by row planes: one of their steps.
    OfPlanes(PlaneStep),
}

/// The steps of casting row planes, in their order.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum PlaneStep {
    /// Samples the grid.
    Fill,
    /// Finds means of what lies between samples.
    Means,
    /// Finds what these err.
    Errors,
    /// Takes all views through.
    Sweep,
}

impl PlaneStep {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::Fill, Self::Means, Self::Errors, Self::Sweep];
}

/// How the place of a scalar in the tables is found.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Lookup {
    /// Among the nodes that its cell lists.
    Listed,
    /// By halving the nodes of its cell, which may be more than those: a loop, which takes longer wherever it stands.
    Halved,
}

impl Lookup {
    /// What some tables need.
    pub fn of(tables: &Tables) -> Self {
        if tables.is_crowded() { Self::Halved } else { Self::Listed }
    }
}

/// A module's text by its place in `wgsl/`.
macro_rules! module {
    ($path:literal) => {
        include_str!(concat!("../../wgsl/", $path, ".wgsl"))
    };
}
pub(super) use module;

fn levels_wgsl(needs: &Needs) -> Vec<&'static str> {
    let weights = if needs.blends { module!("levels/weights") } else { module!("levels/no_weights") };
    let mut modules = vec![module!("levels/level"), weights];
    if !needs.reads_ancestors() {
        modules.push(module!("levels/one"));
    } else if !needs.reads_grandparents() {
        modules.push(module!("levels/two"));
    } else {
        modules.push(match needs.levels {
            Levels::Quadrilinear => "const FILTERS_LEVELS: bool = true;\n",
            Levels::Single => "const FILTERS_LEVELS: bool = false;\n",
        });
        modules.push(module!("levels/three"));
    }
    modules
}

fn spread_wgsl(needs: &Needs) -> Vec<&'static str> {
    if !needs.spreads {
        return vec![module!("spread/none")];
    }
    let levels = match (needs.reads_ancestors(), needs.reads_grandparents()) {
        (false, _) => module!("spread/one"),
        (true, false) => module!("spread/two"),
        (true, true) => module!("spread/three"),
    };
    vec![module!("spread/level"), levels]
}

fn gradient_wgsl(needs: &Needs) -> Vec<&'static str> {
    if !needs.reads_gradients() {
        return vec![module!("gradient/none")];
    }
    let which = match (needs.shading.has_detail(), needs.levels, needs.blends) {
        (true, ..) => module!("gradient/detail"),
        (false, Levels::Quadrilinear, _) => module!("gradient/blended"),
        (false, Levels::Single, true) => module!("gradient/toward_parent"),
        (false, Levels::Single, false) => module!("gradient/own"),
    };
    vec![module!("gradient/central"), which]
}

fn shade_wgsl(needs: &Needs) -> Vec<&'static str> {
    let shade = match needs.shading {
        Shading::Plain => module!("shade/plain"),
        Shading::Phong => module!("shade/phong"),
        Shading::Unsharp => module!("shade/unsharp"),
        Shading::Exaggerated => module!("shade/exaggerated"),
    };
    let material = if needs.has_materials { module!("material/table") } else { module!("material/one") };
    let law = if needs.shading == Shading::Plain { "" } else { module!("shade/law") };
    vec![material, law, shade]
}

/// What a step of row planes has besides the modules of rays.
fn planes_wgsl(step: PlaneStep, needs: &Needs) -> Vec<&'static str> {
    let spread =
        if needs.spreads { "const SPREAD_WORDS: u32 = 1u;\n" } else { "const SPREAD_WORDS: u32 = 0u;\n" };
    let gradient = match (needs.reads_gradients(), needs.shading.has_detail()) {
        (false, _) => module!("planes/gradient/none"),
        (true, false) => module!("planes/gradient/one"),
        (true, true) => module!("planes/gradient/three"),
    };
    let mut modules = vec![spread, gradient, module!("planes/kept"), module!("planes/grid")];
    if !needs.is_by_pixel() {
        let is_lit = needs.shading != Shading::Plain;
        let light = if is_lit { module!("planes/shared/lit") } else { module!("planes/shared/unlit") };
        modules.extend([module!("planes/shared/kept"), light]);
    }
    match (step, needs.is_by_pixel()) {
        (PlaneStep::Fill, _) => modules.extend([module!("planes/place"), module!("planes/fill")]),
        (PlaneStep::Means, _) => modules.extend([module!("planes/place"), module!("planes/shared/means")]),
        (PlaneStep::Errors, by_pixel) => {
            let errors =
                if by_pixel { module!("planes/alone/errors") } else { module!("planes/shared/errors") };
            modules.extend([module!("planes/place"), module!("planes/errors"), errors]);
        }
        (PlaneStep::Sweep, by_pixel) => {
            let cell = if by_pixel { module!("planes/alone/cell") } else { module!("planes/shared/cell") };
            let front = match needs.compositing {
                Compositing::Over => module!("planes/front/over"),
                Compositing::Mimda(_) => module!("planes/front/importance"),
            };
            modules.extend([module!("listed"), front, cell, module!("planes/sweep")]);
        }
    }
    modules
}

fn composite_wgsl(needs: &Needs) -> Vec<&'static str> {
    let mut modules = if needs.reads_importance() {
        vec![module!("importance"), module!("composite/sample")]
    } else {
        vec![module!("composite/plain_sample")]
    };
    modules.extend(match needs.compositing {
        Compositing::Over => vec![module!("composite/over")],
        Compositing::Mimda(MimdaForm::Paper) => {
            vec![module!("composite/mimda"), module!("composite/mimda_paper")]
        }
        Compositing::Mimda(MimdaForm::Consistent) => {
            vec![module!("composite/mimda"), module!("composite/mimda_consistent")]
        }
    });
    modules
}

impl KernelKey {
    /// The name of its entry point.
    pub fn entry_point(&self) -> &'static str {
        match self.rays {
            KernelRays::OfTiles => "cast_tile",
            KernelRays::Short => "cast_short",
            KernelRays::OfPlanes(PlaneStep::Fill) => "fill",
            KernelRays::OfPlanes(PlaneStep::Means) => "find_means",
            KernelRays::OfPlanes(PlaneStep::Errors) => "find_errors",
            KernelRays::OfPlanes(PlaneStep::Sweep) => "sweep",
        }
    }

    /// The kernel's WGSL.
    pub fn wgsl(&self) -> String {
        let needs = &self.needs;
        let sample = match self.filter {
            Filter::Hardware => &[module!("sample/hardware")][..],
            Filter::Gathered => &[module!("sample/gathered"), module!("sample/quads")],
            Filter::Exact => &[module!("sample/exact"), module!("sample/quads")],
        };
        let way = match needs.way {
            Way::Straight => &[module!("way/straight")][..],
            Way::Refracted => &[module!("way/path"), module!("way/pair"), module!("way/refracted")],
        };
        let place = match self.lookup {
            Lookup::Listed => module!("place/listed"),
            Lookup::Halved => module!("place/halved"),
        };
        let constants = constants::wgsl();
        let mut modules = vec![
            constants.as_str(),
            module!("layout"),
            module!("ray"),
            module!("traverse"),
            module!("tables"),
            place,
        ];
        modules.extend(sample);
        modules.extend(levels_wgsl(needs));
        modules.extend(spread_wgsl(needs));
        modules.extend(gradient_wgsl(needs));
        modules.extend(composite_wgsl(needs));
        modules.extend(shade_wgsl(needs));
        let chain = chain::wgsl(&needs.chain, needs.reads_importance());
        let debug = needs.debug.map_or_else(|| module!("debug/none").to_owned(), debug_view::wgsl);
        modules.extend([
            chain.as_str(),
            module!("refine"),
            module!("brick"),
            module!("observer"),
            debug.as_str(),
        ]);
        modules.extend(way);
        modules.extend(match self.rays {
            KernelRays::OfTiles => vec![module!("listed"), module!("cast")],
            KernelRays::Short => vec![module!("short")],
            KernelRays::OfPlanes(step) => planes_wgsl(step, needs),
        });
        modules.join("\n")
    }

    /// Kernels that together have every module, in every pair of slots that look at each other, and every chain of one
    /// and some of more: what a validator should see.
    pub fn samples() -> Vec<Self> {
        let mut chains: Vec<Chain> = EnhancerKind::ALL.iter().map(|&kind| Chain::of_kinds(&[kind])).collect();
        chains.push(Chain::EMPTY);
        chains.push(Chain::of_kinds(&[
            EnhancerKind::BandPicker,
            EnhancerKind::Probe,
            EnhancerKind::ClipPlane,
        ]));
        chains.push(Chain::of_kinds(&[EnhancerKind::ClipPlane; 3]));
        let mut keys = Vec::new();
        // Both look-ups are looked at as one, by filters alike.
        for (filter, lookup) in [(Filter::Hardware, Lookup::Listed), (Filter::Gathered, Lookup::Halved)] {
            for levels in [Levels::Single, Levels::Quadrilinear] {
                for shading in Shading::ALL {
                    for compositing in Compositing::ALL {
                        for way in [Way::Straight, Way::Refracted] {
                            for &chain in &chains {
                                let has_materials = shading != Shading::Plain && chain.is_empty();
                                let (blends, spreads, debug) = (false, false, None);
                                let needs = Needs {
                                    levels,
                                    blends,
                                    spreads,
                                    shading,
                                    has_materials,
                                    compositing,
                                    tells_importance: false,
                                    way,
                                    chain,
                                    debug,
                                };
                                keys.push(Self { rays: KernelRays::OfTiles, filter, lookup, needs });
                            }
                        }
                    }
                }
            }
        }
        // Debug views look at no other slot: each with a plain kernel, and with one that has much.
        for debug in DebugView::ALL.map(Some) {
            let needs = Needs { debug, ..Needs::PLAIN };
            let rays = KernelRays::OfTiles;
            keys.push(Self { rays, filter: Filter::Hardware, lookup: Lookup::Listed, needs });
            let shading = Shading::Exaggerated;
            let compositing = Compositing::Mimda(MimdaForm::Paper);
            let needs = Needs { shading, compositing, way: Way::Refracted, debug, ..Needs::PLAIN };
            for filter in [Filter::Gathered, Filter::Exact] {
                keys.push(Self { rays, filter, lookup: Lookup::Halved, needs });
            }
        }
        // Importance that is not accumulated is looked at by enhancers alone.
        let tells = |key: &&Self| {
            let Self { filter, needs, .. } = key;
            let is_plain = needs.shading == Shading::Plain && needs.compositing == Compositing::Over;
            *filter == Filter::Gathered && is_plain && needs.chain.needs_importance()
        };
        let telling = |key: &Self| Self { needs: Needs { tells_importance: true, ..key.needs }, ..*key };
        let told: Vec<Self> = keys.iter().filter(tells).map(telling).collect();
        keys.extend(told);
        // Blending is looked at by levels, gradients and ways alone, and by enhancers through gradients.
        let with_blending = |key: Self| Self { needs: Needs { blends: true, ..key.needs }, ..key };
        let is_apart = |key: &&Self| {
            let Self { filter, needs, .. } = key;
            let has_plain_rest = *filter == Filter::Gathered
                && needs.compositing == Compositing::Over
                && !needs.tells_importance;
            has_plain_rest && (needs.chain.is_empty() || needs.chain.needs_gradient())
        };
        let blended: Vec<Self> = keys.iter().filter(is_apart).copied().map(with_blending).collect();
        keys.extend(blended);
        // So are spreads, by the ways and by what a segment shows.
        let with_spreads = |key: Self| Self { needs: Needs { spreads: true, ..key.needs }, ..key };
        let spread: Vec<Self> = keys.iter().filter(is_apart).copied().map(with_spreads).collect();
        keys.extend(spread);
        // Which rays there are no other slot asks.
        let plain = Self {
            rays: KernelRays::Short,
            filter: Filter::Gathered,
            lookup: Lookup::Listed,
            needs: Needs::PLAIN,
        };
        let chain = Chain::of_kinds(&[EnhancerKind::BandPicker, EnhancerKind::Probe]);
        let compositing = Compositing::Mimda(MimdaForm::Consistent);
        let rich = Needs { shading: Shading::Phong, compositing, blends: true, chain, ..Needs::PLAIN };
        keys.extend([plain, Self { needs: rich, ..plain }]);
        // Steps of row planes look at levels, spreads, gradients and the light; what goes by pixel, at all the rest.
        for step in PlaneStep::ALL {
            let mut some: Vec<Needs> = [
                (Shading::Plain, Levels::Single, false, false),
                (Shading::Phong, Levels::Single, false, false),
                (Shading::Phong, Levels::Single, true, true),
                (Shading::Phong, Levels::Quadrilinear, false, true),
            ]
            .map(|(shading, levels, blends, spreads)| Needs {
                shading,
                levels,
                blends,
                spreads,
                ..Needs::PLAIN
            })
            .into();
            if step != PlaneStep::Means {
                some.extend(Compositing::ALL.map(|compositing| Needs { compositing, blends: false, ..rich }));
                some.push(Needs { chain: Chain::of_kinds(&[EnhancerKind::ClipPlane]), ..Needs::PLAIN });
                some.push(Needs { shading: Shading::Exaggerated, has_materials: true, ..Needs::PLAIN });
                some.push(Needs { debug: Some(DebugView::Lod), ..Needs::PLAIN });
            }
            for needs in some {
                let rays = KernelRays::OfPlanes(step);
                keys.extend([Filter::Gathered, Filter::Hardware].map(|filter| Self {
                    rays,
                    filter,
                    needs,
                    ..plain
                }));
            }
        }
        keys
    }
}
