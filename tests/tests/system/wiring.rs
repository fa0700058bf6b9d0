//! A display file's wiring is what runs: who draws which projectors, with which adapter, and how the report says so.

use lightloom_tests::program::{
    LIMIT, Ran, SMALL_DISPLAY, assert_same, cluster, has_gpu, lightloom, pictures, report, run, start,
};
use serde_json::{Value, json};
use std::fs;
use std::path::PathBuf;

/// Four projectors that two back-ends drive crosswise.
fn crossed() -> String {
    let head = SMALL_DISPLAY.split("[projector_line]").next().unwrap();
    let projector = |(index, backend): (u32, u32)| {
        format!(
            "[[projector]]\nname = 'p{index}'\ncentre_m = [{:.2}, 0.0, -1.5]\nwidth_px = 96\nheight_px = 72\n\
             screen_rect_m = [-0.30, -0.225, 0.60, 0.45]\nbackend = {backend}\n",
            0.24 * f64::from(index) - 0.36
        )
    };
    format!("{head}{}", [(0, 1), (1, 0), (2, 0), (3, 1)].map(projector).concat())
}

struct Bench {
    folder: tempfile::TempDir,
    display: String,
}

impl Bench {
    /// With a display of this text.
    fn new(display: &str) -> Self {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("crossed.toml");
        fs::write(&path, display).unwrap();
        Self { folder, display: path.to_string_lossy().into_owned() }
    }

