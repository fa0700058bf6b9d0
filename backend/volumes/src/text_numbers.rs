//! Numbers written as text, read as the bytes that this machine would store them in.

use bricks::volume::Element;
use std::io::{BufRead, Error, ErrorKind, Read, Result};

/// Characters of the longest number that is believed (a double has up to 327 before or after its point).
const LONGEST_NUMBER: usize = 512;

/// Numbers of one type between blanks, line ends and commas.
pub(super) struct TextNumbers<R> {
    text: R,
    element: Element,
    word: Vec<u8>,
    /// Bytes of the last number; those from `given` on were not yet asked for.
    bytes: [u8; 8],
    given: usize,
}

impl<R: BufRead> TextNumbers<R> {
    pub fn new(text: R, element: Element) -> Self {
        Self { text, element, word: Vec::new(), bytes: [0; 8], given: element.bytes() }
    }

    /// Reads the next number; false at the end of the text.
    fn advance(&mut self) -> Result<bool> {
        self.next_word()?;
        if self.word.is_empty() {
            return Ok(false);
        }
        let word = String::from_utf8_lossy(&self.word);
        self.bytes = parse(self.element, &word).ok_or_else(|| {
            Error::new(ErrorKind::InvalidData, format!("{word:?} is not a number of type {}", self.element))
        })?;
        self.given = 0;
        Ok(true)
    }

    fn next_word(&mut self) -> Result<()> {
        self.word.clear();
        loop {
            let text = self.text.fill_buf()?;
            if text.is_empty() {
                return Ok(());
            }
            let blanks = if self.word.is_empty() { count(text, is_blank) } else { 0 };
            let letters = count(&text[blanks..], |byte| !is_blank(byte));
            let is_ended = blanks + letters < text.len();
            if self.word.len() + letters > LONGEST_NUMBER {
                return Err(Error::new(ErrorKind::InvalidData, "it has a word too long for a number"));
            }
            self.word.extend_from_slice(&text[blanks..blanks + letters]);
            self.text.consume(blanks + letters);
            if is_ended && !self.word.is_empty() {
                return Ok(());
            }
        }
    }
}

impl<R: BufRead> Read for TextNumbers<R> {
    fn read(&mut self, bytes: &mut [u8]) -> Result<usize> {
        let mut written = 0;
        while written < bytes.len() {
            if self.given == self.element.bytes() && !self.advance()? {
                break;
            }
            let rest = &self.bytes[self.given..self.element.bytes()];
            let count = rest.len().min(bytes.len() - written);
            bytes[written..written + count].copy_from_slice(&rest[..count]);
            written += count;
            self.given += count;
        }
        Ok(written)
    }
}

fn is_blank(byte: u8) -> bool {
    byte.is_ascii_whitespace() || byte == b','
}

/// How many bytes from the start are of a kind.
fn count(text: &[u8], is_such: impl Fn(u8) -> bool) -> usize {
    text.iter().position(|&byte| !is_such(byte)).unwrap_or(text.len())
}

/// The bytes of a number, as many as the element has at the start of the eight.
fn parse(element: Element, word: &str) -> Option<[u8; 8]> {
    match element {
        Element::U8 => integer(word, u8::to_ne_bytes),
        Element::I8 => integer(word, i8::to_ne_bytes),
        Element::U16 => integer(word, u16::to_ne_bytes),
        Element::I16 => integer(word, i16::to_ne_bytes),
        Element::U32 => integer(word, u32::to_ne_bytes),
        Element::I32 => integer(word, i32::to_ne_bytes),
        Element::U64 => integer(word, u64::to_ne_bytes),
        Element::I64 => integer(word, i64::to_ne_bytes),
        Element::F32 => word.parse().ok().map(|number: f32| padded(number.to_ne_bytes())),
        Element::F64 => word.parse().ok().map(|number: f64| padded(number.to_ne_bytes())),
    }
}

/// A whole number, which some programs write as they write floats (`1e+06`).
fn integer<T: TryFrom<i128>, const N: usize>(word: &str, bytes: impl Fn(T) -> [u8; N]) -> Option<[u8; 8]> {
    let whole = |number: &f64| number.fract() == 0.0;
    let number =
        word.parse().ok().or_else(|| word.parse().ok().filter(whole).map(|number| number as i128))?;
    T::try_from(number).ok().map(|number| padded(bytes(number)))
}

fn padded<const N: usize>(bytes: [u8; N]) -> [u8; 8] {
    let mut padded = [0; 8];
    padded[..N].copy_from_slice(&bytes);
    padded
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::BufReader;

    fn bytes(element: Element, text: &str, buffer: usize) -> Result<Vec<u8>> {
        let mut bytes = Vec::new();
        TextNumbers::new(BufReader::with_capacity(buffer, text.as_bytes()), element)
            .read_to_end(&mut bytes)?;
        Ok(bytes)
    }

    #[test]
    fn numbers_are_the_same_however_the_text_is_cut() {
        let expected: Vec<u8> = [1i64, -2, i64::MIN].iter().flat_map(|n| n.to_ne_bytes()).collect();
        for buffer in 1..40 {
            let text = "  1, -2\n\r-9223372036854775808 \n";
            assert_eq!(bytes(Element::I64, text, buffer).unwrap(), expected, "{buffer}");
        }
        let floats: Vec<u8> = [0.5f32, f32::INFINITY, -1e-3].iter().flat_map(|n| n.to_ne_bytes()).collect();
        assert_eq!(bytes(Element::F32, "0.5 inf -1e-3", 7).unwrap(), floats);
        let wholes: Vec<u8> = [1_000_000u32, 7].iter().flat_map(|n| n.to_ne_bytes()).collect();
        assert_eq!(bytes(Element::U32, "1e+06 7.0", 7).unwrap(), wholes);
        assert!(bytes(Element::U8, "", 7).unwrap().is_empty());
    }

    #[test]
    fn what_is_no_number_is_named() {
        let said = |element, text: &str| bytes(element, text, 16).unwrap_err().to_string();
        assert!(said(Element::U8, "1 256").contains("\"256\" is not a number of type uint8"));
        assert!(said(Element::U8, "1.5").contains("\"1.5\""));
        assert!(said(Element::I64, "1e99").contains("\"1e99\""));
        assert!(said(Element::I64, "inf").contains("\"inf\""));
        assert!(said(Element::I16, "1 two").contains("\"two\""));
        assert!(said(Element::F64, &"1".repeat(9999)).contains("too long"));
        assert!(said(Element::F64, "1 \u{fffd}").contains("not a number"));
    }
}
