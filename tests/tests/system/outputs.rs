//! Windows on the named outputs of a real X server without a screen.

use lightloom_tests::four_outputs::{
    complete_pictures, ended, last_dumped, on_outputs, turned_back, turned_display,
};
use lightloom_tests::program::{cluster, lightloom, run, start};
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
    let folder = tempfile::tempdir().unwrap();
    let Some(server) = XServer::four_outputs(folder.path()) else { return };
    let display = display(folder.path());
    let complete = complete_pictures(&display, &folder.path().join("out"), 4);
    let shows = |server: &XServer, projector: usize| picture(server, projector) == complete[projector];
    let dump = folder.path().join("dump").to_string_lossy().into_owned();
    let command = lightloom(&on_outputs(&display, &["--backends", "2", "--dump", &dump]));
    let running = start(&mut server.on(command));
    server.wait_for("the complete pictures, to the code", |server| (0..4).all(|p| shows(server, p)));
    // Around them all is black.
    let all = server.pixels(0, 0, 1280, 960);
    let lit = |pixels: &[u32]| pixels.iter().filter(|&&pixel| pixel != 0).count();
    assert_eq!(lit(&all), complete.iter().map(|picture| lit(picture)).sum::<usize>());
    ended(running);
    assert!(last_dumped(&dump, 4) == complete, "the dump is what was seen");
    if let Some(command) = cluster(&on_outputs(&display, &["--for", "6"]), 2) {
        let running = start(&mut server.on(command));
        server.wait_for("the same by two processes", |server| (0..4).all(|p| shows(server, p)));
        assert_eq!(report(running)["end"], "planned");
    }
}

#[test]
fn outputs_that_change_and_windows_that_close_are_followed() {
    let folder = tempfile::tempdir().unwrap();
    let Some(server) = XServer::four_outputs(folder.path()) else { return };
    let display = display(folder.path());
    let complete = complete_pictures(&display, &folder.path().join("out"), 4);
    let running = start(&mut server.on(lightloom(&on_outputs(&display, &["--backends", "2"]))));
    let shows = |projector: usize| {
        let wanted = &complete[projector];
        server.wait_for(&format!("projector {projector}"), |server| picture(server, projector) == *wanted);
    };
    (0..4).for_each(shows);
    server.xrandr(&["--output", "DUMMY1", "--off"]);
    server.wait_for("three windows", |server| windows(server).len() == 3);
    [0, 2, 3].into_iter().for_each(shows);
    server.xrandr(&["--output", "DUMMY1", "--mode", "640x480", "--pos", "640x0"]);
    (0..4).for_each(shows);
    server.xrandr(&["--output", "DUMMY3", "--mode", "640x400", "--pos", "640x480"]);
    server.xrandr(&["--output", "DUMMY0", "--mode", "640x400", "--pos", "0x0"]);
    // What the windows of the old sizes show is right as well; they go when the new ones are there.
    server.wait_for("two windows less high in place of two others", |server| {
        let seen = windows(server);
        seen.len() == 4 && seen.iter().filter(|&&window| height(server, window) == Some(400)).count() == 2
    });
    (0..4).for_each(shows);
    let first = windows(&server)[0];
    server.connection.destroy_window(first).unwrap().check().unwrap();
    server
        .wait_for("another window", |server| windows(server).len() == 4 && !windows(server).contains(&first));
    (0..4).for_each(shows);
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

/// A window's pixels along y; None if it is gone.
fn height(server: &XServer, window: u32) -> Option<u16> {
    Some(server.connection.get_geometry(window).ok()?.reply().ok()?.height)
}

#[test]
fn what_outputs_cannot_show_is_refused_in_a_sentence() {
    let folder = tempfile::tempdir().unwrap();
    let display = display(folder.path());
    let bare = |display: &str, more: &[&str]| {
        let mut command = lightloom(&on_outputs(display, more));
        command.env_remove("DISPLAY").env_remove("WAYLAND_DISPLAY");
        command
    };
    run(&mut bare(&display, &[])).refused(&["no X server can be reached", "DISPLAY"]);
    run(&mut bare("desk8", &[])).refused(&["projector `projector-0` has no output", "lightloom outputs"]);
    run(lightloom(&["outputs"]).env_remove("DISPLAY")).refused(&["no X server can be reached"]);
    let Some(server) = XServer::four_outputs(folder.path()) else { return };
    let listed = run(&mut server.on(lightloom(&["outputs"]))).succeeded().stdout;
    assert!(listed.contains("DUMMY2   shows 640 × 480 at "), "{listed}");
    assert!(listed.contains("output = { name = \"DUMMY3\", x_px = 0, y_px = 0 }    # 640 × 480"), "{listed}");
    let other = fs::read_to_string(&display).unwrap().replace("DUMMY", "HDMI-");
    fs::write(&display, other).unwrap();
    run(&mut server.on(lightloom(&on_outputs(&display, &[]))))
        .refused(&["none of the outputs HDMI-0, HDMI-1, HDMI-2, HDMI-3 is connected"]);
}
