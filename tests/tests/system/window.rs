//! A real window of a real window system, without a screen.

use lightloom_tests::four_outputs::Way;
use lightloom_tests::program::{LIMIT, Running, lightloom, small_display, start};
use lightloom_tests::x_server::{XServer, report};
use std::thread::sleep;
use std::time::Duration;
use x11rb::connection::Connection;
use x11rb::protocol::xproto::{ConnectionExt as _, Keysym};
use x11rb::protocol::xtest::ConnectionExt as _;

/// Sizes of the display `small4` and of its sheet: four pictures of 96 × 72 in a row, 2 pixels apart.
const PICTURE: (usize, usize) = (96, 72);
const GAP: usize = 2;
const SHEET: (u16, u16) = (4 * 98 + 2, 74 + 2);

/// Events, as XTEST numbers them.
const KEY_PRESS: u8 = 2;
const BUTTON_PRESS: u8 = 4;
const MOTION: u8 = 6;

/// A desktop with a window.
struct Desktop(XServer);

impl Desktop {
    fn open() -> Option<Self> {
        XServer::desktop().map(Self)
    }

    fn start(&self, display: &str, more: &[&str]) -> Running {
        let fixed = ["drive", "procedural:shells@32", "--display", display, "--device", "cpu", "--desktop"];
        let steady = ["--fade", "0", "--rate", "30", "--caster", "rays", "--json"];
        start(&mut self.0.on(lightloom(&[&fixed[..], &steady, more].concat())))
    }

    /// The pixels of the sheet, 0x00RRGGBB; the window is at the top left of the screen.
    fn sheet(&self) -> Vec<u32> {
        self.0.pixels(0, 0, SHEET.0, SHEET.1)
    }

    /// The pixels of a projector's picture on the sheet.
    fn picture(&self, projector: usize) -> Vec<u32> {
        let (sheet, left) = (self.sheet(), GAP + projector * (PICTURE.0 + GAP));
        let row = |y: usize| {
            let at = (GAP + y) * usize::from(SHEET.0) + left;
            sheet[at..at + PICTURE.0].to_vec()
        };
        (0..PICTURE.1).flat_map(row).collect()
    }

    fn send(&self, kind: u8, detail: u8, x: i16, y: i16) {
        self.0.connection.xtest_fake_input(kind, detail, 0, self.0.root, x, y, 0).unwrap().check().unwrap();
        self.0.connection.flush().unwrap();
        sleep(Duration::from_millis(50));
    }

    fn press_key(&self, letter: char) {
        let setup = self.0.connection.setup();
        let (first, last) = (setup.min_keycode, setup.max_keycode);
        let keys = self.0.connection.get_keyboard_mapping(first, last - first + 1).unwrap().reply().unwrap();
        let per_code = usize::from(keys.keysyms_per_keycode);
        let has = |syms: &[Keysym]| syms.first() == Some(&(letter as u32));
        let place = keys.keysyms.chunks(per_code).position(has).expect("the keyboard has this letter");
        let code = first + place as u8;
        self.send(KEY_PRESS, code, 0, 0);
        self.send(KEY_PRESS + 1, code, 0, 0);
    }

    fn drag(&self, from: (i16, i16), to: (i16, i16)) {
        self.send(MOTION, 0, from.0, from.1);
        self.send(BUTTON_PRESS, 1, from.0, from.1);
        self.send(MOTION, 0, to.0, to.1);
        self.send(BUTTON_PRESS + 1, 1, to.0, to.1);
    }

    #[track_caller]
    fn wait_for(&self, what: &str, is_there: impl Fn(&Self) -> bool) {
        self.0.wait_for(what, |_| is_there(self));
    }
}

#[test]
fn a_window_shows_the_complete_pictures_and_obeys_mouse_and_keys() {
    let Some(desktop) = Desktop::open() else { return };
    let folder = tempfile::tempdir().unwrap();
    let display = small_display(folder.path());
    let complete = Way::Memory.complete_pictures(&display, &folder.path().join("out"), 4);
    let running = desktop.start(&display, &[]);
    let is_complete =
        |desktop: &Desktop| (0..4).all(|projector| desktop.picture(projector) == complete[projector]);
    desktop.wait_for("the complete pictures, to the code", is_complete);
    desktop.drag((60, 40), (130, 50));
    desktop.wait_for("another side of the volume", |desktop| !is_complete(desktop));
    desktop.press_key('r');
    desktop.wait_for("the volume as it was", is_complete);
    desktop.press_key('c');
    desktop.wait_for("a cut", |desktop| !is_complete(desktop));
    desktop.press_key('q');
    assert_eq!(report(running)["end"], "left");
}

#[test]
fn a_window_that_loses_its_desktop_ends_the_show_with_a_sentence() {
    let Some(mut desktop) = Desktop::open() else { return };
    let folder = tempfile::tempdir().unwrap();
    let display = small_display(folder.path());
    let running = desktop.start(&display, &[]);
    desktop.wait_for("anything", |desktop| desktop.picture(0).iter().any(|&pixel| pixel != 0));
    desktop.0.kill();
    let ran = running.finish(LIMIT);
    assert_ne!(ran.code, Some(0), "{ran:?}");
    assert!(!ran.stderr.contains("panicked"), "{ran:?}");
}
