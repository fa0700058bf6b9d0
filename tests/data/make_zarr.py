"""Writes the Zarr folders in zarr/ with zarr-python (3.1), which knows nothing of lightloom.

Value = x + 10 y + 100 z over 5 x 6 x 4 voxels of 0.5 x 0.75 x 2 mm, in chunks of 5 x 6 x 3 where nothing else is said;
channel c and time t add 1000 c and 2000 t. Run it in this folder.
"""
import json
import shutil
from pathlib import Path

import numcodecs
import numpy as np
import zarr
from zarr.codecs import BloscCodec, BytesCodec, Crc32cCodec, GzipCodec, TransposeCodec, ZstdCodec

root = Path("zarr")
shutil.rmtree(root, ignore_errors=True)
root.mkdir()
z, y, x = np.mgrid[0:4, 0:6, 0:5]
ramp = x + 10 * y + 100 * z
MM = [2.0, 0.75, 0.5]
CHUNKS = (3, 6, 5)
RAGGED = (3, 4, 2)


def array(name, values, version=3, chunks=CHUNKS, **options):
    made = zarr.create_array(root / name, shape=values.shape, dtype=values.dtype, chunks=chunks,
                             zarr_format=version, **options)
    made[:] = values
    return made


def scale(numbers):
    return {"type": "scale", "scale": numbers}


def axes(names, unit="millimeter"):
    kinds = {"t": "time", "c": "channel"}
    units = {"t": {"unit": "second"}, "c": {}}
    return [{"name": n, "type": kinds.get(n, "space"), **units.get(n, {"unit": unit})} for n in names]


def image(name, version, names, levels, unit="millimeter", whole=None, **more):
    """A group whose datasets are (path, transformations)."""
    group = zarr.open_group(root / name, mode="a", zarr_format=version)
    datasets = [{"path": path, "coordinateTransformations": steps} for path, steps in levels]
    multiscale = {"name": name, "axes": axes(names, unit), "datasets": datasets}
    if whole:
        multiscale["coordinateTransformations"] = whole
    if version == 2:
        group.attrs.update({"multiscales": [{**multiscale, "version": "0.4"}], **more})
    else:
        group.attrs["ome"] = {"version": "0.5", "multiscales": [multiscale], **more}


# Bare arrays: every element type, both byte orders, every codec.
for kind in ["u1", "i1", "u2", "i2", "u4", "i4", "u8", "i8", "f4", "f8", "f2"]:
    values = (x + 10 * y - 20 * z if kind == "i1" else x + 10 * y + 40 * z if kind == "u1" else ramp).astype(kind)
    array(f"type_{kind}.zarr", values, chunks=(4, 6, 5))
for kind in ["u2", "f8"]:
    array(f"big_v2_{kind}.zarr", ramp.astype(">" + kind), 2, chunks=(4, 6, 5))
array("big_v3.zarr", ramp.astype("i4"), serializer=BytesCodec(endian="big"), compressors=None)
array("order_f_v2.zarr", ramp.astype("i2"), 2, RAGGED, order="F", compressors=numcodecs.Zlib())
array("lz4_v2.zarr", ramp.astype("i2"), 2, RAGGED, compressors=numcodecs.Blosc("lz4", shuffle=numcodecs.Blosc.SHUFFLE))
array("bitshuffle_v3.zarr", ramp.astype("u2"), compressors=BloscCodec(cname="zstd", shuffle="bitshuffle"))
array("gzip_v2.zarr", ramp.astype("i2"), 2, compressors=numcodecs.GZip())
array("gzip_crc_v3.zarr", ramp.astype("i2"), chunks=RAGGED, compressors=[GzipCodec(), Crc32cCodec()])
array("transposed_v3.zarr", ramp.astype("i2"), filters=[TransposeCodec(order=(2, 0, 1))], compressors=[ZstdCodec()])
array("lzma_v2.zarr", ramp.astype("i2"), 2, chunks=(4, 6, 5), compressors=numcodecs.LZMA())
array("sharded.zarr", ramp.astype("i2"), chunks=(2, 2, 2), shards=(4, 4, 4))
array("plane.zarr", ramp[0].astype("u1"), chunks=(4, 4))
part = zarr.create_array(root / "missing.zarr", shape=(4, 6, 5), dtype="i2", chunks=(2, 6, 5), fill_value=-7)
part[2:] = ramp[2:]

# OME-Zarr 0.4: time, channels, two levels, a translation, and transformations of the whole image.
five = np.stack([np.stack([ramp + 1000 * c + 2000 * t for c in range(3)]) for t in range(2)]).astype("i2")
array("image_04.zarr/0", five, 2, chunks=(1, 2, 2, 6, 5), compressors=numcodecs.Blosc("zstd"))
array("image_04.zarr/1", five[..., ::2, ::2, ::2], 2, chunks=(1, 1, 2, 3, 3))
whole = [scale([1, 1, 0.5, 0.25, 0.25]), {"type": "translation", "translation": [0, 0, 0, 0, 3.0]}]
levels = [("0", [scale([0.1, 1, 4000, 3000, 2000])]),
          ("1", [scale([0.1, 1, 8000, 6000, 4000]), {"type": "translation", "translation": [0, 0, 2000, 1500, 1000]}])]
channels = {"channels": [{"label": "bone"}, {"label": "skin"}, {"label": "air"}]}
image("image_04.zarr", 2, "tczyx", levels, "micrometer", whole, omero=channels)

# OME-Zarr 0.5: sharded, without time; and one with x before y before z.
array("image_05.zarr/a/full", ramp[None].astype("u2"), chunks=(1, 2, 2, 2), shards=(1, 4, 6, 4))
array("image_05.zarr/a/half", ramp[None, ::2, ::2, ::2].astype("u2"), chunks=(1, 2, 2, 2))
image("image_05.zarr", 3, "czyx", [("a/full", [scale([1, *MM])]), ("a/half", [scale([1, 4.0, 1.5, 1.0])])])
array("xyz_05.zarr/0", np.ascontiguousarray(ramp.transpose(2, 1, 0)).astype("u2"), chunks=(2, 4, 3))
image("xyz_05.zarr", 3, "xyz", [("0", [scale(MM[::-1])])])

# As bioformats2raw lays them out: a folder of images, here of two and of one.
for name, count in [("series.zarr", 2), ("one_series.zarr", 1)]:
    zarr.open_group(root / name, mode="a", zarr_format=2).attrs["bioformats2raw.layout"] = 3
    for number in range(count):
        array(f"{name}/{number}/0", (ramp + number).astype("i2"), 2, chunks=(4, 6, 5))
        image(f"{name}/{number}", 2, "zyx", [("0", [scale(MM)])])

print(sum(f.stat().st_size for f in root.rglob("*") if f.is_file()), sum(f.is_file() for f in root.rglob("*")))
