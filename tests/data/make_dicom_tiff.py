"""Writes the DICOM and TIFF files of this folder with programs that know nothing of lightloom.

Needs numpy, pydicom, SimpleITK, tifffile and imagecodecs. Unless said otherwise value = x + 10 y + 100 z over
5 x 6 x 4 voxels of 0.5 x 0.75 x 2 mm.
"""
import itertools
import os
import shutil

import imagecodecs
import numpy as np
import pydicom
import SimpleITK as sitk
import tifffile
from pydicom.dataset import Dataset, FileMetaDataset
from pydicom.encaps import encapsulate
from pydicom.sequence import Sequence
from pydicom.uid import (
    DeflatedExplicitVRLittleEndian, ExplicitVRBigEndian, ExplicitVRLittleEndian, ImplicitVRLittleEndian,
    JPEG2000Lossless, JPEGBaseline8Bit, JPEGLosslessSV1, RLELossless,
)

z, y, x = np.mgrid[0:4, 0:6, 0:5]
ramp = x + 10 * y + 100 * z
SPACING = (0.5, 0.75, 2.0)


def folder(name):
    shutil.rmtree(name, ignore_errors=True)
    os.makedirs(name)
    return name


def itk_series(name, values, direction=(1, 0, 0, 0, 1, 0, 0, 0, 1), origin=(0.0, 0.0, 0.0)):
    """As SimpleITK writes a series, with names that say nothing of the order."""
    image = sitk.GetImageFromArray(values.astype(np.int16))
    image.SetSpacing(SPACING)
    image.SetDirection(direction)
    image.SetOrigin(origin)
    folder(name)
    writer = sitk.ImageFileWriter()
    writer.KeepOriginalImageUIDOn()
    d = np.array(direction).reshape(3, 3)
    for k in range(values.shape[0]):
        slice_ = image[:, :, k]
        slice_.SetMetaData("0008|0060", "CT")
        slice_.SetMetaData("0008|103e", "Oblique")
        slice_.SetMetaData("0020|000e", "1.2.826.0.1.3680043.2.1125.1")
        slice_.SetMetaData("0008|0018", f"1.2.826.0.1.3680043.2.1125.1.{k}")
        slice_.SetMetaData("0020|0013", str(7 - k))
        slice_.SetMetaData("0020|0032", "\\".join(map(repr, image.TransformIndexToPhysicalPoint((0, 0, k)))))
        slice_.SetMetaData("0020|0037", "\\".join(str(float(v)) for v in (*d[:, 0], *d[:, 1])))
        writer.SetFileName(f"{name}/{(k * 3 + 1) % 4}.dcm")
        writer.Execute(slice_)
    return image


def dataset(k, syntax=ExplicitVRLittleEndian, series=1, **extra):
    """A slice of the ramp, as pydicom has it."""
    ds = Dataset()
    ds.file_meta = FileMetaDataset()
    ds.file_meta.TransferSyntaxUID = syntax
    ds.file_meta.MediaStorageSOPClassUID = ds.SOPClassUID = "1.2.840.10008.5.1.4.1.1.2"
    ds.file_meta.MediaStorageSOPInstanceUID = ds.SOPInstanceUID = f"1.2.3.{series}.{k + 1}"
    ds.SeriesInstanceUID = f"1.2.3.{series}"
    ds.SeriesDescription, ds.Modality, ds.SeriesNumber = f"Series {series}", "CT", series
    ds.InstanceNumber = k + 1
    ds.Rows, ds.Columns, ds.SamplesPerPixel, ds.PhotometricInterpretation = 6, 5, 1, "MONOCHROME2"
    ds.BitsAllocated, ds.BitsStored, ds.HighBit, ds.PixelRepresentation = 16, 16, 15, 0
    ds.PixelSpacing, ds.SliceThickness = [SPACING[1], SPACING[0]], 5.0
    ds.ImageOrientationPatient, ds.ImagePositionPatient = [1, 0, 0, 0, 1, 0], [-10.0, 20.0, 30.0 + 2.0 * k]
    ds.PixelData = ramp[k % 4].astype("<u2").tobytes()
    for name, value in extra.items():
        setattr(ds, name, value)
    if isinstance(ds.get("PixelData"), bytes):
        ds["PixelData"].VR = "OW" if ds.BitsAllocated > 8 else "OB"
    return ds


singles = itertools.count(1)


