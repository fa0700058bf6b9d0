//! A real window of a real window system, without a screen.

use lightloom_tests::program::{LIMIT, Running, lightloom, run, small_display, start};
use serde_json::Value;
use std::io::Read;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};
use x11rb::connection::Connection;
use x11rb::protocol::xproto::{ConnectionExt as _, ImageFormat, Keysym, Window};
use x11rb::protocol::xtest::ConnectionExt as _;
use x11rb::rust_connection::RustConnection;

/// Sizes of the display `small4` and of its sheet: four pictures of 96 × 72 in a row, 2 pixels apart.
const PICTURE: (usize, usize) = (96, 72);
const GAP: usize = 2;
const SHEET: (u16, u16) = (4 * 98 + 2, 74 + 2);

/// Events, as XTEST numbers them.
const KEY_PRESS: u8 = 2;
const BUTTON_PRESS: u8 = 4;
const MOTION: u8 = 6;

/// An X server without a screen, with a connection to it.
struct Desktop {
    server: Child,
    name: String,
    connection: RustConnection,
    root: Window,
}

impl Desktop {
    /// None where there is no Xvfb, which is said aloud, and a failure with LIGHTLOOM_REQUIRE_WINDOWS=1.
    fn open() -> Option<Self> {
        let mut command = Command::new("Xvfb");
        command.args(["-displayfd", "1", "-screen", "0", "800x600x24", "-nolisten", "tcp"]);
        let Ok(mut server) = command.stdout(Stdio::piped()).stderr(Stdio::null()).spawn() else {
            println!("SKIPPED: there is no Xvfb on the path");
            assert!(
                std::env::var("LIGHTLOOM_REQUIRE_WINDOWS").as_deref() != Ok("1"),
                "LIGHTLOOM_REQUIRE_WINDOWS=1, and there is no Xvfb"
            );
            return None;
        };
        let mut number = Vec::new();
        let mut stdout = server.stdout.take().unwrap();
        let mut byte = [0];
        while stdout.read_exact(&mut byte).is_ok() && byte[0] != b'\n' {
            number.push(byte[0]);
        }
        let name = format!(":{}", String::from_utf8(number).unwrap().trim());
        let (connection, screen) = x11rb::connect(Some(&name)).unwrap();
        let root = connection.setup().roots[screen].root;
        Some(Self { server, name, connection, root })
    }

    fn start(&self, display: &str, more: &[&str]) -> Running {
        let fixed = ["drive", "procedural:shells@32", "--display", display, "--device", "cpu", "--desktop"];
        let steady = ["--fade", "0", "--rate", "30", "--json"];
        let mut command = lightloom(&[&fixed[..], &steady, more].concat());
        start(command.env("DISPLAY", &self.name).env_remove("WAYLAND_DISPLAY"))
    }

    /// The pixels of the sheet, 0x00RRGGBB; the window is at the top left of the screen.
    fn sheet(&self) -> Vec<u32> {
        let image = self
            .connection
            .get_image(ImageFormat::Z_PIXMAP, self.root, 0, 0, SHEET.0, SHEET.1, u32::MAX)
            .unwrap()
            .reply()
            .unwrap();
        let pixels = image.data.chunks_exact(4);
        pixels.map(|pixel| u32::from_le_bytes(pixel.try_into().unwrap()) & 0xff_ffff).collect()
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
        self.connection.xtest_fake_input(kind, detail, 0, self.root, x, y, 0).unwrap().check().unwrap();
        self.connection.flush().unwrap();
        sleep(Duration::from_millis(50));
    }

    fn press_key(&self, letter: char) {
        let setup = self.connection.setup();
        let (first, last) = (setup.min_keycode, setup.max_keycode);
        let keys = self.connection.get_keyboard_mapping(first, last - first + 1).unwrap().reply().unwrap();
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

    /// Looks until the window shows what is wanted, and fails if it does not within a while.
    #[track_caller]
    fn wait_for(&self, what: &str, is_there: impl Fn(&Self) -> bool) {
        let since = Instant::now();
        while !is_there(self) {
            assert!(since.elapsed() < Duration::from_secs(30), "the window does not show {what}");
            sleep(Duration::from_millis(100));
        }
    }
}

impl Drop for Desktop {
    fn drop(&mut self) {
        let _ = self.server.kill();
        let _ = self.server.wait();
    }
}

/// What `simulate` draws of the same scene: the pixels of each projector.
fn complete_pictures(display: &str, out: &Path) -> Vec<Vec<u32>> {
    let folder = out.to_string_lossy();
    let arguments = [
        "simulate",
        "procedural:shells@32",
        "--display",
        display,
        "--device",
        "cpu",
        "--out",
        &folder,
        "--quiet",
    ];
    run(&mut lightloom(&arguments)).succeeded();
    let picture = |projector: usize| {
        let path = out.join(format!("frame-0000/projector-{projector:02}.png"));
        let pixels = image::open(path).unwrap().to_rgb8();
        pixels.pixels().map(|p| u32::from(p[0]) << 16 | u32::from(p[1]) << 8 | u32::from(p[2])).collect()
    };
    (0..4).map(picture).collect()
}

fn report(running: Running) -> Value {
    let ran = running.finish(LIMIT).succeeded();
    serde_json::from_str(&ran.stdout).expect("the report is JSON")
}

#[test]
fn a_window_shows_the_complete_pictures_and_obeys_mouse_and_keys() {
    let Some(desktop) = Desktop::open() else { return };
    let folder = tempfile::tempdir().unwrap();
    let display = small_display(folder.path());
    let complete = complete_pictures(&display, &folder.path().join("out"));
    assert!(
        complete.iter().all(|picture| picture.iter().any(|&pixel| pixel != 0)),
        "something is to be seen"
    );
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
    let _ = desktop.server.kill();
    let ran = running.finish(LIMIT);
    assert_ne!(ran.code, Some(0), "{ran:?}");
    assert!(!ran.stderr.contains("panicked"), "{ran:?}");
}
