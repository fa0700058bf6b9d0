//! Windows on the named outputs of a real Wayland desktop without a screen.

use lightloom_tests::four_outputs::{Way, ended, last_dumped, turned_back, turned_display};
use lightloom_tests::program::{cluster, has_gpu, lightloom, run, start};
use lightloom_tests::wayland_desktop::WaylandDesktop;
use lightloom_tests::x_server::{XServer, report};
use std::fs;
use std::thread::sleep;
use std::time::Duration;

const NAMES: [&str; 4] = ["HEADLESS-1", "HEADLESS-2", "HEADLESS-3", "HEADLESS-4"];
/// Of outputs that are windows of an X server: the last is not there when a show begins.
const ON_X: [&str; 4] = ["X11-1", "X11-2", "X11-3", "X11-5"];

/// What is seen of a projector, turned back; nothing where its output is gone.
fn picture(desktop: &WaylandDesktop, name: &str, projector: usize) -> Vec<u32> {
    let Some((across, all)) = desktop.pixels(name) else { return Vec::new() };
    turned_back(projector, |x, y, width, height| {
        let row = |row: usize| {
            let from = (y as usize + row) * across + x as usize;
            all.get(from..from + usize::from(width)).map_or(vec![0; usize::from(width)], <[u32]>::to_vec)
        };
        (0..usize::from(height)).flat_map(row).collect()
    })
}

#[test]
fn four_outputs_of_wayland_show_the_complete_pictures_whoever_draws_them() {
    let folder = tempfile::tempdir().unwrap();
    let Some(desktop) = WaylandDesktop::four_outputs() else { return };
    let display = turned_display(folder.path(), NAMES);
    let complete = Way::Memory.complete_pictures(&display, &folder.path().join("out"), 4);
    let shows = |desktop: &WaylandDesktop, projector: usize| {
        picture(desktop, NAMES[projector], projector) == complete[projector]
    };
    let dump = folder.path().join("dump").to_string_lossy().into_owned();
    let command = lightloom(&Way::Memory.onto_outputs(&display, &["--backends", "2", "--dump", &dump]));
    let running = start(&mut desktop.on(command));
    desktop.wait_for("the complete pictures, to the code", |desktop| (0..4).all(|p| shows(desktop, p)));
    // Around them all is black: no border, no title.
    let lit = |pixels: &[u32]| pixels.iter().filter(|&&pixel| pixel != 0).count();
    for (name, complete) in NAMES.iter().zip(&complete) {
        assert_eq!(lit(&desktop.pixels(name).unwrap().1), lit(complete), "{name}");
    }
    desktop.order("output HEADLESS-1 mode 800x600");
    desktop.wait_for("a larger output", |desktop| {
        desktop.pixels("HEADLESS-1").is_some_and(|(width, _)| width == 800)
    });
    desktop.wait_for("the same in another mode", |desktop| (0..4).all(|p| shows(desktop, p)));
    // In other units of the desktop's own, too, it is pixel for pixel.
    desktop.order("output HEADLESS-4 scale 2");
    sleep(Duration::from_millis(500));
    desktop.wait_for("the same in other units", |desktop| shows(desktop, 3));
    desktop.order("output HEADLESS-4 scale 1");
    let said = ended(running);
    assert!(said.contains("output HEADLESS-1 now shows 800 × 600 pixels"), "{said}");
    assert!(last_dumped(&dump, 4) == complete, "the dump is what was seen");
    if let Some(command) = cluster(&Way::Memory.onto_outputs(&display, &["--for", "6"]), 2) {
        let running = start(&mut desktop.on(command));
        desktop.wait_for("the same by two processes", |desktop| (0..4).all(|p| shows(desktop, p)));
        assert_eq!(report(running)["end"], "planned");
    }
}

#[test]
fn outputs_of_wayland_that_change_and_windows_that_close_are_followed() {
    let folder = tempfile::tempdir().unwrap();
    let Some(server) = XServer::desktop() else { return };
    let Some(desktop) = WaylandDesktop::on_x(&server) else { return };
    let display = turned_display(folder.path(), ON_X);
    let complete = Way::Memory.complete_pictures(&display, &folder.path().join("out"), 4);
    let running =
        start(&mut desktop.on(lightloom(&Way::Memory.onto_outputs(&display, &["--backends", "2"]))));
    let shows = |when: &str, projectors: &[usize]| {
        for &projector in projectors {
            let (name, wanted) = (ON_X[projector], &complete[projector]);
            let what = format!("its picture on {name} {when}");
            desktop.wait_for(&what, |desktop| picture(desktop, name, projector) == *wanted);
        }
    };
    shows("at the beginning", &[0, 1, 2]);
    desktop.order("create_output");
    desktop.order("output X11-5 mode 640x480");
    shows("beside a new output", &[0, 1, 2, 3]);
    desktop.unplug(&server, "X11-2");
    desktop.wait_for("one output less", |desktop| desktop.pixels("X11-2").is_none());
    shows("with an output less", &[0, 2, 3]);
    let before = desktop.windows();
    desktop.order("[app_id=lightloom] kill");
    desktop.wait_for("new windows", |desktop| {
        let now = desktop.windows();
        now.len() == before.len() && now.is_disjoint(&before)
    });
    shows("in new windows", &[0, 2, 3]);
    // Sentences come with the next look after the windows.
    running.wait_to_say("somebody closed the window on output X11-");
    let said = ended(running);
    let lines = [
        "output X11-5 does not exist",
        "output X11-5 now shows",
        "output X11-2 does not exist",
        "somebody closed the window on output X11-",
    ];
    assert!(lines.iter().all(|line| said.contains(line)), "{said}");
}

#[test]
fn what_wayland_cannot_show_is_refused_in_a_sentence() {
    let folder = tempfile::tempdir().unwrap();
    let display = turned_display(folder.path(), NAMES);
    let mut nowhere = lightloom(&Way::Memory.onto_outputs(&display, &[]));
    nowhere.env("XDG_RUNTIME_DIR", folder.path()).env("WAYLAND_DISPLAY", "wayland-9");
    run(&mut nowhere).refused(&["no Wayland desktop can be reached", "WAYLAND_DISPLAY"]);
    let Some(desktop) = WaylandDesktop::four_outputs() else { return };
    let listed = run(&mut desktop.on(lightloom(&["outputs"]))).succeeded().stdout;
    assert!(listed.contains("HEADLESS-4  shows 640 × 480 at 60.00 Hz from 1000, 1000"), "{listed}");
    assert!(
        listed.contains("output = { name = \"HEADLESS-2\", x_px = 0, y_px = 0 }    # 640 × 480"),
        "{listed}"
    );
    if has_gpu() {
        run(&mut desktop.on(lightloom(&Way::Painted.onto_outputs(&display, &[]))))
            .refused(&["on Wayland windows get their pictures from main memory", "--swapchain off"]);
    }
    let text = fs::read_to_string(&display).unwrap();
    fs::write(&display, text.replace("HEADLESS", "HDMI")).unwrap();
    let show = || run(&mut desktop.on(lightloom(&Way::Memory.onto_outputs(&display, &[]))));
    show().refused(&[
        "none of the outputs HDMI-1, HDMI-2, HDMI-3, HDMI-4 is connected to this Wayland desktop",
    ]);
    fs::write(&display, text.replace("name = \"HEADLESS-1\", ", "")).unwrap();
    show().refused(&["projector `p0` has a place on the desktop, which Wayland gives to no window"]);
}
