"""Writes the small volumes of the NRRD, NIfTI and MetaImage readers' tests, and prints where their voxels lie.

Needs numpy, SimpleITK, nibabel and pynrrd. Value = x + 10 y + 100 z over 5 x 6 x 4 voxels of 0.5 x 0.75 x 2 mm, of
8-bit types x + 10 y + 40 z (unsigned) and x + 10 y - 20 z (signed). Channel c adds 1000 c (8 bits: c), time t adds
5000 t. Headers that none of the programs writes are written here and read back by SimpleITK.
"""
import nibabel
import nrrd
import numpy as np
import SimpleITK as sitk

z, y, x = np.mgrid[0:4, 0:6, 0:5]
ramp = x + 10 * y + 100 * z
by_type = {np.uint8: x + 10 * y + 40 * z, np.int8: x + 10 * y - 20 * z}
SPACING = (0.5, 0.75, 2.0)
ORIGIN = (11.0, -22.0, 33.0)
# Three turns about three axes: nothing is parallel to anything.
turn = sitk.Euler3DTransform((0, 0, 0), 0.3, -0.5, 0.7).GetMatrix()
PROBES = [(0, 0, 0), (4, 5, 3)]


def values(type_):
    return by_type.get(type_, ramp).astype(type_)


def itk(name, array, packed=True, direction=None, is_vector=False):
    image = sitk.GetImageFromArray(array, isVector=is_vector)
    image.SetSpacing(SPACING)
    if direction:
        image.SetDirection(direction)
        image.SetOrigin(ORIGIN)
    sitk.WriteImage(image, name, packed)


def text(name, lines, tail=b""):
    with open(name, "wb") as file:
        file.write(("\n".join(lines) + "\n").encode() + tail)


def probe(name):
    image = sitk.ReadImage(name)
    print(name, [image.TransformIndexToPhysicalPoint(probe) for probe in PROBES])


def is_ramp(name):
    assert np.array_equal(sitk.GetArrayFromImage(sitk.ReadImage(name)), ramp), name


# Every type, of each format.
for type_ in [np.uint8, np.int32, np.uint32, np.int64, np.uint64]:
    itk(f"all_{np.dtype(type_).name}.nrrd", values(type_))
for type_ in [np.uint8, np.int8, np.int32, np.uint32, np.int64, np.uint64, np.float32]:
    itk(f"all_{np.dtype(type_).name}.mha", values(type_))
for type_ in [np.uint8, np.int8, np.int32, np.int64, np.uint64, np.float64]:
    image = nibabel.Nifti1Image(values(type_).transpose(2, 1, 0), np.diag([*SPACING, 1.0]), dtype=type_)
    nibabel.save(image, f"all_{np.dtype(type_).name}.nii.gz")
nrrd_ramp = ramp.transpose(2, 1, 0)
header = {"spacings": SPACING, "encoding": "gzip", "endian": "big"}
nrrd.write("uint32_big.nrrd", nrrd_ramp.astype(">u4"), header, index_order="F")
nrrd.write("float64_big.nrrd", nrrd_ramp.astype(">f8"), header, index_order="F")

# Voxels as text.
header = {"spacings": SPACING, "encoding": "ascii"}
nrrd.write("int32_ascii.nrrd", nrrd_ramp.astype(np.int32), header, index_order="F")
nrrd.write("float32_ascii.nhdr", nrrd_ramp.astype(np.float32), header, index_order="F", detached_header=True)
meta = ["ObjectType = Image", "NDims = 3", "DimSize = 5 6 4", "ElementSpacing = 0.5 0.75 2"]
digits = " ".join(str(value) for value in ramp.flat).encode() + b"\n"
text("text.mha", [*meta, "BinaryData = False", "ElementType = MET_SHORT", "ElementDataFile = LOCAL"], digits)
is_ramp("text.mha")

# A file for each slice.
for index, slice_ in enumerate(ramp.astype("<u2")):
    slice_.tofile(f"slice_{index + 1:02}.raw")
