//! Windows on the named outputs of a real X server without a screen.

use lightloom_tests::four_outputs::{Way, ended, last_dumped, turned_back, turned_display};
use lightloom_tests::program::{cluster, has_gpu, lightloom, run, start};
use lightloom_tests::x_server::{XServer, report};
use std::fs;
use std::path::Path;
use x11rb::connection::Connection;
use x11rb::protocol::xproto::{ConnectionExt as _, MapState};

/// Where the outputs are on the desktop.
const OUTPUTS: [(i16, i16); 4] = [(0, 0), (640, 0), (0, 480), (640, 480)];

const NAMES: [&str; 4] = ["DUMMY0", "DUMMY1", "DUMMY2", "DUMMY3"];

fn display(folder: &Path) -> String {
    turned_display(folder, NAMES)
}

/// What is seen of a projector, turned back.
fn picture(server: &XServer, projector: usize) -> Vec<u32> {
    let (left, top) = OUTPUTS[projector];
    turned_back(projector, |x, y, width, height| server.pixels(left + x, top + y, width, height))
}

#[test]
fn four_outputs_show_the_complete_pictures_whoever_draws_them() {
    shows_the_complete_pictures(Way::Memory);
}

#[test]
fn four_outputs_show_the_complete_pictures_that_a_gpu_paints() {
    if has_gpu() {
        shows_the_complete_pictures(Way::Painted);
    }
}

#[test]
fn a_gpu_paints_pictures_that_the_host_has_filled() {
    let folder = tempfile::tempdir().unwrap();
    if !has_gpu() {
        return;
    }
    let Some(server) = XServer::four_outputs(folder.path()) else { return };
    let display = display(folder.path());
    let complete = Way::Painted.complete_pictures(&display, &folder.path().join("out"), 4);
    let running =
        start(&mut server.on(lightloom(&Way::Painted.onto_outputs(&display, &["--control", "errors"]))));
    server.wait_for("the complete pictures, unit by unit", |server| {
        (0..4).all(|projector| picture(server, projector) == complete[projector])
    });
    ended(running);
}

fn shows_the_complete_pictures(way: Way) {
    let folder = tempfile::tempdir().unwrap();
    let Some(server) = XServer::four_outputs(folder.path()) else { return };
    let display = display(folder.path());
    let complete = way.complete_pictures(&display, &folder.path().join("out"), 4);
    let shows = |server: &XServer, projector: usize| picture(server, projector) == complete[projector];
    let dump = folder.path().join("dump").to_string_lossy().into_owned();
    let command = lightloom(&way.onto_outputs(&display, &["--backends", "2", "--dump", &dump]));
    let running = start(&mut server.on(command));
    server.wait_for("the complete pictures, to the code", |server| (0..4).all(|p| shows(server, p)));
    // Around them all is black.
    let all = server.pixels(0, 0, 1280, 960);
    let lit = |pixels: &[u32]| pixels.iter().filter(|&&pixel| pixel != 0).count();
    assert_eq!(lit(&all), complete.iter().map(|picture| lit(picture)).sum::<usize>());
    ended(running);
    assert!(last_dumped(&dump, 4) == complete, "the dump is what was seen");
    if let Some(command) = cluster(&way.onto_outputs(&display, &["--for", "6"]), 2) {
        let running = start(&mut server.on(command));
        server.wait_for("the same by two processes", |server| (0..4).all(|p| shows(server, p)));
        assert_eq!(report(running)["end"], "planned");
    }
}

#[test]
fn outputs_that_change_and_windows_that_close_are_followed() {
    follows(Way::Memory);
}

#[test]
fn painted_windows_follow_outputs_as_well() {
    if has_gpu() {
        follows(Way::Painted);
    }
}

