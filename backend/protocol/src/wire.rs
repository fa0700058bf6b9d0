//! The bytes of a message. They are the same on every host: little-endian, integers at full width.
//!
//! | offset | bytes | what |
//! | --- | --- | --- |
//! | 0 | 4 | `LLMW`, little-endian |
//! | 4 | 4 | [`PROTOCOL_VERSION`] |
//! | 8 | 4 | n, the length of the body |
//! | 12 | n | the message, bincode with fixed-width integers; an image, and the maps of a setup, without their numbers |
//! | 12 + n | 16 · width · height | an image's numbers as f32, or |
//! | 12 + n | 3 · width · height | the codes of an image for a screen, or |
//! | 12 + n | | the numbers of the maps of a setup, as `maps` has them; nothing for other messages |
//!
//! The numbers of an image stay outside the body for two reasons: a limit of its own on the body bounds what a
//! hostile length may allocate, and they are copied as one block. Bincode visits them one at a time: for 800 × 600
//! pixels 5 ms and 6 ms against 4 ms and 4 ms in a release build, but 130 ms and 180 ms against 8 ms and 4 ms in a
//! debug build, in which the tests run.

use super::maps;
use super::{FromBackend, FromFrontend, PROTOCOL_VERSION, ProjectorImage, ScreenImage};
use bincode::config::{Configuration, Fixint, Limit, LittleEndian};
use display_config::MOST_PIXELS;
use serde::{Serialize, de::DeserializeOwned};
use std::borrow::Cow;

const MAGIC: u32 = u32::from_le_bytes(*b"LLMW");
const VERSION_AT: usize = size_of::<u32>();
const BODY_LENGTH_AT: usize = VERSION_AT + size_of::<u32>();
const BODY_AT: usize = BODY_LENGTH_AT + size_of::<u32>();

/// Longest body: the setup of a display needs about 200 bytes per projector, maps apart, so this holds 20,000 of them.
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
        "the picture of projector {projector} has {numbers} numbers for {width} × {height} pixels of {per_pixel}"
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
        /// Numbers of a pixel.
        per_pixel: usize,
    },
}

/// A message without the numbers of its picture or of its maps, and these as bytes; None where there are none.
pub type Parted<'a, M> = Option<(M, Cow<'a, [u8]>)>;

/// A message that can travel as bytes.
pub trait WireMessage: Serialize + DeserializeOwned {
    /// The message without these numbers, and these as bytes; None where it carries none.
    ///
    /// # Errors
    /// The numbers do not fill the picture's raster.
    fn part(&self) -> Result<Parted<'_, Self>, WireError>;

    /// Puts these bytes back into a message that came without them.
    ///
    /// # Errors
    /// They do not fill its picture's raster or its maps, or it carries none and there are some.
    fn join(&mut self, bytes: &[u8]) -> Result<(), WireError>;
}

impl WireMessage for FromFrontend {
    fn part(&self) -> Result<Parted<'_, Self>, WireError> {
        let Self::Setup(setup) = self else { return Ok(None) };
        let bytes = maps::bytes_of(&setup.options.display);
        // Maps leave their numbers out by themselves.
        Ok((!bytes.is_empty()).then(|| (self.clone(), Cow::from(bytes))))
    }

    fn join(&mut self, bytes: &[u8]) -> Result<(), WireError> {
        match self {
            Self::Setup(setup) => maps::fill(&mut setup.options.display, bytes)
                .map_err(|error| WireError::Damaged(error.into_owned())),
            _ => nothing_follows(bytes),
        }
    }
}

impl WireMessage for FromBackend {
    fn part(&self) -> Result<Parted<'_, Self>, WireError> {
        Ok(match self {
            Self::Image(image) => {
                check_raster(image.projector, [image.width, image.height], 4, image.rgba.len())?;
                Some((Self::Image(ProjectorImage { rgba: Vec::new(), ..*image }), bytes_of(&image.rgba)))
            }
            Self::Screen(image) => {
                check_raster(image.projector, [image.width, image.height], 3, image.rgb.len())?;
                Some((Self::Screen(ScreenImage { rgb: Vec::new(), ..*image }), Cow::from(&image.rgb)))
            }
            _ => None,
        })
    }

    fn join(&mut self, bytes: &[u8]) -> Result<(), WireError> {
        match self {
            Self::Image(image) => {
                check_bytes([image.width, image.height], 4 * size_of::<f32>(), image.rgba.is_empty(), bytes)?;
                image.rgba = numbers_of(bytes);
            }
            Self::Screen(image) => {
                check_bytes([image.width, image.height], 3, image.rgb.is_empty(), bytes)?;
                image.rgb = bytes.to_vec();
            }
            _ => nothing_follows(bytes)?,
        }
        Ok(())
    }
}

