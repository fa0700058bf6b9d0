//! The protocols of inputs, by the first byte of an input to `packets`.

/// A protocol.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Protocol {
    /// DTrack's lines.
    Dtrack,
    /// A segment of OpenTrackIO.
    OpenTrackIo,
    /// A sample of OpenTrackIO in JSON.
    Json,
    /// The same in CBOR.
    Cbor,
    /// Open Sound Control.
    Osc,
    /// FreeD D1.
    FreeD,
    /// The kernel's events of a gamepad.
    Gamepad,
    /// The daemon's events of a SpaceMouse.
    SpaceMouse,
    /// What a VRPN server says, after the cookie.
    Vrpn,
}

impl Protocol {
    /// All, in the order of their bytes.
    pub const ALL: [Self; 9] = [
        Self::Dtrack,
        Self::OpenTrackIo,
        Self::Json,
        Self::Cbor,
        Self::Osc,
        Self::FreeD,
        Self::Gamepad,
        Self::SpaceMouse,
        Self::Vrpn,
    ];

    /// That of a byte; every byte has one.
    pub fn of_byte(byte: u8) -> Self {
        Self::ALL[usize::from(byte) % Self::ALL.len()]
    }
}
