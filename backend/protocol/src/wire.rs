//! The bytes of a message. They are the same on every host: little-endian, integers at full width.
//!
//! | offset | bytes | what |
//! | --- | --- | --- |
//! | 0 | 4 | `LLMW`, little-endian |
//! | 4 | 4 | [`PROTOCOL_VERSION`] |
//! | 8 | 4 | n, the length of the body |
//! | 12 | n | the message, bincode with fixed-width integers; an image without its numbers |
//! | 12 + n | 16 · width · height | an image's numbers as f32; nothing for other messages |
//!
//! The numbers of an image stay outside the body for two reasons: a limit of its own on the body bounds what a
//! hostile length may allocate, and they are copied as one block. Bincode visits them one at a time: for 800 × 600
//! pixels 5 ms and 6 ms against 4 ms and 4 ms in a release build, but 130 ms and 180 ms against 8 ms and 4 ms in a
//! debug build, in which the tests run.

use super::{FromBackend, FromFrontend, PROTOCOL_VERSION, ProjectorImage};
use bincode::config::{Configuration, Fixint, Limit, LittleEndian};
use display_config::MOST_PIXELS;
use serde::{Serialize, de::DeserializeOwned};

const MAGIC: u32 = u32::from_le_bytes(*b"LLMW");
const VERSION_AT: usize = size_of::<u32>();
const BODY_LENGTH_AT: usize = VERSION_AT + size_of::<u32>();
const BODY_AT: usize = BODY_LENGTH_AT + size_of::<u32>();

/// Longest body: the setup of a display needs about 200 bytes per projector, so this holds 20,000 of them.
pub const BODY_LIMIT_BYTES: usize = 4 << 20;

const BYTES_PER_PIXEL: usize = 4 * size_of::<f32>();

/// Longest message: the largest picture that a display may have, and a body. Below 2³¹, so a count of the kind MPI uses can
/// state it.
pub const MESSAGE_LIMIT_BYTES: usize = MOST_PIXELS as usize * BYTES_PER_PIXEL + BODY_LIMIT_BYTES;

/// Why bytes are not a message, or a message does not become bytes.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum WireError {
    /// It does not start like a message.
    #[error("these {0} bytes are not a lightloom message; is every rank a lightloom program?")]
    Foreign(usize),
    /// The other end has another version.
    #[error(
        "the other end speaks protocol {theirs} and this program {PROTOCOL_VERSION}; start lightloom and \
         lightloom-backend from the same build"
    )]
    Version {
        /// The other end's version.
        theirs: u32,
    },
    /// It ends early, is too long, or has impossible contents.
    #[error("a message is damaged: {0}")]
    Damaged(String),
    /// It is over a limit.
    #[error("a message of {bytes} bytes is over the limit of {limit}; draw with a smaller raster")]
    TooLong {
        /// Its length.
        bytes: usize,
        /// The limit it exceeds.
        limit: usize,
    },
    /// The picture's numbers do not fill its raster.
    #[error(
        "the picture of projector {projector} has {numbers} numbers for {width} × {height} pixels of four"
    )]
    Raster {
        /// The picture's projector.
        projector: u32,
        /// How many numbers it has.
        numbers: usize,
        /// Pixels along x.
        width: u32,
        /// Pixels along y.
        height: u32,
    },
}

/// A message that can travel as bytes.
pub trait WireMessage: Serialize + DeserializeOwned {
    /// The picture in the message, where it carries one.
    fn image(&self) -> Option<&ProjectorImage>;
    /// The same, to fill it in.
    fn image_mut(&mut self) -> Option<&mut ProjectorImage>;
    /// A message that holds `image`, to stand for this one; only called where [`WireMessage::image`] is not None.
    fn with_image(image: ProjectorImage) -> Option<Self>;
}

impl WireMessage for FromFrontend {
    fn image(&self) -> Option<&ProjectorImage> {
        None
    }
    fn image_mut(&mut self) -> Option<&mut ProjectorImage> {
        None
    }
    fn with_image(_: ProjectorImage) -> Option<Self> {
        None
    }
}

impl WireMessage for FromBackend {
    fn image(&self) -> Option<&ProjectorImage> {
        if let Self::Image(image) = self { Some(image) } else { None }
    }
    fn image_mut(&mut self) -> Option<&mut ProjectorImage> {
        if let Self::Image(image) = self { Some(image) } else { None }
    }
    fn with_image(image: ProjectorImage) -> Option<Self> {
        Some(Self::Image(image))
    }
}

