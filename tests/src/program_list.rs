//! Whether `tests/run` runs every test program there is.

use serde_json::Value;
use std::path::Path;
use std::process::Command;

/// The integration tests of the workspace, by name.
fn test_programs() -> Vec<String> {
    let output = Command::new(env!("CARGO"))
        .args(["metadata", "--format-version", "1", "--no-deps", "--offline"])
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .output()
        .unwrap();
    let metadata: Value = serde_json::from_slice(&output.stdout).unwrap();
    let list = |value: &Value| value.as_array().unwrap().clone();
    let targets = list(&metadata["packages"]).into_iter().flat_map(|package| list(&package["targets"]));
    let tests = targets.filter(|target| list(&target["kind"]).contains(&"test".into()));
    tests.map(|target| target["name"].as_str().unwrap().to_owned()).collect()
}

/// The programs that a script does not run in full: by their names at the end of a line, or before options.
fn left_out<'a>(script: &str, programs: &'a [String]) -> Vec<&'a str> {
    let runs = |name: &str| {
        let call = format!("--test {name}");
        script.lines().any(|line| line.ends_with(&call) || line.contains(&format!("{call} -- --")))
    };
    programs.iter().map(String::as_str).filter(|name| !runs(name)).collect()
}

#[test]
fn every_test_program_is_run() {
    let script = std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("run")).unwrap();
    let programs = test_programs();
    assert!(programs.contains(&"house".to_owned()), "{programs:?}");
    assert_eq!(left_out(&script, &programs), Vec::<&str>::new());
    // The canaries: a program that is not named, and one of which a part is run.
    let spoiled =
        script.replace("--test house", "--test home").replace("--test live\n", "--test live -- a::\n");
    let mut found = left_out(&spoiled, &programs);
    found.sort_unstable();
    assert_eq!(found, ["house", "live"]);
}
