//! The decompressors, kept from unpacking more than a chunk can hold.
//!
//! zarrs takes the memory that a packed chunk's own header asks for, or as much as comes out of it. A damaged or
//! hostile chunk of some bytes would so end the program; here it is an error.

use super::super::gzip::Gzip;
use flate2::bufread::ZlibDecoder;
use std::borrow::Cow;
use std::io::Read;
use std::sync::{Arc, Once};
use zarrs::array::codec::api::{
    CodecRuntimePluginV2, CodecRuntimePluginV3, PartialDecoderCapability, PartialEncoderCapability,
    register_codec_v2, register_codec_v3,
};
use zarrs::array::codec::{BloscCodec, GzipCodec, ZlibCodec, ZstdCodec};
use zarrs::array::{
    ArrayBytesRaw, BytesRepresentation, BytesToBytesCodecTraits, Codec, CodecError, CodecMetadataOptions,
    CodecOptions, CodecTraits, CodecTraitsV2, CodecTraitsV3, RecommendedConcurrency,
};
use zarrs::metadata::Configuration;
use zarrs::plugin::{ExtensionAliases, ExtensionName, ZarrVersion, ZarrVersion2, ZarrVersion3};

/// Largest unpacked chunk where zarrs does not know how large it is.
const MOST_BYTES: u64 = 2 << 30;

/// Puts the bounded decompressors in the place of those of zarrs, for the whole process and once.
pub(super) fn register() {
    static ONCE: Once = Once::new();
    ONCE.call_once(|| {
        register_one::<GzipCodec>(Packing::Gzip);
        register_one::<ZlibCodec>(Packing::Zlib);
        register_one::<ZstdCodec>(Packing::Zstd);
        register_one::<BloscCodec>(Packing::Blosc);
    });
}

fn register_one<T>(packing: Packing)
where
    T: CodecTraitsV2
        + CodecTraitsV3
        + ExtensionAliases<ZarrVersion2>
        + ExtensionAliases<ZarrVersion3>
        + 'static,
{
    let bounded = move |codec| match codec {
        Codec::BytesToBytes(inner) => Codec::BytesToBytes(Arc::new(Bounded { packing, inner })),
        other => other,
    };
    register_codec_v2(CodecRuntimePluginV2::new(
        <T as ExtensionAliases<ZarrVersion2>>::matches_name,
        move |metadata| <T as CodecTraitsV2>::create(metadata).map(bounded),
    ));
    register_codec_v3(CodecRuntimePluginV3::new(
        <T as ExtensionAliases<ZarrVersion3>>::matches_name,
        move |metadata| <T as CodecTraitsV3>::create(metadata).map(bounded),
    ));
}

#[derive(Clone, Copy, Debug)]
enum Packing {
    Gzip,
    Zlib,
    Zstd,
    Blosc,
}

/// A codec of zarrs of which all is kept but the unpacking.
#[derive(Debug)]
struct Bounded {
    packing: Packing,
    inner: Arc<dyn BytesToBytesCodecTraits>,
}

impl Bounded {
    fn unpack<'a>(
        &self,
        packed: ArrayBytesRaw<'a>,
        representation: &BytesRepresentation,
        options: &CodecOptions,
    ) -> Result<ArrayBytesRaw<'a>, CodecError> {
        let most = representation.size().unwrap_or(MOST_BYTES);
        let unpacked = match self.packing {
            Packing::Gzip => read_at_most(Gzip::new(&packed[..]), most)?,
            Packing::Zlib => read_at_most(ZlibDecoder::new(&packed[..]), most)?,
            Packing::Zstd => read_at_most(zstd::Decoder::with_buffer(&packed[..])?, most)?,
            Packing::Blosc => {
                check_blosc(&packed, most)?;
                return self.inner.decode(packed, representation, options);
            }
        };
        Ok(Cow::Owned(unpacked))
    }
}

fn read_at_most(packed: impl Read, most: u64) -> Result<Vec<u8>, CodecError> {
    let mut unpacked = Vec::new();
    packed.take(most.saturating_add(1)).read_to_end(&mut unpacked)?;
    match unpacked.len() as u64 > most {
        true => Err(too_much(most)),
        false => Ok(unpacked),
    }
}

/// A blosc chunk starts with 16 bytes, of which the second four are the number of unpacked bytes.
fn check_blosc(packed: &[u8], most: u64) -> Result<(), CodecError> {
    let unpacked = packed.get(4..8).and_then(|bytes| bytes.try_into().ok()).map(u32::from_le_bytes);
    match unpacked {
        Some(unpacked) if u64::from(unpacked) <= most => Ok(()),
        Some(_) => Err(too_much(most)),
        None => Err(CodecError::Other("it is shorter than the header of blosc".into())),
    }
}

fn too_much(most: u64) -> CodecError {
    CodecError::Other(format!("it unpacks to more than the {most} bytes that it can hold"))
}

impl ExtensionName for Bounded {
    fn name(&self, version: ZarrVersion) -> Option<Cow<'static, str>> {
        self.inner.name(version)
    }
}

impl CodecTraits for Bounded {
    fn as_any(&self) -> &dyn std::any::Any {
        self
    }

    fn configuration(&self, version: ZarrVersion, options: &CodecMetadataOptions) -> Option<Configuration> {
        self.inner.configuration(version, options)
    }

    fn partial_decoder_capability(&self) -> PartialDecoderCapability {
        // A packed chunk is unpacked whole, and kept while parts of it are asked for.
        PartialDecoderCapability { partial_read: false, partial_decode: false }
    }

    fn partial_encoder_capability(&self) -> PartialEncoderCapability {
        self.inner.partial_encoder_capability()
    }
}

impl BytesToBytesCodecTraits for Bounded {
    fn into_dyn(self: Arc<Self>) -> Arc<dyn BytesToBytesCodecTraits> {
        self
    }

    fn recommended_concurrency(
        &self,
        representation: &BytesRepresentation,
    ) -> Result<RecommendedConcurrency, CodecError> {
        self.inner.recommended_concurrency(representation)
    }

    fn encoded_representation(&self, representation: &BytesRepresentation) -> BytesRepresentation {
        self.inner.encoded_representation(representation)
    }

    fn encode<'a>(
        &self,
        bytes: ArrayBytesRaw<'a>,
        options: &CodecOptions,
    ) -> Result<ArrayBytesRaw<'a>, CodecError> {
        self.inner.encode(bytes, options)
    }

    fn decode<'a>(
        &self,
        bytes: ArrayBytesRaw<'a>,
        representation: &BytesRepresentation,
        options: &CodecOptions,
    ) -> Result<ArrayBytesRaw<'a>, CodecError> {
        self.unpack(bytes, representation, options)
    }
}
