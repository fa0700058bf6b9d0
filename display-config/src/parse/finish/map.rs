//! The file of a map: a grey PNG, or a PFM of one channel.

use crate::finish::{LightMap, MapFault};
use crate::text::read_bytes;
use image::codecs::png::PngDecoder;
use image::{ColorType, ImageDecoder};
use std::io::Cursor;
use std::path::Path;

const PNG: &[u8] = b"\x89PNG\r\n\x1a\n";

pub(super) fn read(path: &Path) -> Result<LightMap, MapFault> {
    let bytes = read_bytes(path).map_err(MapFault::Read)?;
    match bytes.get(..2) {
        _ if bytes.starts_with(PNG) => of_png(&bytes),
        Some(b"Pf") => of_pfm(&bytes),
        Some(b"PF") => Err(MapFault::Colours),
        _ => Err(MapFault::Format),
    }
}

fn of_png(bytes: &[u8]) -> Result<LightMap, MapFault> {
    let damaged = |error: image::ImageError| MapFault::Damaged(error.to_string().replace('\n', ", "));
    let decoder = PngDecoder::new(Cursor::new(bytes)).map_err(damaged)?;
    let (width, height) = decoder.dimensions();
    LightMap::pixels(width, height)?;
    let shares: fn(&[u8]) -> Vec<u16> = match decoder.color_type() {
        // 257 · 255 = 65535: a white of 8 bits is a white of 16.
        ColorType::L8 => |codes| codes.iter().map(|&code| 257 * u16::from(code)).collect(),
        ColorType::L16 => {
            |codes| codes.chunks_exact(2).map(|code| u16::from_ne_bytes([code[0], code[1]])).collect()
        }
        _ => return Err(MapFault::Colours),
    };
    let mut codes = vec![0; decoder.total_bytes() as usize];
    decoder.read_image(&mut codes).map_err(damaged)?;
    LightMap::new(width, height, shares(&codes))
}

/// As Debevec's: `Pf`, width and height, a scale whose sign is that of big-endian numbers, one byte of white space, and
/// rows of f32 from the bottom.
fn of_pfm(bytes: &[u8]) -> Result<LightMap, MapFault> {
    let damaged = || MapFault::Damaged("its head is no `Pf`, width, height and scale".to_owned());
    let (head, numbers) = head_of_pfm(bytes).ok_or_else(damaged)?;
    let [Ok(width), Ok(height)] = [head[1], head[2]].map(str::parse) else { return Err(damaged()) };
    let scale: f32 =
        head[3].parse().ok().filter(|scale: &f32| *scale != 0.0 && scale.is_finite()).ok_or_else(damaged)?;
    let pixels = LightMap::pixels(width, height)?;
    let number = |four: &[u8]| {
        let four = [four[0], four[1], four[2], four[3]];
        if scale < 0.0 { f32::from_le_bytes(four) } else { f32::from_be_bytes(four) }
    };
    if numbers.len() != 4 * pixels {
        return Err(MapFault::MapCount { found: numbers.len() / 4, width, height });
    }
    let mut shares = Vec::with_capacity(pixels);
    for (row, line) in numbers.chunks_exact(4 * width as usize).rev().enumerate() {
        for (column, value) in line.chunks_exact(4).map(number).enumerate() {
            if !(0.0..=1.0).contains(&value) {
                return Err(MapFault::MapNumber { value, column, row });
            }
            shares.push((value * f32::from(u16::MAX)).round() as u16);
        }
    }
    LightMap::new(width, height, shares)
}

/// The four words of the head, and what follows the one byte of white space behind them.
fn head_of_pfm(bytes: &[u8]) -> Option<([&str; 4], &[u8])> {
    let (mut words, mut rest) = ([""; 4], bytes);
    for word in &mut words {
        rest = rest.trim_ascii_start();
        let end = rest.iter().position(u8::is_ascii_whitespace)?;
        *word = std::str::from_utf8(&rest[..end]).ok()?;
        rest = &rest[end..];
    }
    Some((words, rest.get(1..)?))
}