names = [f"slice_{index:02}.raw" for index in range(1, 5)]
about = ["NRRD0004", "type: ushort", "dimension: 3", "sizes: 5 6 4", "spacings: 0.5 0.75 2", "encoding: raw"]
text("list.nhdr", [*about, "endian: little", "scan:=a key: and its value", "data file: LIST", *names])
text("numbered.nhdr", [*about, "endian: little", "data file: slice_%02d.raw 1 4 1"])
text("list.mhd", [*meta, "ElementType = MET_USHORT", "ElementDataFile = LIST", *names])
text("numbered.mhd", [*meta, "ElementType = MET_USHORT", "ElementDataFile = slice_%02d.raw 1 4 1"])
for name in ["list.nhdr", "numbered.nhdr", "list.mhd", "numbered.mhd"]:
    is_ramp(name)

# Other byte orders, header sizes and names of types (ushort_big.raw is of make.py; MET_LONG has 4 bytes to ITK too).
big = [*meta, "ElementType = MET_USHORT", "ElementByteOrderMSB = True"]
text("big.mhd", [*big, "HeaderSize = -1", "ElementDataFile = ushort_big.raw"])
text("long.mha", [*meta, "ElementType = MET_LONG", "ElementDataFile = LOCAL"], ramp.astype("<i4").tobytes())
for name in ["big.mhd", "long.mha"]:
    is_ramp(name)

# Channels, and points in time.
small = np.stack([values(np.uint8) + channel for channel in range(3)], axis=-1).astype(np.uint8)
itk("channels.nrrd", small, is_vector=True)
itk("channels.mha", small, packed=False, is_vector=True)
image = sitk.JoinSeries([sitk.GetImageFromArray((ramp + 5000 * time).astype(np.int16)) for time in range(3)])
image.SetSpacing((*SPACING, 1.0))
for name in ["times.nrrd", "times.mha"]:
    sitk.WriteImage(image, name, True)
five = np.stack([np.stack([nrrd_ramp + 1000 * c + 5000 * t for t in range(3)], -1) for c in range(2)], -1)
nibabel.save(nibabel.Nifti1Image(five[..., 0].astype(np.int16), np.diag([*SPACING, 1.0])), "times.nii.gz")
nibabel.save(nibabel.Nifti1Image(five.astype(np.int16), np.diag([*SPACING, 1.0])), "times_channels.nii.gz")
header = {"kinds": ["domain"] * 3 + ["list"], "encoding": "gzip", "space": "right-anterior-superior"}
header["space directions"] = np.vstack([np.diag(SPACING), [np.nan] * 3])
nrrd.write("list_last.nrrd", five[..., 0, :].astype(np.int16), header, index_order="F")

# NIfTI-2, and pairs of header and voxels.
plain = (nrrd_ramp.astype(np.int16), np.diag([*SPACING, 1.0]))
nibabel.save(nibabel.Nifti2Image(*plain), "nifti2.nii.gz")
header = nibabel.Nifti2Header(endianness=">")
header.set_data_dtype(">i2")
nibabel.save(nibabel.Nifti2Image(*plain, header), "nifti2_big.nii")
nibabel.save(nibabel.Nifti1Pair(*plain), "pair.img")
nibabel.save(nibabel.Nifti2Pair(*plain), "pair2.img.gz")

# Oblique volumes.
for name in ["oblique.nrrd", "oblique.mha"]:
    itk(name, values(np.int16), direction=turn)
    probe(name)
header = {"space": "left-anterior-superior", "encoding": "gzip", "space origin": ORIGIN, "endian": "little"}
header["space directions"] = (np.array(turn).reshape(3, 3) * SPACING).T
nrrd.write("oblique_las.nrrd", nrrd_ramp.astype("<i2"), header, index_order="F")
probe("oblique_las.nrrd")
affine = np.eye(4)
affine[:3, :3] = np.array(turn).reshape(3, 3) * SPACING * (1, 1, -1)
affine[:3, 3] = ORIGIN
for name, sform, qform in [("sform.nii.gz", 1, 0), ("qform.nii.gz", 0, 1), ("no_form.nii.gz", 0, 0)]:
    image = nibabel.Nifti1Image(nrrd_ramp.astype(np.int16), affine)
    image.header.set_xyzt_units("mm")
    image.set_qform(affine, qform)
    image.set_sform(affine, sform)
    nibabel.save(image, name)
    print(name, "(RAS+)", [(nibabel.load(name).affine @ (*probe, 1))[:3].tolist() for probe in PROBES])
    probe(name)
