"""Writes the small volumes of this folder with programs that know nothing of lightloom.

Needs numpy, SimpleITK, nibabel and pynrrd. Value = x + 10 y + 100 z over 5 x 6 x 4 voxels of 0.5 x 0.75 x 2 mm,
except char.nrrd (x + 10 y - 20 z) and non_finite.nrrd (NaN at the first voxel and two infinities).
"""
import struct

import nibabel
import nrrd
import numpy as np
import SimpleITK as sitk

z, y, x = np.mgrid[0:4, 0:6, 0:5]
ramp = x + 10 * y + 100 * z
ramp_xyz = ramp.transpose(2, 1, 0)


def itk(name, type_, values=ramp, packed=False):
    image = sitk.GetImageFromArray(values.astype(type_))
    image.SetSpacing((0.5, 0.75, 2.0))
    sitk.WriteImage(image, name, packed)


def nifti(name, type_, unit="mm", size=(0.5, 0.75, 2.0), order="<"):
    header = nibabel.Nifti1Header(endianness=order)
    header.set_data_dtype(np.dtype(type_).newbyteorder(order))
    image = nibabel.Nifti1Image(ramp_xyz.astype(type_), np.diag([*size, 1.0]), header)
    image.header.set_xyzt_units(unit)
    nibabel.save(image, name)


itk("short.nrrd", np.int16)
itk("ushort_gzip.nrrd", np.uint16, packed=True)
itk("float.nhdr", np.float32)
itk("char.nrrd", np.int8, x + 10 * y - 20 * z)
itk("short.mhd", np.int16)
itk("ushort_zlib.mha", np.uint16, packed=True)
itk("double.mha", np.float64)
itk("uint_sitk.nii.gz", np.uint32)
nifti("ushort.nii", np.uint16)
nifti("short_big.nii.gz", np.int16, order=">")
nifti("float_metres.nii", np.float32, "meter", (0.0005, 0.00075, 0.002))

directions = {"endian": "big", "encoding": "raw", "space": "left-posterior-superior", "space units": ["um"] * 3}
directions["space directions"] = np.diag([500.0, 750.0, 2000.0])
nrrd.write("big_directions.nrrd", ramp_xyz.astype(">i2"), directions, index_order="F")
spacings = {"spacings": [0.5, 0.75, 2.0], "encoding": "gzip", "kinds": ["domain"] * 3}
nrrd.write("spacings_gzip.nhdr", ramp_xyz.astype("<f8"), spacings, index_order="F", detached_header=True)

# nibabel chooses slope and intercept itself, so stored values are written and the two numbers set in the bytes.
stored = nibabel.Nifti1Image(((ramp_xyz - 7) * 2).astype(np.int16), np.diag([500.0, 750.0, 2000.0, 1.0]))
stored.header.set_xyzt_units("micron")
nibabel.save(stored, "scaled.nii")
with open("scaled.nii", "r+b") as file:
    file.seek(112)
    file.write(struct.pack("<2f", 0.5, 7.0))

ramp.astype(">u2").tofile("ushort_big.raw")
holes = ramp.astype("<f4")
holes[0, 0, 0], holes[1, 2, 3], holes[3, 5, 4] = np.nan, np.inf, -np.inf
sitk.WriteImage(sitk.GetImageFromArray(holes), "non_finite.nrrd", False)
