//! What a plot shows.

/// Tones there are; the first [`RAMP`] go from violet to yellow, for what is ordered.
pub(super) const TONES: usize = 11;
/// Tones of the ramp.
pub(super) const RAMP: usize = 6;

/// A shape at a point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mark {
    /// A filled circle.
    Dot,
    /// A filled square.
    Square,
    /// A filled square on its corner.
    Diamond,
    /// A filled triangle.
    Triangle,
    /// A wide circle that leaves what it surrounds to be seen.
    Ring,
    /// Nothing: only the line.
    None,
}

/// A line through the points.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stroke {
    /// None.
    None,
    /// A thin one.
    Thin,
    /// A thin broken one.
    Dashed,
    /// A wide pale one, behind everything else.
    Wide,
}

/// A point.
#[derive(Clone, Debug, PartialEq)]
pub struct Point {
    /// Along the horizontal axis.
    pub x: f64,
    /// Along the vertical axis.
    pub y: f64,
    /// Its tooltip in a browser.
    pub title: String,
}

/// Points that belong together.
#[derive(Clone, Debug, PartialEq)]
pub struct Series {
    /// What the legend calls them.
    pub name: String,
    /// Which colour: see [`Series::ramp`] and [`Series::tone`]; None for that of the text.
    pub(super) tone: Option<usize>,
    /// What is drawn at each.
    pub mark: Mark,
    /// What is drawn through them, in their order.
    pub stroke: Stroke,
    /// The points.
    pub points: Vec<Point>,
    /// What is written beside the last of them.
    pub label: Option<String>,
}

impl Series {
    /// Points in the colour of the text, with nothing drawn yet.
    pub fn new(name: impl Into<String>, points: Vec<Point>) -> Self {
        let (mark, stroke) = (Mark::None, Stroke::None);
        Self { name: name.into(), tone: None, mark, stroke, points, label: None }
    }

    /// In the colour of the `place`-th of `count` ordered things.
    pub fn ramp(self, place: usize, count: usize) -> Self {
        let last = count.saturating_sub(1).max(1);
        Self { tone: Some((place * (RAMP - 1) / last).min(RAMP - 1)), ..self }
    }

    /// In one of the colours for things without order.
    pub fn tone(self, number: usize) -> Self {
        Self { tone: Some(RAMP + number % (TONES - RAMP)), ..self }
    }

    /// With a shape at each point.
    pub fn mark(self, mark: Mark) -> Self {
        Self { mark, ..self }
    }

    /// With a line.
    pub fn stroke(self, stroke: Stroke) -> Self {
        Self { stroke, ..self }
    }

    /// With a word beside its last point.
    pub fn label(self, label: impl Into<String>) -> Self {
        Self { label: Some(label.into()), ..self }
    }

    /// The CSS class of its colour.
    pub(super) fn class(&self) -> String {
        self.tone.map_or("plot-ink".to_owned(), |tone| format!("plot-t{tone}"))
    }
}
