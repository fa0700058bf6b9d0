//! Kernels composed for what a scene uses: WGSL modules concatenated, one per slot.

use crate::optics::{MimdaForm, Optics};

/// How voxels are interpolated.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Filter {
    /// By the texture unit.
    Hardware,
    /// By eight fetches and f32 arithmetic.
    Exact,
}

/// Whether gradients are sampled.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Shading {
    /// Plain colours.
    Plain,
    /// Gradient shading.
    Phong,
}

/// How samples are accumulated.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Compositing {
    /// Front to back.
    Over,
    /// Maximum Importance Difference Accumulation.
    Mimda(MimdaForm),
}

/// What one kernel is made for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct KernelKey {
    /// Interpolation.
    pub filter: Filter,
    /// Shading.
    pub shading: Shading,
    /// Accumulation.
    pub compositing: Compositing,
}

impl Compositing {
    /// All there are.
    pub const ALL: [Self; 3] =
        [Self::Over, Self::Mimda(MimdaForm::Paper), Self::Mimda(MimdaForm::Consistent)];

    /// What an optical model needs: γ = 0 is ordinary compositing.
    pub fn for_optics(optics: &Optics) -> Self {
        match &optics.mimda {
            Some(mimda) if mimda.gamma > 0.0 => Self::Mimda(mimda.form),
            Some(_) | None => Self::Over,
        }
    }
}

impl KernelKey {
    /// Every kernel there is.
    pub fn all() -> impl Iterator<Item = Self> {
        [Filter::Hardware, Filter::Exact].into_iter().flat_map(|filter| {
            [Shading::Plain, Shading::Phong].into_iter().flat_map(move |shading| {
                Compositing::ALL.into_iter().map(move |compositing| Self { filter, shading, compositing })
            })
        })
    }

    /// Whether the kernel reads the importance table.
    pub fn reads_importance(self) -> bool {
        matches!(self.compositing, Compositing::Mimda(_))
    }

    /// The kernel's WGSL; entry point `cast_tile`.
    pub fn wgsl(self) -> String {
        let sample = match self.filter {
            Filter::Hardware => include_str!("../wgsl/sample/hardware.wgsl"),
            Filter::Exact => include_str!("../wgsl/sample/exact.wgsl"),
        };
        let shade = match self.shading {
            Shading::Plain => include_str!("../wgsl/shade/plain.wgsl"),
            Shading::Phong => include_str!("../wgsl/shade/phong.wgsl"),
        };
        let composite = match self.compositing {
            Compositing::Over => include_str!("../wgsl/composite/over.wgsl"),
            Compositing::Mimda(MimdaForm::Paper) => include_str!("../wgsl/composite/mimda_paper.wgsl"),
            Compositing::Mimda(MimdaForm::Consistent) => {
                include_str!("../wgsl/composite/mimda_consistent.wgsl")
            }
        };
        let importance = if self.reads_importance() { include_str!("../wgsl/importance.wgsl") } else { "" };
        [
            include_str!("../wgsl/layout.wgsl"),
            include_str!("../wgsl/ray.wgsl"),
            include_str!("../wgsl/traverse.wgsl"),
            include_str!("../wgsl/tables.wgsl"),
            include_str!("../wgsl/refine.wgsl"),
            importance,
            sample,
            shade,
            composite,
            include_str!("../wgsl/brick.wgsl"),
            include_str!("../wgsl/cast.wgsl"),
        ]
        .join("\n")
    }
}