def save(ds, name):
    if name.count("/") == 1:
        # Else the files of a folder would be slices of one series.
        ds.SeriesInstanceUID = f"1.2.4.{next(singles)}"
    syntax = ds.file_meta.TransferSyntaxUID
    pydicom.dcmwrite(
        name, ds, enforce_file_format=True, implicit_vr=syntax == ImplicitVRLittleEndian,
        little_endian=syntax != ExplicitVRBigEndian,
    )


def series(name, slices=range(4), **extra):
    folder(name)
    for k in slices:
        save(dataset(k, **extra), f"{name}/{k}")


def packed(ds, frames):
    ds.PixelData = encapsulate(frames)
    ds["PixelData"].VR = "OB"
    ds["PixelData"].is_undefined_length = True
    return ds


def dicom():
    folder("dicom")
    c, s = np.cos(0.5), np.sin(0.5)
    oblique = tuple((np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]]) @ np.array([[1, 0, 0], [0, c, -s], [0, s, c]])).ravel())
    image = itk_series("dicom/oblique", ramp - 50, oblique, (-12.5, 7.25, 100.0))
    for index in ((0, 0, 0), (4, 0, 0), (0, 5, 0), (0, 0, 3), (4, 5, 3)):
        print("oblique", index, image.TransformIndexToPhysicalPoint(index))

    series("dicom/rescaled", RescaleSlope=0.5, RescaleIntercept=-1024)
    folder("dicom/pet")
    for k in range(4):
        save(dataset(k, RescaleSlope=float(k + 1), RescaleIntercept=0, Modality="PT"), f"dicom/pet/{k}")
    folder("dicom/two_series")
    for number in (1, 2):
        for k in range(2):
            save(dataset(k, series=number), f"dicom/two_series/{number}_{k}")
    series("dicom/missing", slices=(0, 1, 3))
    series("dicom/duplicate", slices=(0, 1))
    save(dataset(1, InstanceNumber=9), "dicom/duplicate/copy")
    folder("dicom/uneven")
    for k, place in enumerate((0.0, 2.0, 4.5)):
        save(dataset(k, ImagePositionPatient=[0, 0, place]), f"dicom/uneven/{k}")
    folder("dicom/echoes")
    for k in range(2):
        for echo in range(2):
            pixels = (ramp[k] + 1000 * echo).astype("<u2").tobytes()
            save(dataset(k, EchoTime=10.0 * (2 - echo), PixelData=pixels), f"dicom/echoes/{k}{echo}")
    folder("dicom/tilted")
    for k in range(3):
        save(dataset(k, ImagePositionPatient=[0, 0.5 * k, 2.0 * k]), f"dicom/tilted/{k}")
    folder("dicom/localizer")
    for k in range(2):
        save(dataset(k), f"dicom/localizer/{k}")
    save(dataset(2, ImageOrientationPatient=[0, 1, 0, 0, 0, -1]), "dicom/localizer/2")

    folder("dicom/signed12")
    for k in range(2):
        # Four bits that are no part of the number, as overlays once were.
        cells = ((ramp[k] - 100) & 0x0FFF | 0x5000).astype("<u2")
        bits = {"BitsStored": 12, "HighBit": 11, "PixelRepresentation": 1}
        save(dataset(k, PixelData=cells.tobytes(), PhotometricInterpretation="MONOCHROME1", **bits), f"dicom/signed12/{k}")

    save(dataset(1, syntax=ImplicitVRLittleEndian), "dicom/implicit.dcm")
    save(dataset(1, syntax=DeflatedExplicitVRLittleEndian), "dicom/deflated.dcm")
    save(dataset(1, syntax=ExplicitVRBigEndian, PixelData=ramp[1].astype(">u2").tobytes()), "dicom/big_endian.dcm")
    rle = dataset(1)
    rle.compress(RLELossless)
    save(rle, "dicom/rle.dcm")
    # The pixels are not last: padding follows them.
    padded = dataset(1)
    padded.DataSetTrailingPadding = bytes(64)
    save(padded, "dicom/padded.dcm")
    pixels = ramp[1].astype("<u2")
    save(packed(dataset(1, syntax=JPEGLosslessSV1), [imagecodecs.ljpeg_encode(pixels, bitspersample=16)]), "dicom/jpeg_lossless.dcm")
    grey = np.full((6, 5), 77, np.uint8)
    eight = {"BitsAllocated": 8, "BitsStored": 8, "HighBit": 7}
    save(packed(dataset(1, syntax=JPEGBaseline8Bit, **eight), [imagecodecs.jpeg8_encode(grey, level=95)]), "dicom/jpeg_baseline.dcm")
    save(packed(dataset(1, syntax=JPEG2000Lossless), [imagecodecs.jpeg2k_encode(pixels, level=0)]), "dicom/jpeg_2000.dcm")
    rgb = dataset(1, SamplesPerPixel=3, PhotometricInterpretation="RGB", PlanarConfiguration=0, PixelData=bytes(90), **eight)
    save(rgb, "dicom/colours.dcm")
    odd = dataset(0, Rows=3, Columns=3, PixelData=bytes(range(9)) + b"\0", **eight)
    save(odd, "dicom/odd.dcm")
    text = dataset(0)
    del text.Rows, text.Columns, text.PixelData
    save(text, "dicom/no_image.dcm")
    with open("dicom/implicit.dcm", "rb") as file:
        without = file.read()[128:]
    with open(folder("dicom/no_preamble") + "/slice", "wb") as file:
        file.write(without)

    multi_frame("dicom/enhanced.dcm", ExplicitVRLittleEndian)
    multi_frame("dicom/enhanced_rle.dcm", RLELossless)
    many = dataset(0, NumberOfFrames=4, SpacingBetweenSlices=2.0, PixelData=ramp.astype("<u2").tobytes())
    save(many, "dicom/frames.dcm")