/// The bytes of `message`, in the layout at the top of this file.
pub fn encode<M: WireMessage>(message: &M) -> Result<Vec<u8>, WireError> {
    let (bare, pixels) =
        message.part()?.map_or((None, Cow::default()), |(bare, pixels)| (Some(bare), pixels));
    let pixel_bytes = pixels.len();
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
    bytes.extend_from_slice(&pixels);
    Ok(bytes)
}

/// The message in `bytes`. Every byte must be used. Whatever the bytes are, it allocates at most
/// [`BODY_LIMIT_BYTES`] and a small multiple of their own length.
pub fn decode<M: WireMessage>(bytes: &[u8]) -> Result<M, WireError> {
    within(bytes.len(), MESSAGE_LIMIT_BYTES)?;
    let (Some(MAGIC), Some(theirs), Some(body_bytes)) =
        (word(bytes, 0), word(bytes, VERSION_AT), word(bytes, BODY_LENGTH_AT))
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
    message.join(pixels)?;
    Ok(message)
}

/// Whether these bytes carry the numbers of a picture: who only passes messages on has no reason to decode those.
pub fn has_picture(bytes: &[u8]) -> bool {
    word(bytes, BODY_LENGTH_AT).is_some_and(|body_bytes| bytes.len() - BODY_AT > body_bytes as usize)
}

/// The number at a place of the header; None where the bytes end before it does.
fn word(bytes: &[u8], at: usize) -> Option<u32> {
    bytes.get(at..at + size_of::<u32>()).and_then(|b| b.try_into().ok()).map(u32::from_le_bytes)
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

fn nothing_follows(bytes: &[u8]) -> Result<(), WireError> {
    if bytes.is_empty() {
        Ok(())
    } else {
        Err(WireError::Damaged(format!("{} bytes follow it", bytes.len())))
    }
}

/// Whether a picture has so many numbers for each pixel.
fn check_raster(
    projector: u32,
    [width, height]: [u32; 2],
    per_pixel: usize,
    numbers: usize,
) -> Result<(), WireError> {
    if product([width, height], per_pixel) == Some(numbers) {
        return Ok(());
    }
    Err(WireError::Raster { projector, numbers, width, height, per_pixel })
}

/// Whether so many bytes for each pixel have come, and no numbers before them.
fn check_bytes(raster: [u32; 2], per_pixel: usize, is_bare: bool, bytes: &[u8]) -> Result<(), WireError> {
    if !is_bare {
        return Err(WireError::Damaged("the numbers of a picture must not be in its body".to_owned()));
    }
    if product(raster, per_pixel) != Some(bytes.len()) {
        let [width, height] = raster;
        return Err(WireError::Damaged(format!("{} bytes for {width} × {height} pixels", bytes.len())));
    }
    Ok(())
}

fn product([width, height]: [u32; 2], per_pixel: usize) -> Option<usize> {
    (width as usize).checked_mul(height as usize)?.checked_mul(per_pixel)
}

/// Whole blocks, because a picture has millions of numbers.
fn bytes_of(rgba: &[f32]) -> Cow<'_, [u8]> {
    match cfg!(target_endian = "little") {
        true => Cow::from(bytemuck::cast_slice(rgba)),
        false => rgba.iter().flat_map(|number| number.to_le_bytes()).collect(),
    }
}

fn numbers_of(pixels: &[u8]) -> Vec<f32> {
    let mut numbers: Vec<f32> = bytemuck::pod_collect_to_vec(pixels);
    if cfg!(target_endian = "big") {
        numbers.iter_mut().for_each(|number| *number = f32::from_bits(number.to_bits().swap_bytes()));
    }
    numbers
}

#[cfg(test)]
#[path = "wire_tests.rs"]
mod tests;
