//! The pages of a TIFF file, decoded one at a time.

use super::ends::Checked;
use super::relabel::Relabelled;
use bricks::volume::{Element, MAX_EDGE_VOXELS, VolumeError};
use std::io::{Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};
use tiff::TiffError;
use tiff::decoder::ifd::Value;
use tiff::decoder::{ChunkType, Decoder, DecodingSampleType, Limits};
use tiff::tags::{ByteOrder, CompressionMethod, PlanarConfiguration, Tag};

/// Bytes of a tag's value that are believed: the description of a large OME file is a long text.
const MOST_TAG_BYTES: u64 = 64 << 20;
/// Memory that a decoder may always take.
const LEAST_LIMIT_BYTES: u64 = 1 << 20;
/// None of the packings makes fewer bytes of so many: a block of Zstandard has 128 KiB, and takes four.
const LARGEST_RATIO: u64 = 1 << 15;
/// Bit of NewSubfileType: a smaller version of another page.
const REDUCED: u32 = 1;

/// The unit of resolutions where a file names none.
pub(super) const INCH: u16 = 2;

/// What the pages of a volume have in common.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct PageFormat {
    pub width: u32,
    pub height: u32,
    pub element: Element,
    /// Numbers per pixel.
    pub samples: u32,
    /// Whether the samples lie in planes of their own, not side by side.
    pub is_planar: bool,
}

impl PageFormat {
    /// Numbers of one channel.
    pub fn pixels(&self) -> usize {
        self.width as usize * self.height as usize
    }

    /// Bytes of a decoded page.
    pub fn bytes(&self) -> usize {
        self.pixels() * self.samples as usize * self.element.bytes()
    }
}

impl std::fmt::Display for PageFormat {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{} × {} × {} of {}", self.width, self.height, self.samples, self.element)
    }
}

/// An open file and its pages, thumbnails left out.
pub(super) struct TiffFile {
    pub path: PathBuf,
    pub format: PageFormat,
    /// Whether its numbers stand for the colours of a palette.
    pub has_palette: bool,
    /// Numbers of the pages among all of the file.
    pub pages: Vec<usize>,
    decoder: Decoder<Relabelled>,
    length: u64,
    /// Where the pages lie without a list of pages: one after the other from this byte.
    contiguous: Option<u64>,
}

impl TiffFile {
    /// Reads what all pages say of themselves, and checks that they agree.
    pub fn open(path: &Path) -> Result<Self, VolumeError> {
        let length = super::super::file::file_length(path)?;
        let (file, count) = Relabelled::open(path).map_err(VolumeError::read(path))?;
        let (limits, has_palette) = (limits(length), file.has_palette);
        let decoder = Decoder::new(file).map_err(|cause| damaged(path, 0, &cause))?.with_limits(limits);
        let format = PageFormat { width: 0, height: 0, element: Element::U8, samples: 1, is_planar: false };
        let mut file = Self {
            path: path.into(),
            format,
            has_palette,
            pages: Vec::new(),
            decoder,
            length,
            contiguous: None,
        };
        for page in 0..count {
            file.add_page(page)?;
        }
        if file.pages.is_empty() {
            return Err(VolumeError::unsupported(path, "it holds no page but thumbnails"));
        }
        file.go_to(file.pages[0])?;
        Ok(file)
    }

    fn add_page(&mut self, page: usize) -> Result<(), VolumeError> {
        self.go_to(page)?;
        let kind = self.decoder.find_tag_unsigned::<u32>(Tag::NewSubfileType);
        if kind.map_err(|cause| damaged(&self.path, page, &cause))?.unwrap_or(0) & REDUCED != 0 {
            return Ok(());
        }
        let format = self.page_format(page)?;
        if self.pages.is_empty() {
            self.format = format;
        }
        if format != self.format {
            let what = format!(
                "page {} is {format}, and page {} is {}: all must be alike, so split the file",
                page + 1,
                self.pages[0] + 1,
                self.format
            );
            return Err(VolumeError::unsupported(&self.path, what));
        }
        self.pages.push(page);
        Ok(())
    }

    fn go_to(&mut self, page: usize) -> Result<(), VolumeError> {
        self.decoder.seek_to_image(page).map_err(|cause| damaged(&self.path, page, &cause))
    }