def multi_frame(name, syntax):
    """An enhanced CT: frames in any order, each with its position and its own scaling."""
    ds = dataset(0, NumberOfFrames=4)
    ds.file_meta.MediaStorageSOPClassUID = ds.SOPClassUID = "1.2.840.10008.5.1.4.1.1.2.1"
    for tag in ("ImagePositionPatient", "ImageOrientationPatient", "PixelSpacing", "SliceThickness"):
        delattr(ds, tag)
    shared, measures, plane = Dataset(), Dataset(), Dataset()
    measures.PixelSpacing, measures.SliceThickness = [SPACING[1], SPACING[0]], 5.0
    plane.ImageOrientationPatient = [1, 0, 0, 0, 1, 0]
    shared.PixelMeasuresSequence, shared.PlaneOrientationSequence = Sequence([measures]), Sequence([plane])
    ds.SharedFunctionalGroupsSequence = Sequence([shared])
    order, frames = (2, 0, 3, 1), []
    for k in order:
        frame, position, transform, content = Dataset(), Dataset(), Dataset(), Dataset()
        position.ImagePositionPatient = [1.0, 2.0, 3.0 + 2.0 * k]
        transform.RescaleSlope, transform.RescaleIntercept, transform.RescaleType = 2.0, 5.0, "US"
        content.FrameAcquisitionNumber = 1
        frame.PlanePositionSequence, frame.FrameContentSequence = Sequence([position]), Sequence([content])
        frame.PixelValueTransformationSequence = Sequence([transform])
        frames.append(frame)
    ds.PerFrameFunctionalGroupsSequence = Sequence(frames)
    ds.PixelData = ramp[list(order)].astype("<u2").tobytes()
    if syntax == RLELossless:
        ds.compress(RLELossless)
    save(ds, name)


