//! The names of the looks.

use clap::ValueEnum;
use serde::Deserialize;
use std::fmt;

/// A look of the library.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum LookName {
    /// A CT: white bone under a veil of skin.
    CtSkinBone,
    /// A CT: bone alone.
    CtBone,
    /// A CT: lungs, airways and a hint of the ribs.
    CtLung,
    /// A CT with a contrast agent: vessels before bone.
    CtVessels,
    /// Magnetic resonance: the body's surface, solid and shaded.
    Mr,
    /// Fluorescence microscopy: bright signal that glows before nothing.
    Fluorescence,
    /// An electron tomogram: what stands out of the noise.
    Tomogram,
    /// Any scalar field: the rarer a value, the more solid.
    Scalar,
    /// A segmentation: a colour for each label.
    Labels,
}

impl LookName {
    /// All of them, in the order of the page that shows them.
    pub const ALL: [Self; 9] = [
        Self::CtSkinBone,
        Self::CtBone,
        Self::CtLung,
        Self::CtVessels,
        Self::Mr,
        Self::Fluorescence,
        Self::Tomogram,
        Self::Scalar,
        Self::Labels,
    ];

    /// What people write.
    pub fn text(self) -> &'static str {
        match self {
            Self::CtSkinBone => "ct-skin-bone",
            Self::CtBone => "ct-bone",
            Self::CtLung => "ct-lung",
            Self::CtVessels => "ct-vessels",
            Self::Mr => "mr",
            Self::Fluorescence => "fluorescence",
            Self::Tomogram => "tomogram",
            Self::Scalar => "scalar",
            Self::Labels => "labels",
        }
    }

    /// What it shows, in a few words.
    pub fn about(self) -> &'static str {
        match self {
            Self::CtSkinBone => "White bone under a veil of skin.",
            Self::CtBone => "Bone alone.",
            Self::CtLung => "Lungs and airways, with a hint of the ribs.",
            Self::CtVessels => "Vessels that a contrast agent brightens, before bone.",
            Self::Mr => "The surface of the body, solid and shaded.",
            Self::Fluorescence => "Signal that glows before a dark background.",
            Self::Tomogram => "What stands out of the noise.",
            Self::Scalar => "The rarer a value, the more solid.",
            Self::Labels => "A colour for each label.",
        }
    }
}

impl fmt::Display for LookName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.text())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_look_is_called_the_same_everywhere() {
        for name in LookName::ALL {
            assert_eq!(LookName::from_str(name.text(), false), Ok(name));
            let read: std::collections::BTreeMap<String, LookName> =
                toml::from_str(&format!("look = '{name}'")).unwrap();
            assert_eq!(read["look"], name);
        }
        assert_eq!(LookName::value_variants(), LookName::ALL);
    }
}
