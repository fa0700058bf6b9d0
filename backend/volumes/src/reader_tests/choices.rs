//! Choices that a file cannot offer, and things that are no files.

use super::damage::complaint;
use super::*;

#[test]
fn what_cannot_be_chosen_is_not_passed_over() {
    let refused = |name: &str, selection: &Selection, part: &str| {
        let said = refusal(name, selection);
        assert!(said.contains(part) && said.contains(name), "{said}");
    };
    let level = Selection { level: Some(3), ..Default::default() };
    let series = Selection { series: Some("2".into()), ..Default::default() };
    let channel = chosen(Some(1), None);
    let time = chosen(None, Some(1));
    for name in ["ushort.nii", "short.nrrd", "short.mhd", "tiff/tiled.tif", "tiff/slices", "dicom/oblique"] {
        refused(name, &level, "one level, number 0, and not a number 3");
    }
    for name in ["ushort.nii", "short.nrrd", "short.mhd", "tiff/tiled.tif", "zarr/type_u2.zarr"] {
        refused(name, &series, "no series \"2\"");
    }
    refused("dicom/oblique", &channel, "one channel");
    refused("dicom/odd.dcm", &time, "time 1 is asked for");
    for (selection, part) in
        [(level, "level"), (series, "series"), (channel, "channel"), (time, "point in time")]
    {
        refused("ushort_big.raw", &Selection { raw: Some(raw_layout()), ..selection }, part);
    }
    let first = Selection { level: Some(0), series: Some("1".into()), ..chosen(Some(0), Some(0)) };
    for name in ["ushort.nii", "short.nrrd", "short.mhd", "zarr/type_u2.zarr", "dicom/odd.dcm"] {
        open(&data(name), &first).unwrap();
    }
}

#[cfg(unix)]
#[test]
fn pipes_are_not_waited_for() {
    let folder = tempfile::tempdir().unwrap();
    let pipe = |name: &str| {
        let path = folder.path().join(name);
        assert!(std::process::Command::new("mkfifo").arg(&path).status().unwrap().success());
        path
    };
    for name in ["a.nii", "a.nii.gz", "a.nrrd", "a.mha", "a.tif", "a.dcm", "a.raw", "unknown"] {
        let said = open(&pipe(name), &Selection::default()).unwrap_err().to_string();
        assert!(said.contains(name) && said.contains("it is a pipe or a device"), "{said}");
    }
    let said = open(&folder.path().join("a.raw"), &of_raw(raw_layout())).unwrap_err().to_string();
    assert!(said.contains("it is a pipe or a device"), "{said}");
    // A file of voxels that a header names, a header beside its voxels, a chunk.
    pipe("voxels");
    let header = folder.path().join("b.nhdr");
    let lines = "NRRD0004\ntype: uchar\ndimension: 3\nsizes: 1 1 2\nencoding: raw\ndata file: voxels\n";
    std::fs::write(&header, lines).unwrap();
    assert!(open(&header, &Selection::default()).unwrap_err().to_string().contains("it is a pipe"));
    std::fs::copy(data("pair.img"), folder.path().join("c.img")).unwrap();
    pipe("c.hdr");
    let said = open(&folder.path().join("c.img"), &Selection::default()).unwrap_err().to_string();
    assert!(said.contains("c.hdr") && said.contains("it is a pipe"), "{said}");
    let zarr = folder.path().join("d.zarr");
    std::fs::create_dir_all(zarr.join("c/0/0")).unwrap();
    std::fs::copy(data("zarr/type_u2.zarr/zarr.json"), zarr.join("zarr.json")).unwrap();
    pipe("d.zarr/c/0/0/0");
    let said = open(&zarr, &Selection::default()).and_then(|mut reader| values(reader.as_mut())).unwrap_err();
    assert!(said.to_string().contains("it is a pipe"), "{said}");
}

#[test]
fn voxels_as_thin_as_nothing_are_refused() {
    let nrrd = |edges: &str| {
        let text = format!(
            "NRRD0004\ntype: uchar\ndimension: 3\nsizes: 1 1 2\nencoding: raw\nspacings: {edges}\n\nAB"
        );
        complaint("thin.nrrd", text.as_bytes())
    };
    for edges in ["1 1 1e-37", "1e-30 1 1", "1e-4 1e4 1"] {
        assert!(nrrd(edges).contains("none a million times as long as another"), "{edges}");
    }
    let thin = Selection { spacing_mm: Some(DVec3::new(1.0, 1.0, 1e-37)), ..Default::default() };
    for name in ["ushort.nii", "tiff/tiled.tif", "zarr/type_u2.zarr", "dicom/odd.dcm", "dicom/oblique"] {
        assert!(refusal(name, &thin).contains("a million times"), "{name}: {}", refusal(name, &thin));
    }
}
