//! What a front-end and a back-end say to each other.

mod draw;
mod frame;
mod image;
mod maps;
mod mark;
mod message;
mod report;
mod setup;
mod wall;
pub mod wire;

pub use draw::{Advance, CodesAt, Draw, DrawError, Render, RenderEvent, StopAsked};
pub use frame::{FrameState, Pace, Refinement, SubFrame};
pub use image::{ProjectorImage, ScreenImage};
pub use mark::{Mark, MarkShape, Paint};
pub use message::{FromBackend, FromFrontend, PROTOCOL_VERSION};
pub use report::{Caster, FrameReport, Refined, Stages, Upkeep};
pub use setup::{
    AdapterWish, CasterChoice, DeviceChoice, DeviceInfo, FilterChoice, Held, Hello, RendererOptions, Screens,
    Setup, SwapchainChoice, VolumeRef,
};
pub use wall::{Canvas, DeviceCodes, PaintedPart, ScreenPicture, Wall, WallError};
