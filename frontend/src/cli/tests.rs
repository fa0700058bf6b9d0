//! Laws of the command line.

use super::*;
use clap::CommandFactory;
use glam::DVec3;
use optics::DebugView;
use protocol::Pace;

fn simulate(arguments: &[&str]) -> Result<SimulateArgs, clap::Error> {
    let all = ["lightloom", "simulate", "procedural:shells", "--out", "o"].iter().chain(arguments);
    Cli::try_parse_from(all).map(|cli| match cli.command {
        Command::Simulate(args) => args,
        other => panic!("{other:?}"),
    })
}

#[test]
fn the_command_line_is_consistent() {
    Cli::command().debug_assert();
}

/// Otherwise a number below 0 is taken for an option that nobody knows.
#[test]
fn every_number_may_begin_with_a_minus() {
    let words = [
        "DIR",
        "DISPLAY",
        "FILE",
        "INPUTS.toml",
        "NAME",
        "NAME,…",
        "OUT.lloom",
        "RULE",
        "SCENE.toml",
        "STATUS.json",
        "STORE.lloom",
        "SERIES",
        "TAPE.mcap",
        "TRACKER.toml",
        "TYPE",
    ];
    let mut numbers = 0;
    let cli = Cli::command();
    let commands =
        cli.get_subcommands().flat_map(|command| [command].into_iter().chain(command.get_subcommands()));
    for command in commands {
        for option in command.get_opts().filter(|option| option.get_possible_values().is_empty()) {
            let names: Vec<_> =
                option.get_value_names().into_iter().flatten().map(|name| name.as_str()).collect();
            let is_word = words.contains(&names[0]) || !option.get_action().takes_values();
            assert!(is_word || option.is_allow_hyphen_values_set(), "{}: {names:?}", command.get_name());
            numbers += usize::from(!is_word);
        }
    }
    assert!(numbers > 20, "{numbers}");
    for (wrong, sentence) in [
        (["--frames", "-1..2"], "give a rising range"),
        (["--cache-mib", "-1"], "give a whole number from 1 to 1073741824"),
        (["--backends", "-1"], "give a whole number from 1 to"),
        (["--eye", "0,0,1e300"], "give three numbers from -1000000 to 1000000"),
    ] {
        let error = simulate(&wrong).unwrap_err();
        assert_eq!(error.exit_code(), 2, "{wrong:?}");
        assert!(error.to_string().contains(sentence), "{error}");
    }
}

#[test]
fn eyes_may_be_left_of_the_centre() {
    let args = simulate(&["--eye", "-0.3,0,3", "--eye=0.3, 0, 3", "--frames", "2..5"]).unwrap();
    assert_eq!(args.eyes, [DVec3::new(-0.3, 0.0, 3.0), DVec3::new(0.3, 0.0, 3.0)]);
    assert_eq!(args.frames, Some((2, 5)));
}

#[test]
fn nonsense_is_a_usage_error() {
    for wrong in [
        ["--eye", "1,2"],
        ["--eye", "nan,0,1"],
        ["--frames", "5..5"],
        ["--frames", "3"],
        ["--backends", "0"],
        ["--cache-mib", "0"],
        ["--device", "tpu"],
    ] {
        assert_eq!(simulate(&wrong).unwrap_err().exit_code(), 2, "{wrong:?}");
    }
}

#[test]
fn frames_are_complete_unless_they_are_live() {
    let pace = |rest: &[&str]| simulate(rest).map(|args| args.live.pace()).map_err(|error| error.exit_code());
    let live = |mib: u64, fade_s| Ok(Pace::Live { upload_bytes: mib << 20, fade_s });
    assert_eq!(pace(&[]), Ok(Pace::Complete));
    assert_eq!(pace(&["--live"]), live(64, 0.4));
    assert_eq!(pace(&["--live", "--fade", "0", "--upload-mib", "1"]), live(1, 0.0));
    assert_eq!(pace(&["--fade", "1.5", "--live"]), live(64, 1.5));
    // Only live frames fade.
    assert_eq!(pace(&["--fade", "1"]), Err(2));
    assert_eq!(pace(&["--upload-mib", "8"]), Err(2));
}

#[test]
fn what_no_live_frame_can_do_is_told_in_a_sentence() {
    for (wrong, sentence) in [
        (["--fade", "-0.1"], "give a number of seconds from 0 to 3600"),
        (["--fade", "nan"], "give a number of seconds from 0 to 3600"),
        (["--fade", "inf"], "give a number of seconds from 0 to 3600"),
        (["--upload-mib", "0"], "give a whole number of MiB from 1 to 1048576"),
        (["--upload-mib", "-5"], "give a whole number of MiB from 1 to 1048576"),
        (["--upload-mib", "99999999999999999999"], "give a whole number of MiB from 1 to 1048576"),
    ] {
        let error = simulate(&["--live", wrong[0], wrong[1]]).unwrap_err();
        assert_eq!(error.exit_code(), 2, "{wrong:?}");
        assert!(error.to_string().contains(sentence), "{error}");
    }
}

