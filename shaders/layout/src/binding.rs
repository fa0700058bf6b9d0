//! The numbers under which kernels find what they read and write; all are in group 0.

/// Each number as a constant, and all of them as a table.
macro_rules! bindings {
    ($($(#[$doc:meta])* $name:ident = $number:literal;)+) => {
        $($(#[$doc])* pub const $name: u32 = $number;)+
        /// Every binding, with the name of its constant.
        pub const ALL: &[(&str, u32)] = &[$((stringify!($name), $name)),+];
    };
}

bindings! {
    /// The uniform [`SceneBlock`](crate::SceneBlock).
    SCENE = 0;
    /// The [`ViewBlock`](crate::ViewBlock)s.
    VIEWS = 1;
    /// The uniform array of [`Link`](crate::Link)s.
    LINKS = 2;
    /// The [`NodeRecord`](crate::NodeRecord)s, root first.
    NODES = 3;
    /// The visible cells, slot by slot: see [`CELL_WORDS`](crate::CELL_WORDS).
    CELLS = 4;
    /// The texture of bricks.
    ATLAS = 5;
    /// Its sampler.
    SAMPLER = 6;
    /// The [`TableEntry`](crate::TableEntry)s of the optics.
    OPTICS = 7;
    /// The [`TableCell`](crate::TableCell)s.
    TABLE_CELLS = 8;
    /// The table of [`ImportanceEntry`](crate::ImportanceEntry)s.
    IMPORTANCE = 9;
    /// The largest importances of spans of nodes.
    IMPORTANCE_MOST = 10;
    /// The table of refraction indices.
    INDEX = 11;
    /// The [`TableEntry`](crate::TableEntry)s of the materials.
    MATERIALS = 12;
    /// What to cast. How many tiles and runs of them, then of each run the place of its first tile among all, its view and the
    /// number of that tile. Or how many short rays, then view, pixel and end of each.
    LISTED = 13;
    /// The colours of all views, pixel by pixel.
    PIXELS = 14;
    /// The samples taken, pixel by pixel of all views.
    COUNTS = 15;
    /// The [`FeedbackEntry`](crate::FeedbackEntry)s, node by node.
    FEEDBACK = 16;
    /// The texture of the bricks' standard deviations, slot by slot as in the atlas.
    DEVIATIONS = 17;
    /// The uniform [`PresentBlock`](crate::PresentBlock).
    PRESENT = 18;
    /// The colours that a pass reads, pixel by pixel.
    PICTURE = 19;
    /// The colours that were shown before.
    BEFORE = 20;
    /// The colours of a picture without gaps.
    WHOLE = 21;
    /// The colours that are shown.
    SHOWN = 22;
    /// Whether any of them is not yet what rays see.
    BEHIND = 23;
    /// Where in the picture each pixel of a warp takes its light from.
    PLACES = 24;
    /// The factor of each pixel's light.
    BLEND = 25;
    /// The black level of each pixel.
    BLACK = 26;
    /// The transfer curves of red, green and blue.
    CURVES = 27;
    /// The codes, row by row, of [`CODED_PIXELS`](crate::present::CODED_PIXELS) pixels at a time: red, green and blue of each, a byte
    /// a code.
    CODES = 28;
    /// The [`MarkedPixel`](crate::present::MarkedPixel)s.
    MARKED_PIXELS = 29;
    /// The [`Layer`](crate::present::Layer)s of all of them.
    LAYERS = 30;
    /// The colours of a picture with its marks.
    MARKED = 31;
    /// The [`TileTally`](crate::TileTally)s.
    TALLIES = 32;
    /// The [`PaintBlock`](crate::PaintBlock).
    PAINT = 33;
    /// The [`FanBlock`](crate::FanBlock), then A of each view.
    FAN = 34;
    /// The [`PlaneBand`](crate::PlaneBand)s.
    BANDS = 35;
    /// Their [`PlaneLayer`](crate::PlaneLayer)s.
    PLANE_LAYERS = 36;
    /// What is sampled of each column of a row plane.
    SAMPLES = 37;
    /// Means of what lies behind each.
    MEANS = 38;
    /// What those of each block of pixels err.
    ERRORS = 39;
    /// Of each row of each view, how often each block of pixels was swept and saw farther.
    OPEN = 40;
    /// A [`PlaneFound`](crate::PlaneFound) for each row of tiles.
    FOUND = 41;
    /// The [`PlaneVariation`](crate::PlaneVariation)s.
    VARIATION = 42;
    /// The most that enhancers multiply an extinction by, block by block of each band's layers.
    FACTORS = 43;
    /// The largest importance that each pixel of the bands has met.
    MOST_IMPORTANT = 44;
}

#[cfg(test)]
mod tests {
    use super::ALL;

    #[test]
    fn no_number_is_used_twice() {
        for (index, (name, number)) in ALL.iter().enumerate() {
            let twin = ALL[..index].iter().find(|(_, other)| other == number);
            assert_eq!(twin, None, "{name}");
        }
    }
}