fn follows(way: Way) {
    let folder = tempfile::tempdir().unwrap();
    let Some(server) = XServer::four_outputs(folder.path()) else { return };
    let display = display(folder.path());
    let complete = way.complete_pictures(&display, &folder.path().join("out"), 4);
    let running = start(&mut server.on(lightloom(&way.onto_outputs(&display, &["--backends", "2"]))));
    let shows = |projector: usize| {
        let wanted = &complete[projector];
        server.wait_for(&format!("projector {projector}"), |server| picture(server, projector) == *wanted);
    };
    (0..4).for_each(shows);
    // What a GPU paints is one window over the two outputs of a back-end, which lie side by side.
    let (of_output, of_two) = ((640, 480), (1280, 480));
    let (all, without_one) = match way {
        Way::Memory => (vec![of_output; 4], vec![of_output; 3]),
        Way::Painted => (vec![of_two; 2], vec![of_output, of_two]),
    };
    assert_eq!(sizes(&server), all);
    server.xrandr(&["--output", "DUMMY1", "--off"]);
    server.wait_for("no window on one of them", |server| sizes(server) == without_one);
    [0, 2, 3].into_iter().for_each(shows);
    server.xrandr(&["--output", "DUMMY1", "--mode", "640x480", "--pos", "640x0"]);
    (0..4).for_each(shows);
    server.xrandr(&["--output", "DUMMY3", "--mode", "640x400", "--pos", "640x480"]);
    server.xrandr(&["--output", "DUMMY0", "--mode", "640x400", "--pos", "0x0"]);
    // What the windows of the old sizes show is right as well; they go when the new ones are there.
    let less_high = [(640, 400), (640, 400), of_output, of_output];
    server.wait_for("two windows less high in place of two others", |server| sizes(server) == less_high);
    (0..4).for_each(shows);
    let first = windows(&server)[0];
    server.connection.destroy_window(first).unwrap().check().unwrap();
    server
        .wait_for("another window", |server| windows(server).len() == 4 && !windows(server).contains(&first));
    (0..4).for_each(shows);
    // Sentences come with the next look after the windows.
    running.wait_to_say("somebody closed the window");
    let said = ended(running);
    let lines = [
        "output DUMMY1 has nothing connected to it",
        "output DUMMY1 now shows 640 × 480",
        "output DUMMY3 now shows 640 × 400",
        "somebody closed the window",
    ];
    assert!(lines.iter().all(|line| said.contains(line)), "{said}");
}

/// The windows that are to be seen on the desktop.
fn windows(server: &XServer) -> Vec<u32> {
    let all = server.connection.query_tree(server.root).unwrap().reply().unwrap().children;
    let is_seen = |&window: &u32| {
        let attributes = server.connection.get_window_attributes(window).unwrap().reply();
        attributes.is_ok_and(|attributes| attributes.map_state == MapState::VIEWABLE)
    };
    server.connection.flush().unwrap();
    all.into_iter().filter(is_seen).collect()
}

/// Pixels of each of them along x and y, the smallest first.
fn sizes(server: &XServer) -> Vec<(u16, u16)> {
    let size = |window: u32| server.connection.get_geometry(window).ok()?.reply().ok();
    let sizes = windows(server).into_iter().filter_map(size);
    let mut sizes: Vec<(u16, u16)> = sizes.map(|size| (size.width, size.height)).collect();
    sizes.sort_unstable();
    sizes
}

#[test]
fn what_outputs_cannot_show_is_refused_in_a_sentence() {
    let folder = tempfile::tempdir().unwrap();
    let display = display(folder.path());
    let bare = |display: &str, more: &[&str]| {
        let mut command = lightloom(&Way::Memory.onto_outputs(display, more));
        command.env_remove("DISPLAY").env_remove("WAYLAND_DISPLAY");
        command
    };
    run(&mut bare(&display, &[])).refused(&["no X server can be reached", "DISPLAY"]);
    run(&mut bare("desk8", &[])).refused(&["projector `projector-0` has no output", "lightloom outputs"]);
    run(lightloom(&["outputs"]).env_remove("DISPLAY")).refused(&["no X server can be reached"]);
    let nowhere = ["drive", "procedural:shells@32", "--output", "none", "--swapchain", "on"];
    run(&mut lightloom(&nowhere)).refused(&["--swapchain on", "--output outputs"]);
    let Some(server) = XServer::four_outputs(folder.path()) else { return };
    let by_cpu = Way::Memory.onto_outputs(&display, &["--swapchain", "on"]);
    run(&mut server.on(lightloom(&by_cpu))).refused(&["--swapchain on needs --device gpu"]);
    let listed = run(&mut server.on(lightloom(&["outputs"]))).succeeded().stdout;
    assert!(listed.contains("DUMMY2   shows 640 × 480 at "), "{listed}");
    assert!(listed.contains("output = { name = \"DUMMY3\", x_px = 0, y_px = 0 }    # 640 × 480"), "{listed}");
    let other = fs::read_to_string(&display).unwrap().replace("DUMMY", "HDMI-");
    fs::write(&display, other).unwrap();
    run(&mut server.on(lightloom(&Way::Memory.onto_outputs(&display, &[]))))
        .refused(&["none of the outputs HDMI-0, HDMI-1, HDMI-2, HDMI-3 is connected"]);
}