#[test]
fn debug_views_go_by_their_names() {
    let view = |name| simulate(&["--debug-view", name]).map(|args| args.debug_view.map(DebugView::from));
    for (name, expected) in [
        ("lod", DebugView::Lod),
        ("deficit", DebugView::Deficit),
        ("samples", DebugView::Samples),
        ("weights", DebugView::Weights),
    ] {
        assert_eq!(view(name).unwrap(), Some(expected));
    }
    assert!(simulate(&[]).unwrap().debug_view.is_none());
    let error = view("heat").unwrap_err();
    assert_eq!(error.exit_code(), 2);
    assert!(error.to_string().contains("[possible values: lod, deficit, samples, weights]"), "{error}");
}

#[test]
fn a_gallery_takes_sizes_of_pictures() {
    let gallery = |rest: &[&str]| {
        let all = ["lightloom", "gallery", "a.toml", "-o", "o"].iter().chain(rest);
        Cli::try_parse_from(all).map_err(|error| error.exit_code()).map(|cli| match cli.command {
            Command::Gallery(args) => (args.size, args.display, args.drawing.cache_mib),
            other => panic!("{other:?}"),
        })
    };
    assert_eq!(gallery(&[]), Ok((None, "desk8".to_owned(), 1024)));
    assert_eq!(gallery(&["--size", "640x480"]).unwrap().0, Some(glam::UVec2::new(640, 480)));
    for wrong in ["640", "0x480", "640x-1", "9000x480", "x"] {
        assert_eq!(gallery(&["--size", wrong]), Err(2), "{wrong}");
    }
}

fn import(rest: &[&str]) -> Result<ImportArgs, i32> {
    let all = ["lightloom", "import", "a.raw", "-o", "a.lloom"].iter().chain(rest);
    Cli::try_parse_from(all).map_err(|error| error.exit_code()).map(|cli| match cli.command {
        Command::Import(args) => args,
        other => panic!("{other:?}"),
    })
}

#[test]
fn raw_voxels_need_size_and_type() {
    let exit_code = |rest: &[&str]| import(rest).map(|_| ());
    assert_eq!(exit_code(&["--raw-dims", "2,3,4"]), Err(2));
    assert_eq!(exit_code(&["--raw-type", "int16"]), Err(2));
    assert_eq!(exit_code(&["--raw-dims", "2,3,4", "--raw-type", "int16", "--bits", "16"]), Ok(()));
    assert_eq!(exit_code(&["--raw-dims", "2,3,0", "--raw-type", "int16"]), Err(2));
    let all = ["lightloom", "import", "a", "-o", "b", "--raw-type", "int16", "--raw-dims", "-1,2,3"];
    let error = Cli::try_parse_from(all).unwrap_err().to_string();
    assert!(
        error.contains("give three whole numbers of at least 1,") && !error.contains("unexpected"),
        "{error}"
    );
}

#[test]
fn an_import_takes_all_that_a_build_can_be_told() {
    let args = import(&[
        "--codec",
        "zstd",
        "--memory",
        "512",
        "--empty-below",
        "-200",
        "--no-deviation",
        "--series",
        "2",
        "--level",
        "1",
        "--channel",
        "0",
        "--time",
        "3",
        "--spacing-mm",
        "0.5,0.5,2",
    ])
    .unwrap();
    assert_eq!((args.codec, args.memory_mib, args.empty_below), (CodecArg::Zstd, 512, Some(-200.0)));
    assert_eq!((args.pick.level, args.pick.channel, args.pick.time), (Some(1), Some(0), Some(3)));
    assert_eq!((args.pick.series.as_deref(), args.no_deviation), (Some("2"), true));
    assert_eq!(args.pick.voxel_mm, Some(DVec3::new(0.5, 0.5, 2.0)));
}

#[test]
fn contradictions_are_usage_errors() {
    let wrong: [&[&str]; 6] = [
        &["--empty-below", "1", "--empty-for", "a.toml"],
        &["--empty-below", "nan"],
        &["--memory", "0"],
        &["--level", "-1"],
        &["--spacing-mm", "1,0,1"],
        &["--raw-dims", "1,1,1", "--raw-type", "int8", "--raw-spacing-mm", "1,1,1", "--spacing-mm", "1,1,1"],
    ];
    for rest in wrong {
        assert_eq!(import(rest).map(|_| ()), Err(2), "{rest:?}");
    }
}
