//! The MCAP library for Python, by the format's own makers, reads a tape, and finds each message to be what its schema says.
//!
//! It comes from PyPI into a virtual environment among the test's own files. If it cannot, that is announced, and is a failure with
//! LIGHTLOOM_REQUIRE_PEERS=1.

use std::path::Path;
use std::process::{Command, Stdio};

const PACKAGES: [&str; 4] = ["mcap==1.6.0", "lz4==4.4.5", "zstandard==0.25.0", "jsonschema==4.25.1"];
const TAPE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/data/format-1.mcap");

/// Counts messages by topic, checked against their schemas, and prints what is attached.
const READER: &str = "
import json, sys, jsonschema
from collections import Counter
from mcap.reader import make_reader
with open(sys.argv[1], 'rb') as file:
    reader = make_reader(file, validate_crcs=True)
    count = Counter()
    for schema, channel, message in reader.iter_messages():
        assert schema.encoding == 'jsonschema' and channel.message_encoding == 'json'
        jsonschema.validate(json.loads(message.data), json.loads(schema.data))
        count[channel.topic] += 1
    print(json.dumps({'topics': count, 'attached': [a.name for a in reader.iter_attachments()]}, sort_keys=True))
";

fn python() -> Option<std::path::PathBuf> {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("mcap-library");
    let (python, whole) = (folder.join("bin/python"), folder.join(PACKAGES.join(" ")));
    let run =
        |command: &mut Command| command.stdout(Stdio::null()).status().is_ok_and(|status| status.success());
    let has_all = whole.exists()
        || run(Command::new("python3").args(["-m", "venv"]).arg(&folder))
            && run(Command::new(&python).args(["-m", "pip", "install", "--quiet"]).args(PACKAGES))
            && std::fs::write(&whole, "").is_ok();
    if !has_all {
        let is_required = std::env::var("LIGHTLOOM_REQUIRE_PEERS").is_ok_and(|value| value == "1");
        assert!(!is_required, "python3 cannot make a virtual environment with {}", PACKAGES.join(", "));
        println!("SKIPPED: python3 cannot make a virtual environment with {}", PACKAGES.join(", "));
    }
    has_all.then_some(python)
}

#[test]
fn the_library_for_python_reads_a_tape() {
    let Some(python) = python() else { return };
    let output = Command::new(python).args(["-c", READER, TAPE]).output().expect("python starts");
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.success(), "{said}");
    let info = tape::info(Path::new(TAPE)).expect("it is a tape");
    let found: serde_json::Value = serde_json::from_slice(&output.stdout).expect("JSON");
    assert_eq!(found["topics"]["/frames"], info.frames, "{found}");
    let events: u64 = info.events.values().sum();
    let heard = found["topics"]
        .as_object()
        .expect("topics")
        .iter()
        .filter(|(topic, _)| topic.starts_with("/inputs/"));
    assert_eq!(heard.filter_map(|(_, count)| count.as_u64()).sum::<u64>(), events, "{found}");
}
