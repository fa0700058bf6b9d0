//! From a store to files for other programs and back, as a user goes.

use lightloom_tests::program::{lightloom, run};
use serde_json::{Value, json};
use std::fs;
use std::path::Path;

fn json_of(arguments: &[&str]) -> Value {
    let ran = run(&mut lightloom(&[arguments, &["--json"]].concat())).succeeded();
    assert_eq!(ran.stderr, "");
    serde_json::from_str(&ran.stdout).expect("--json prints JSON and nothing else")
}

/// A store of a volume of the tests' data, and a folder for it.
fn store_of(name: &str) -> (tempfile::TempDir, String) {
    let folder = tempfile::tempdir().unwrap();
    let input = Path::new(env!("CARGO_MANIFEST_DIR")).join("data").join(name);
    let store = folder.path().join("a.lloom").to_string_lossy().into_owned();
    let said =
        json_of(&["import", &input.to_string_lossy(), "-o", &store, "--bits", "16", "--spacing-mm", "1,1,1"]);
    assert_eq!(said["value_range"], json!([0.0, 354.0]), "{said}");
    (folder, store)
}

#[test]
fn zarr_goes_in_and_comes_out() {
    let (folder, store) = store_of("zarr/sharded.zarr");
    let at = |name: &str| folder.path().join(name).to_string_lossy().into_owned();
    for name in ["b.nrrd", "b.zarr"] {
        let said = json_of(&["export", &store, &at(name), "--type", "int16"]);
        assert_eq!((&said["levels"], &said["element"]), (&json!([[5, 6, 4]]), &json!("int16")), "{said}");
        let again = at(&format!("{name}.lloom"));
        let said = json_of(&["import", &at(name), "-o", &again, "--bits", "16"]);
        assert_eq!(
            (&said["dims"], &said["value_range"]),
            (&json!([5, 6, 4]), &json!([0.0, 354.0])),
            "{said}"
        );
    }
}

#[test]
fn what_cannot_be_exported_is_refused() {
    let (folder, store) = store_of("short.nrrd");
    let at = |name: &str| folder.path().join(name).to_string_lossy().into_owned();
    let refused = |arguments: &[&str], parts: &[&str]| {
        run(&mut lightloom(&[&["export", &store], arguments].concat())).refused(parts);
    };
    refused(&[&at("b.nrrd"), "--level", "3"], &["no level 3", "5 × 6 × 4"]);
    refused(&[&at("b.nrrd"), "--low", "5,0,0"], &["5 × 6 × 4 voxels"]);
    refused(&[&at("b.zarr"), "--type", "int8"], &["does not fit into int8"]);
    refused(&[&at("b.txt")], &["b.txt", ".nrrd or .zarr"]);
    let quiet = run(&mut lightloom(&["export", &store, &at("b.nrrd"), "--quiet"])).succeeded();
    assert_eq!((quiet.stdout.as_str(), quiet.stderr.as_str()), ("", ""));
    refused(&[&at("b.nrrd")], &["b.nrrd", "is there already"]);
    // The store and what was exported in between; no working file.
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 2);
}