    fn page_format(&mut self, page: usize) -> Result<PageFormat, VolumeError> {
        let path = self.path.clone();
        let wrong = |cause: TiffError| damaged(&path, page, &cause);
        let (width, height) = self.decoder.dimensions().map_err(wrong)?;
        if [width, height].iter().any(|edge| !(1..=MAX_EDGE_VOXELS).contains(edge)) {
            let what =
                format!("page {} is {width} × {height}: each must be from 1 to {MAX_EDGE_VOXELS}", page + 1);
            return Err(VolumeError::header(&path, what));
        }
        let layout = self.decoder.image_buffer_layout().map_err(wrong)?;
        let color = self.decoder.colortype().map_err(wrong)?;
        let planar: Option<u16> = self.decoder.find_tag_unsigned(Tag::PlanarConfiguration).map_err(wrong)?;
        let Some(element) = element(layout.sample_type, color.bit_depth()) else {
            let what = format!(
                "page {} has numbers of {} bits in the format {:?}: save it with 8, 16 or 32 bits",
                page + 1,
                color.bit_depth(),
                layout.sample_format
            );
            return Err(VolumeError::unsupported(&path, what));
        };
        let format = PageFormat {
            width,
            height,
            element,
            samples: u32::from(color.num_samples()),
            is_planar: planar == Some(PlanarConfiguration::Planar.to_u16()),
        };
        self.check_length(&format)?;
        if layout.complete_len != format.bytes() {
            let what =
                format!("page {} has {} bytes, and {format} is expected", page + 1, layout.complete_len);
            return Err(VolumeError::unsupported(&path, what));
        }
        Ok(format)
    }

    /// Whether the file can hold such a page, before memory is taken for it.
    fn check_length(&mut self, format: &PageFormat) -> Result<(), VolumeError> {
        let ratio = if self.is_plain() { 1 } else { LARGEST_RATIO };
        let promised = format.bytes() as u64;
        if promised <= self.length.saturating_mul(ratio) {
            return Ok(());
        }
        let found = format!("the file has {}", self.length);
        Err(VolumeError::Truncated { path: self.path.clone(), promised, found })
    }

    fn is_plain(&mut self) -> bool {
        let compression: Option<u16> = self.decoder.find_tag_unsigned(Tag::Compression).ok().flatten();
        compression.is_none_or(|compression| compression == CompressionMethod::None.to_u16())
    }

    /// Takes the only page that is listed for the first of `count` that follow one another, as ImageJ writes
    /// stacks beyond 4 GiB.
    pub fn set_contiguous(&mut self, count: u32) -> Result<(), VolumeError> {
        let offsets = self.decoder.find_tag_unsigned_vec::<u64>(Tag::StripOffsets);
        let offsets = offsets.map_err(|cause| damaged(&self.path, 0, &cause))?;
        let Some(start) = offsets.and_then(|offsets| offsets.first().copied()).filter(|_| self.is_plain())
        else {
            let what =
                format!("one page is listed of {count} that are promised, and it is packed: save it again");
            return Err(VolumeError::unsupported(&self.path, what));
        };
        let promised = self.format.bytes() as u64 * u64::from(count);
        let found = self.length.saturating_sub(start);
        if promised > found {
            let found = format!("{found} are there");
            return Err(VolumeError::Truncated { path: self.path.clone(), promised, found });
        }
        self.pages = (0..count as usize).collect();
        self.contiguous = Some(start);
        Ok(())
    }

    /// Decodes the page at a place in `pages`: [`PageFormat::bytes`] in this machine's byte order.
    pub fn read(&mut self, place: usize, bytes: &mut [u8]) -> Result<(), VolumeError> {
        let page = self.pages[place];
        let decoded = match self.contiguous {
            None => {
                self.go_to(page)?;
                self.decoder.read_image_bytes(bytes).and_then(|()| self.check_ends())
            }
            Some(start) => self.read_contiguous(start + (page * bytes.len()) as u64, bytes),
        };
        decoded.map_err(|cause| damaged(&self.path, page, &cause))
    }

