//! What a scene needs of a kernel: the words in which kernels are composed and twins are picked.

mod chain;
pub mod tables;

pub use chain::Chain;

use optics::{DebugView, Detail, Light, MimdaForm, Optics, Quality};

/// Whether samples are filtered over levels of detail.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Levels {
    /// The node's own level.
    Single,
    /// Node, parent and grandparent.
    Quadrilinear,
}

/// Whether gradients are sampled, and what light makes of them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Shading {
    /// Plain colours.
    Plain,
    /// Gradient shading.
    Phong,
    /// The same with normal unsharp masking.
    Unsharp,
    /// Exaggerated shading.
    Exaggerated,
}

/// How samples are accumulated.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Compositing {
    /// Front to back.
    Over,
    /// Maximum Importance Difference Accumulation.
    Mimda(MimdaForm),
}

/// How light travels.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Way {
    /// Straight on.
    Straight,
    /// Bent by refraction.
    Refracted,
}

/// What a kernel is made for, its filter apart.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Needs {
    /// Filtering over levels.
    pub levels: Levels,
    /// Whether nodes blend into their parents by the weights of their corners.
    pub blends: bool,
    /// Whether samples of coarse levels stand for the scalars within their standard deviation.
    pub spreads: bool,
    /// Shading.
    pub shading: Shading,
    /// Whether each scalar has a material of its own.
    pub has_materials: bool,
    /// Accumulation.
    pub compositing: Compositing,
    /// Whether samples have an importance that enhancers look at, though it is not accumulated.
    pub tells_importance: bool,
    /// Refraction.
    pub way: Way,
    /// Enhancers.
    pub chain: Chain,
    /// What is shown instead of the picture.
    pub debug: Option<DebugView>,
}

impl Compositing {
    /// All there are.
    pub const ALL: [Self; 3] =
        [Self::Over, Self::Mimda(MimdaForm::Paper), Self::Mimda(MimdaForm::Consistent)];

    /// What an optical model needs: γ = 0 is ordinary compositing.
    pub fn for_optics(optics: &Optics) -> Self {
        optics.accumulation().map_or(Self::Over, |mimda| Self::Mimda(mimda.form))
    }
}

impl Shading {
    /// All there are.
    pub const ALL: [Self; 4] = [Self::Plain, Self::Phong, Self::Unsharp, Self::Exaggerated];

    /// What a light needs.
    pub fn for_light(light: Option<&Light>) -> Self {
        match light.map(|light| light.detail) {
            None => Self::Plain,
            Some(Detail::None) => Self::Phong,
            Some(Detail::Unsharp { .. }) => Self::Unsharp,
            Some(Detail::Exaggerated { .. }) => Self::Exaggerated,
        }
    }

    /// Whether it looks at the gradients of coarser levels.
    pub fn has_detail(self) -> bool {
        matches!(self, Self::Unsharp | Self::Exaggerated)
    }
}

impl Way {
    /// What an optical model needs: one index everywhere bends nothing.
    pub fn for_optics(optics: &Optics) -> Self {
        match &optics.refraction {
            Some(index) if !index.is_constant_on(0.0, 1.0) => Self::Refracted,
            Some(_) | None => Self::Straight,
        }
    }
}

impl Needs {
    /// Nothing but plain colours, composited front to back.
    pub const PLAIN: Self = Self {
        levels: Levels::Single,
        blends: false,
        spreads: false,
        shading: Shading::Plain,
        has_materials: false,
        compositing: Compositing::Over,
        tells_importance: false,
        way: Way::Straight,
        chain: Chain::EMPTY,
        debug: None,
    };

    /// What a scene needs; whether nodes blend and stand for a spread is the working set's to say, and a debug view the frame's.
    pub fn of(optics: &Optics, light: Option<&Light>, quality: &Quality) -> Self {
        let shading = Shading::for_light(light);
        let (compositing, chain) = (Compositing::for_optics(optics), Chain::of(&optics.enhancers));
        let is_accumulated = compositing != Compositing::Over;
        Self {
            levels: if quality.quadrilinear { Levels::Quadrilinear } else { Levels::Single },
            blends: false,
            spreads: false,
            shading,
            has_materials: optics.materials.is_some() && shading != Shading::Plain,
            compositing,
            tells_importance: optics.mimda.is_some() && !is_accumulated && chain.needs_importance(),
            way: Way::for_optics(optics),
            chain,
            debug: None,
        }
    }

    /// Whether the kernel reads the importance table.
    pub fn reads_importance(&self) -> bool {
        self.tells_importance || self.compositing != Compositing::Over
    }

    /// Whether it samples gradients.
    pub fn reads_gradients(&self) -> bool {
        self.shading != Shading::Plain || self.way == Way::Refracted || self.chain.needs_gradient()
    }

    /// Whether what follows a sample of a row plane goes pixel by pixel through the rays' own code: what views make of it differs.
    pub fn is_by_pixel(&self) -> bool {
        self.compositing != Compositing::Over
            || self.tells_importance
            || self.chain != Chain::EMPTY
            || self.has_materials
            || self.shading.has_detail()
            || self.debug.is_some()
    }

    /// Whether it reads the bricks of ancestors.
    pub fn reads_ancestors(&self) -> bool {
        self.blends || self.reads_grandparents()
    }

    /// Whether it reads more of them than the parent's.
    pub fn reads_grandparents(&self) -> bool {
        self.levels == Levels::Quadrilinear || self.shading.has_detail()
    }
}
