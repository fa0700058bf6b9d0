//! X servers without a screen: one desktop, or several named outputs.

use crate::machine;
use crate::program::{LIMIT, Running};
use serde_json::Value;
use std::fs;
use std::io::Read;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use x11rb::connection::Connection;
use x11rb::protocol::xproto::{ConnectionExt as _, ImageFormat, Window};
use x11rb::rust_connection::RustConnection;

/// What Xorg's driver without hardware needs to know. The modes are those that it has anyway.
const DUMMY: &str = r#"
Section "ServerFlags"
  Option "AutoAddDevices" "false"
EndSection
Section "Device"
  Identifier "dummy"
  Driver "dummy"
  VideoRam 64000
EndSection
Section "Monitor"
  Identifier "monitor"
  HorizSync 5.0-1000.0
  VertRefresh 5.0-200.0
EndSection
Section "Screen"
  Identifier "screen"
  Device "dummy"
  Monitor "monitor"
  DefaultDepth 24
  SubSection "Display"
    Depth 24
    Modes "640x480"
    Virtual 2560 1920
  EndSubSection
EndSection
"#;

/// A server, with a connection to it.
pub struct XServer {
    server: Child,
    /// What DISPLAY calls it.
    pub name: String,
    /// A connection to it.
    pub connection: RustConnection,
    /// The root of its screen.
    pub root: Window,
}

impl XServer {
    /// One desktop of 800 × 600; None where there is no Xvfb.
    pub fn desktop() -> Option<Self> {
        let mut command = Command::new("Xvfb");
        command.args(["-displayfd", "1", "-screen", "0", "800x600x24", "-nolisten", "tcp"]);
        Self::start(command)
    }

    /// Outputs DUMMY0 to DUMMY3 of 640 × 480 in two rows of two; None where there is no Xorg with a driver for none.
    pub fn four_outputs(folder: &Path) -> Option<Self> {
        let (settings, log) = (folder.join("xorg.conf"), folder.join("xorg.log"));
        fs::write(&settings, DUMMY).expect("a temporary folder can be written");
        let mut command = Command::new("Xorg");
        command.args(["-displayfd", "1", "-noreset", "-novtswitch", "-sharevts", "-nolisten", "tcp"]);
        command.arg("-config").arg(settings).arg("-logfile").arg(log);
        let server = Self::start(command)?;
        for (output, place) in ["0x0", "640x0", "0x480", "640x480"].iter().enumerate() {
            let output = format!("DUMMY{output}");
            server.xrandr(&["--addmode", &output, "640x480"]);
            server.xrandr(&["--addmode", &output, "640x400"]);
            server.xrandr(&["--output", &output, "--mode", "640x480", "--pos", place]);
        }
        Some(server)
    }

    fn start(mut command: Command) -> Option<Self> {
        machine::alone();
        let program = command.get_program().to_string_lossy().into_owned();
        let Ok(mut server) = command.stdout(Stdio::piped()).stderr(Stdio::null()).spawn() else {
            machine::lacks_windows(&format!("there is no {program} on the path"));
            return None;
        };
        // It writes its number once it takes connections.
        let mut number = Vec::new();
        let mut stdout = server.stdout.take().expect("it is piped");
        let mut byte = [0];
        while stdout.read_exact(&mut byte).is_ok() && byte[0] != b'\n' {
            number.push(byte[0]);
        }
        if number.is_empty() {
            machine::lacks_windows(&format!("{program} does not start: {:?}", server.wait()));
            return None;
        }
        let name = format!(":{}", String::from_utf8(number).expect("a number is text").trim());
        let (connection, screen) = x11rb::connect(Some(&name)).expect("it takes connections");
        let root = connection.setup().roots[screen].root;
        Some(Self { server, name, connection, root })
    }

    /// A program on this server.
    pub fn on(&self, mut command: Command) -> Command {
        command.env("DISPLAY", &self.name).env_remove("WAYLAND_DISPLAY");
        command
    }

    /// Changes its outputs.
    pub fn xrandr(&self, arguments: &[&str]) {
        let mut command = Command::new("xrandr");
        command.args(arguments);
        let done = self.on(command).status();
        assert!(done.is_ok_and(|status| status.success()), "xrandr {arguments:?}");
    }

    /// What is to be seen in a rectangle of the desktop: 0x00RRGGBB, by rows.
    pub fn pixels(&self, x: i16, y: i16, width: u16, height: u16) -> Vec<u32> {
        let format = ImageFormat::Z_PIXMAP;
        let image = self.connection.get_image(format, self.root, x, y, width, height, u32::MAX);
        let image = image.expect("the server answers").reply().expect("the rectangle is on the screen");
        let pixels = image.data.chunks_exact(4);
        pixels.map(|pixel| u32::from_le_bytes(pixel.try_into().expect("four bytes")) & 0xff_ffff).collect()
    }

    /// Looks until what is wanted is to be seen, and fails if it is not within a while.
    #[track_caller]
    pub fn wait_for(&self, what: &str, is_there: impl Fn(&Self) -> bool) {
        machine::wait_for(what, || is_there(self));
    }

    /// Ends it at once.
    pub fn kill(&mut self) {
        let _ = self.server.kill();
        let _ = self.server.wait();
    }
}

impl Drop for XServer {
    fn drop(&mut self) {
        self.kill();
    }
}

/// The report of a show that ended well.
pub fn report(running: Running) -> Value {
    let ran = running.finish(LIMIT).succeeded();
    serde_json::from_str(&ran.stdout).expect("the report is JSON")
}