    /// Checks the ends of what the page at hand is packed in.
    fn check_ends(&mut self) -> Result<(), TiffError> {
        let compression: Option<u16> = self.decoder.find_tag_unsigned(Tag::Compression)?;
        let Some(checked) = compression.and_then(Checked::of) else { return Ok(()) };
        let (offsets, bytes) = match self.decoder.get_chunk_type() {
            ChunkType::Strip => (Tag::StripOffsets, Tag::StripByteCounts),
            ChunkType::Tile => (Tag::TileOffsets, Tag::TileByteCounts),
        };
        let offsets = self.decoder.get_tag_u64_vec(offsets)?;
        let places: Vec<_> = offsets.into_iter().zip(self.decoder.get_tag_u64_vec(bytes)?).collect();
        let (width, height) = self.decoder.chunk_dimensions();
        let samples = if self.format.is_planar { 1 } else { u64::from(self.format.samples) };
        let most_bytes = u64::from(width) * u64::from(height) * samples * self.format.element.bytes() as u64;
        Ok(checked.check(self.decoder.inner(), &places, most_bytes)?)
    }

    fn read_contiguous(&mut self, start: u64, bytes: &mut [u8]) -> Result<(), TiffError> {
        let file = self.decoder.inner();
        file.seek(SeekFrom::Start(start))?;
        file.read_exact(bytes)?;
        if self.decoder.byte_order() != ByteOrder::native() {
            bytes.chunks_exact_mut(self.format.element.bytes()).for_each(<[u8]>::reverse);
        }
        Ok(())
    }

    /// What the first page says in words; empty if it says nothing.
    pub fn description(&mut self) -> String {
        let mut tags = self.decoder.image_ifd();
        let bytes = tags.find_entry(Tag::ImageDescription).map_or(0, |entry| entry.count());
        let mut text = vec![0; bytes.min(self.length).min(MOST_TAG_BYTES) as usize];
        match tags.find_tag_bytes(Tag::ImageDescription, &mut text, 0) {
            // ImageJ writes Latin-1 if its text is not ASCII.
            Ok(_) => String::from_utf8(text)
                .unwrap_or_else(|text| text.as_bytes().iter().map(|&byte| char::from(byte)).collect()),
            Err(_) => String::new(),
        }
    }

    /// Pixels per unit along x and y, and the unit's number (TIFF 6.0, page 38).
    pub fn resolution(&mut self) -> Option<([f64; 2], u16)> {
        let resolution = [self.ratio(Tag::XResolution)?, self.ratio(Tag::YResolution)?];
        let unit = self.decoder.find_tag_unsigned(Tag::ResolutionUnit).ok().flatten();
        Some((resolution, unit.unwrap_or(INCH)))
    }

    /// A positive number.
    fn ratio(&mut self, tag: Tag) -> Option<f64> {
        let number = match self.decoder.find_tag(tag).ok()?? {
            Value::Rational(over, under) => f64::from(over) / f64::from(under),
            Value::Float(number) => f64::from(number),
            Value::Double(number) => number,
            _ => return None,
        };
        (number.is_finite() && number > 0.0).then_some(number)
    }
}

fn limits(length: u64) -> Limits {
    let mut limits = Limits::default();
    limits.ifd_value_size = length.clamp(LEAST_LIMIT_BYTES, MOST_TAG_BYTES) as usize;
    // Tags are decoded to lists of values that are larger than in the file.
    limits.decoding_buffer_size =
        (length.saturating_mul(8)).clamp(LEAST_LIMIT_BYTES, MOST_TAG_BYTES) as usize;
    limits.intermediate_buffer_size = length as usize;
    limits
}

fn element(sample: Option<DecodingSampleType>, bits: u8) -> Option<Element> {
    let element = match sample? {
        DecodingSampleType::U8 => Element::U8,
        DecodingSampleType::I8 => Element::I8,
        DecodingSampleType::U16 => Element::U16,
        DecodingSampleType::I16 => Element::I16,
        DecodingSampleType::U32 => Element::U32,
        DecodingSampleType::I32 => Element::I32,
        DecodingSampleType::U64 => Element::U64,
        DecodingSampleType::I64 => Element::I64,
        DecodingSampleType::F32 => Element::F32,
        DecodingSampleType::F64 => Element::F64,
        DecodingSampleType::F16 => return None,
    };
    (usize::from(bits) == 8 * element.bytes()).then_some(element)
}

fn damaged(path: &Path, page: usize, cause: &TiffError) -> VolumeError {
    let cause = cause.to_string().replace('\n', " ");
    let what = match cause {
        cause if cause.is_empty() => "it is damaged".to_owned(),
        cause => cause,
    };
    let what = format!("page {}: {what}; copy the file again, or save it without packing", page + 1);
    VolumeError::unsupported(path, what)
}