    fn out(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    fn arguments(&self, name: &str, device: &str, more: &[&str]) -> Vec<String> {
        let out = self.out(name).to_string_lossy().into_owned();
        let fixed = ["simulate", "procedural:shells@32", "--display", &self.display, "--device", device];
        let all = fixed.into_iter().chain(["--quiet", "--out", &out]).chain(more.iter().copied());
        all.map(str::to_owned).collect()
    }

    fn in_one_process(&self, name: &str, device: &str, more: &[&str]) -> Ran {
        run(&mut lightloom(&self.arguments(name, device, more)))
    }

    /// What the report says of each back-end.
    fn backends(&self, name: &str) -> Vec<Value> {
        report(&self.out(name))["backends"].as_array().unwrap().clone()
    }

    /// The projectors of each back-end by the report's heading, which have to be those that its frame was drawn with.
    fn projectors(&self, name: &str) -> Vec<Value> {
        let backends: Vec<Value> = self.backends(name).iter().map(|one| one["projectors"].clone()).collect();
        let frame = &report(&self.out(name))["frames"][0]["backends"];
        let drawn: Vec<_> = frame.as_array().unwrap().iter().map(|one| one["projectors"].clone()).collect();
        assert_eq!(backends, drawn);
        backends
    }
}

const BY_THE_FILE: &str = "wired by the display file";

#[test]
fn as_many_back_ends_as_the_file_has_draw_what_it_gives_them() {
    let bench = Bench::new(&crossed());
    let alone = bench.in_one_process("one", "cpu", &[]).succeeded();
    assert_eq!(alone.stderr, "");
    assert_eq!(bench.projectors("one"), [json!([0, 1, 2, 3])]);
    let both = bench.in_one_process("two", "cpu", &["--backends", "2"]).succeeded();
    assert_eq!(both.stderr, "");
    let wired = [json!([1, 2]), json!([0, 3])];
    assert_eq!(bench.projectors("two"), wired);
    assert!(bench.backends("two").iter().all(|one| one["why_these"] == BY_THE_FILE));
    assert_same("two back-ends", &pictures(&bench.out("one")), &pictures(&bench.out("two")));
    let page = fs::read_to_string(bench.out("two").join("report.html")).unwrap();
    assert!(page.contains(BY_THE_FILE) && page.contains("1 to 2") && page.contains("0, 3"));
    if let Some(mut command) = cluster(&bench.arguments("ranks", "cpu", &[]), 2) {
        start(&mut command).finish(LIMIT).succeeded();
        assert_eq!(bench.projectors("ranks"), wired);
        assert!(bench.backends("ranks").iter().all(|one| one["why_these"] == BY_THE_FILE));
        assert_same("two ranks", &pictures(&bench.out("one")), &pictures(&bench.out("ranks")));
    }
}

#[test]
fn another_number_of_back_ends_shares_evenly_and_says_so() {
    let bench = Bench::new(&crossed());
    let why = "shared evenly, because the display file wires 2 back-ends and 3 were started";
    let even = [json!([0]), json!([1]), json!([2, 3])];
    let check = |name: &str, ran: Ran| {
        let warnings: Vec<_> = ran.stderr.lines().filter(|line| line.contains(why)).collect();
        assert_eq!(warnings, [format!("lightloom: warning: projectors are {why}; neighbours stay together")]);
        assert_eq!(bench.projectors(name), even);
        assert!(bench.backends(name).iter().all(|one| one["why_these"] == why));
    };
    check("three", bench.in_one_process("three", "cpu", &["--backends", "3"]).succeeded());
    if let Some(mut command) = cluster(&bench.arguments("ranks", "cpu", &[]), 3) {
        check("ranks", start(&mut command).finish(LIMIT).succeeded());
    }
    let too_many = bench.in_one_process("five", "cpu", &["--backends", "5"]);
    too_many.refused(&["cannot share 4 projectors among 5 back-ends"]);
}

/// Software drivers have names, too: here one stands for a card.
#[test]
fn a_named_adapter_is_the_one_that_draws() {
    if !has_gpu() {
        return;
    }
    let bench = Bench::new(&crossed());
    bench.in_one_process("any", "gpu", &[]).succeeded();
    let adapter = bench.backends("any")[0]["adapter"].as_str().unwrap().to_owned();
    let name = adapter.trim_start_matches("gpu: ").split([' ', ',']).next().unwrap().to_uppercase();
    let wish = format!("[[backend]]\n[[backend]]\nadapter = '{name}'\n");
    let bench = Bench::new(&format!("{}{wish}", crossed()));
    let check = |name_of_run: &str| {
        let [any, named] = &bench.backends(name_of_run)[..] else { panic!("two back-ends") };
        assert_eq!((&any["adapter"], &named["adapter"]), (&json!(adapter), &json!(adapter)));
        let asks = format!("the display file asks for `{name}`");
        assert!(!any["reason"].as_str().unwrap().contains(&asks));
        assert!(named["reason"].as_str().unwrap().starts_with(&asks), "{named}");
    };
    bench.in_one_process("two", "gpu", &["--backends", "2"]).succeeded();
    check("two");
    if let Some(mut command) = cluster(&bench.arguments("ranks", "gpu", &[]), 2) {
        start(&mut command).finish(LIMIT).succeeded();
        check("ranks");
    }
}

#[test]
fn an_adapter_that_is_not_there_is_named_with_those_that_are() {
    let wish = "[[backend]]\n[[backend]]\nadapter = 'Voodoo 2'\n";
    let bench = Bench::new(&format!("{}{wish}", crossed()));
    if has_gpu() {
        let parts =
            ["back-end 1 ", "is called `Voodoo 2`: there is `", "correct `adapter` in the display file"];
        for device in ["auto", "gpu"] {
            bench.in_one_process("two", device, &["--backends", "2"]).refused(&parts);
        }
        if let Some(mut command) = cluster(&bench.arguments("ranks", "gpu", &[]), 2) {
            start(&mut command).finish(LIMIT).refused(&parts);
        }
    }
    // It does not matter where no adapter draws, nor to back-ends that the file does not wire.
    bench.in_one_process("cpu", "cpu", &["--backends", "2"]).succeeded();
    bench.in_one_process("one", "auto", &[]).succeeded();
}

#[test]
fn a_wiring_that_does_not_add_up_is_refused() {
    for (piece, by, part) in [
        ("backend = 1\n", "backend = 7\n", "`backend` is 7, but no projector has back-end 2"),
        ("backend = 1\n", "backend = -1\n", "`backend` cannot have this value"),
        ("backend = 1\n", "", "`backend` is missing"),
    ] {
        let bench = Bench::new(&crossed().replacen(piece, by, 1));
        bench.in_one_process("out", "cpu", &[]).refused(&[part]);
    }
    let tables = "[[backend]]\n".repeat(3);
    let bench = Bench::new(&format!("{}{tables}", crossed()));
    let part = "`backend` is the table of back-end 2, but the projectors' back-ends end at 1";
    bench.in_one_process("out", "cpu", &[]).refused(&[part]);
}
