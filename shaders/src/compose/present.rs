//! The kernels that make what is shown of what was cast.

use super::constants;
use super::kernel::module;
use layout::present::CODED_PIXELS;

/// One of them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum PresentKernel {
    /// A pass over a picture that fills gaps.
    Reconstruct,
    /// The step from what was shown before.
    Ease,
    /// Marks over what is shown.
    Layers,
    /// From linear colours to codes.
    Finish,
}

impl PresentKernel {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::Reconstruct, Self::Ease, Self::Layers, Self::Finish];

    /// Its WGSL.
    pub fn wgsl(self) -> String {
        let constants = constants::wgsl();
        let mut modules = vec![constants.as_str(), module!("present/block")];
        modules.extend(match self {
            Self::Reconstruct => &[module!("present/reconstruct")][..],
            Self::Ease => &[module!("present/ease")],
            Self::Layers => &[module!("present/layers")],
            Self::Finish => {
                &[module!("present/warp"), module!("present/transfer"), module!("present/finish")]
            }
        });
        modules.join("\n")
    }

    /// Pixels of a row that one invocation makes.
    pub fn pixels_at_once(self) -> u32 {
        if self == Self::Finish { CODED_PIXELS } else { 1 }
    }

    /// The name of its entry point, which is called in tiles of [`layout::TILE_EDGE`] invocations for all pixels; that of layers for
    /// each of a list.
    pub fn entry_point(self) -> &'static str {
        match self {
            Self::Reconstruct => "reconstruct_pixel",
            Self::Ease => "ease_pixel",
            Self::Layers => "lay_pixel",
            Self::Finish => "finish_pixels",
        }
    }
}