def tiff():
    folder("tiff")
    small = (ramp // 2).astype(np.uint8)
    plain = {"photometric": "minisblack", "metadata": None}
    for type_ in ("uint8", "int8", "uint16", "int16", "uint32", "int32", "float32", "float64"):
        values = small if type_.endswith("int8") else ramp
        values = (values % 120 if type_ == "int8" else values).astype(type_)
        for packing in (None, "lzw", "zlib", "packbits", "zstd"):
            name = f"tiff/{type_}_{packing or 'plain'}.tif"
            tifffile.imwrite(name, values, compression=packing, **plain)
    u2, f4 = ramp.astype(np.uint16), ramp.astype(np.float32)
    tifffile.imwrite("tiff/big_endian.tif", u2, byteorder=">", **plain)
    tifffile.imwrite("tiff/big_endian_lzw.tif", f4, byteorder=">", compression="lzw", **plain)
    tifffile.imwrite("tiff/big_tiff.tif", u2, bigtiff=True, **plain)
    tifffile.imwrite("tiff/big_tiff_big_endian.tif", u2, bigtiff=True, byteorder=">", **plain)
    tifffile.imwrite("tiff/strips.tif", u2, rowsperstrip=2, compression="zlib", **plain)
    tifffile.imwrite("tiff/predictor.tif", u2, compression="lzw", predictor=True, **plain)
    tifffile.imwrite("tiff/predictor_float.tif", f4, compression="zlib", predictor=True, **plain)
    wide = (np.mgrid[0:2, 0:20, 0:37] * np.array([1000, 100, 1]).reshape(3, 1, 1, 1)).sum(0)
    tifffile.imwrite("tiff/tiled.tif", wide.astype(np.uint16), tile=(16, 16), compression="zlib", **plain)
    tifffile.imwrite("tiff/tiled_float.tif", wide.astype(np.float32), tile=(16, 16), compression="lzw", predictor=True, **plain)
    for type_ in ("uint8", "uint16", "int16", "float32"):
        values = (small if type_ == "uint8" else ramp).astype(type_)
        tifffile.imwrite(f"tiff/white_{type_}.tif", values, photometric="miniswhite", metadata=None)
    colours = np.arange(768).reshape(3, 256).astype(np.uint16)
    tifffile.imwrite("tiff/palette.tif", small, photometric="palette", colormap=colours, metadata=None)
    rgb = np.stack([ramp, ramp + 1000, ramp + 2000], -1).astype(np.uint16)
    tifffile.imwrite("tiff/rgb.tif", rgb, photometric="rgb", metadata=None)
    planes = np.moveaxis(rgb, -1, 1)
    tifffile.imwrite("tiff/rgb_planes.tif", planes, photometric="rgb", planarconfig="separate", metadata=None)
    with tifffile.TiffWriter("tiff/thumbnail.tif") as file:
        for k in range(4):
            file.write(u2[k], **plain)
            file.write(u2[k, ::2, ::2], subfiletype=1, **plain)
    with tifffile.TiffWriter("tiff/uneven.tif") as file:
        file.write(u2[0], **plain)
        file.write(u2[0, :3], **plain)
    tifffile.imwrite("tiff/half.tif", ramp.astype(np.float16), **plain)
    tifffile.imwrite("tiff/resolution.tif", u2, resolution=(20000, 10000), resolutionunit="CENTIMETER", **plain)

    # T, Z, C, Y, X: value = ramp + 1000 c + 10000 t.
    c, t = np.arange(2).reshape(1, 1, 2, 1, 1), np.arange(3).reshape(3, 1, 1, 1, 1)
    hyper = (ramp[None, :, None] + 1000 * c + 10000 * t).astype(np.uint16)
    axes = {"axes": "TZCYX", "spacing": 2.0, "unit": "mm"}
    tifffile.imwrite("tiff/imagej.tif", hyper, imagej=True, resolution=(2.0, 1 / 0.75), metadata=axes)
    one = {"axes": "ZYX", "spacing": 2000.0, "unit": "um"}
    tifffile.imwrite("tiff/imagej_stack.tif", u2, imagej=True, resolution=(0.002, 1 / 750), metadata=one)
    # As ImageJ writes beyond 4 GiB: one page is listed, and the others follow it.
    text = "ImageJ=1.54f\nimages=4\nslices=4\nspacing=2.0\nunit=mm\n"
    for order in "<>":
        with tifffile.TiffWriter(f"tiff/imagej_one_page{'_big_endian' if order == '>' else ''}.tif", byteorder=order) as file:
            file.write(u2[0], description=text, resolution=(2.0, 1 / 0.75), **plain)
        with open(file.filehandle.path, "ab") as stream:
            stream.write(u2[1:].astype(order + "u2").tobytes())
    sizes = {"PhysicalSizeX": 0.5, "PhysicalSizeXUnit": "mm", "PhysicalSizeY": 0.75, "PhysicalSizeYUnit": "mm"}
    sizes |= {"PhysicalSizeZ": 2000.0, "PhysicalSizeZUnit": "µm"}
    tifffile.imwrite("tiff/czt.ome.tif", hyper, photometric="minisblack", metadata={"axes": "TZCYX", **sizes})
    zct = np.ascontiguousarray(np.swapaxes(hyper, 1, 2))
    tifffile.imwrite("tiff/zct.ome.tif", zct, photometric="minisblack", metadata={"axes": "TCZYX", **sizes})

    folder("tiff/slices")
    for k, name in enumerate(("z1", "z2", "z10", "z11")):
        tifffile.imwrite(f"tiff/slices/{name}.tif", u2[k], **plain)
    folder("tiff/mixed")
    tifffile.imwrite("tiff/mixed/a.tif", u2[0], **plain)
    tifffile.imwrite("tiff/mixed/b.tiff", u2[0, :3], **plain)


dicom()
tiff()