/// The bytes of `message`, in the layout at the top of this file.
pub fn encode<M: WireMessage>(message: &M) -> Result<Vec<u8>, WireError> {
    let image = message.image();
    let pixel_bytes = image.map_or(Ok(0), checked_pixel_bytes)?;
    let bare = image.and_then(|image| M::with_image(ProjectorImage { rgba: Vec::new(), ..*image }));
    let mut bytes = Vec::with_capacity(BODY_AT + 256 + pixel_bytes);
    bytes.extend_from_slice(&MAGIC.to_le_bytes());
    bytes.extend_from_slice(&PROTOCOL_VERSION.to_le_bytes());
    bytes.extend_from_slice(&[0; size_of::<u32>()]);
    bincode::serde::encode_into_std_write(bare.as_ref().unwrap_or(message), &mut bytes, CONFIG)
        .map_err(|error| WireError::Damaged(error.to_string()))?;
    let body_bytes = bytes.len() - BODY_AT;
    within(body_bytes, BODY_LIMIT_BYTES)?;
    within(bytes.len() + pixel_bytes, MESSAGE_LIMIT_BYTES)?;
    bytes[BODY_LENGTH_AT..BODY_AT].copy_from_slice(&(body_bytes as u32).to_le_bytes());
    append_pixels(&mut bytes, image.map_or(&[], |image| &image.rgba));
    Ok(bytes)
}

/// The message in `bytes`. Every byte must be used. Whatever the bytes are, it allocates at most
/// [`BODY_LIMIT_BYTES`] and a small multiple of their own length.
pub fn decode<M: WireMessage>(bytes: &[u8]) -> Result<M, WireError> {
    within(bytes.len(), MESSAGE_LIMIT_BYTES)?;
    let word =
        |at| bytes.get(at..at + size_of::<u32>()).and_then(|b| b.try_into().ok()).map(u32::from_le_bytes);
    let (Some(MAGIC), Some(theirs), Some(body_bytes)) = (word(0), word(VERSION_AT), word(BODY_LENGTH_AT))
    else {
        return Err(WireError::Foreign(bytes.len()));
    };
    if theirs != PROTOCOL_VERSION {
        return Err(WireError::Version { theirs });
    }
    let body_bytes = within(body_bytes as usize, BODY_LIMIT_BYTES)?;
    let (body, pixels) = bytes[BODY_AT..]
        .split_at_checked(body_bytes)
        .ok_or_else(|| WireError::Damaged(format!("its body should have {body_bytes} bytes")))?;
    let mut message: M = decode_body(body)?;
    match message.image_mut() {
        Some(image) => take_pixels(image, pixels)?,
        None if pixels.is_empty() => {}
        None => return Err(WireError::Damaged(format!("{} bytes follow it", pixels.len()))),
    }
    Ok(message)
}

/// Fixed-width integers, so that the limit counts exactly the bytes that are read.
const CONFIG: Configuration<LittleEndian, Fixint, Limit<BODY_LIMIT_BYTES>> =
    bincode::config::standard().with_fixed_int_encoding().with_limit::<BODY_LIMIT_BYTES>();

fn decode_body<M: DeserializeOwned>(body: &[u8]) -> Result<M, WireError> {
    let (message, used) = bincode::serde::decode_from_slice(body, CONFIG)
        .map_err(|error| WireError::Damaged(error.to_string()))?;
    if used == body.len() {
        Ok(message)
    } else {
        Err(WireError::Damaged(format!("its body has {} bytes, of which {used} mean something", body.len())))
    }
}

fn within(bytes: usize, limit: usize) -> Result<usize, WireError> {
    if bytes <= limit { Ok(bytes) } else { Err(WireError::TooLong { bytes, limit }) }
}

fn checked_pixel_bytes(image: &ProjectorImage) -> Result<usize, WireError> {
    let bytes = pixel_bytes_of_raster(image).filter(|&bytes| bytes == size_of_val(image.rgba.as_slice()));
    bytes.ok_or(WireError::Raster {
        projector: image.projector,
        numbers: image.rgba.len(),
        width: image.width,
        height: image.height,
    })
}

fn pixel_bytes_of_raster(image: &ProjectorImage) -> Option<usize> {
    (image.width as usize).checked_mul(image.height as usize)?.checked_mul(BYTES_PER_PIXEL)
}

/// Whole blocks, because a picture has millions of numbers.
fn append_pixels(bytes: &mut Vec<u8>, rgba: &[f32]) {
    if cfg!(target_endian = "little") {
        bytes.extend_from_slice(bytemuck::cast_slice(rgba));
    } else {
        bytes.extend(rgba.iter().flat_map(|number| number.to_le_bytes()));
    }
}

fn numbers_of(pixels: &[u8]) -> Vec<f32> {
    let mut numbers: Vec<f32> = bytemuck::pod_collect_to_vec(pixels);
    if cfg!(target_endian = "big") {
        numbers.iter_mut().for_each(|number| *number = f32::from_bits(number.to_bits().swap_bytes()));
    }
    numbers
}

fn take_pixels(image: &mut ProjectorImage, pixels: &[u8]) -> Result<(), WireError> {
    if !image.rgba.is_empty() {
        return Err(WireError::Damaged("the numbers of a picture must be in its body".to_owned()));
    }
    if pixel_bytes_of_raster(image) != Some(pixels.len()) {
        let (width, height) = (image.width, image.height);
        return Err(WireError::Damaged(format!("{} bytes for {width} × {height} pixels", pixels.len())));
    }
    image.rgba = numbers_of(pixels);
    Ok(())
}

#[cfg(test)]
#[path = "wire_tests.rs"]
mod tests;
