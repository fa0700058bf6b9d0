//! What a person does in a window.

/// A button of the mouse.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Button {
    /// The left one.
    Left,
    /// The right one, or the left one with Shift.
    Right,
}

/// Something that a person does.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Act {
    /// The mouse is dragged with a button held down; by so many pixels of the window to the right and down.
    Drag {
        /// The button.
        button: Button,
        /// To the right.
        right_px: f64,
        /// Down.
        down_px: f64,
    },
    /// The wheel is turned, away from the person: by so many notches.
    Wheel(f64),
    /// A key is pressed that writes this letter.
    Letter(char),
    /// The window is closed, or the key to leave is pressed.
    Leave,
}
