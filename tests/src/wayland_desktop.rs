//! A Wayland desktop without a screen: sway with several named outputs.

use crate::four_outputs::packed;
use crate::machine;
use crate::x_server::XServer;
use serde_json::Value;
use std::collections::BTreeSet;
use std::fs;
use std::os::unix::fs::{MetadataExt, PermissionsExt, chown};
use std::os::unix::process::CommandExt;
use std::path::PathBuf;
use std::process::{Child, Command, Stdio};
use tempfile::TempDir;
use x11rb::errors::ReplyError;
use x11rb::protocol::xproto::{Atom, AtomEnum, ClientMessageEvent, ConnectionExt as _, EventMask};

/// The outputs, of 640 × 480 in two rows of two, apart from each other so that each can grow; KIND is what their connectors are.
const SETTINGS: &str = "\
xwayland disable
output KIND-1 mode 640x480 position 0 0
output KIND-2 mode 640x480 position 1000 0
output KIND-3 mode 640x480 position 0 1000
output KIND-4 mode 640x480 position 1000 1000
";

/// Whom sway runs as where this is root, whom it refuses.
const NOBODY: u32 = 65534;

/// A desktop.
pub struct WaylandDesktop {
    sway: Child,
    /// Where its sockets are.
    folder: TempDir,
    /// What WAYLAND_DISPLAY calls it.
    name: String,
    /// Where it takes orders.
    orders: PathBuf,
}

impl WaylandDesktop {
    /// Outputs HEADLESS-1 to HEADLESS-4; None where there is no sway or no grim, which takes pictures of it.
    pub fn four_outputs() -> Option<Self> {
        Self::start("HEADLESS", |command| {
            command.env_remove("DISPLAY").env("WLR_BACKENDS", "headless").env("WLR_HEADLESS_OUTPUTS", "4");
        })
    }

    /// Outputs X11-1 to X11-4, each a window of an X server, which [`unplug`](Self::unplug) takes away.
    pub fn on_x(server: &XServer) -> Option<Self> {
        // It takes names that the server knows; a window manager would have told it these.
        for name in ["_NET_WM_NAME", "UTF8_STRING", "WM_PROTOCOLS", "WM_DELETE_WINDOW"] {
            atom(server, name).expect("the X server answers");
        }
        Self::start("X11", |command| {
            command.env("DISPLAY", &server.name).env("WLR_BACKENDS", "x11").env("WLR_X11_OUTPUTS", "4");
        })
    }

    fn start(kind: &str, on: impl Fn(&mut Command)) -> Option<Self> {
        machine::alone();
        for program in ["sway", "grim"] {
            if Command::new(program).arg("-h").stdout(Stdio::null()).stderr(Stdio::null()).status().is_err() {
                machine::lacks_windows(&format!("there is no {program} on the path"));
                return None;
            }
        }
        let folder = tempfile::tempdir().expect("a temporary folder can be made");
        let settings = folder.path().join("settings");
        fs::write(&settings, SETTINGS.replace("KIND", kind)).expect("a temporary folder can be written");
        let private = fs::Permissions::from_mode(0o700);
        fs::set_permissions(folder.path(), private).expect("it is this process's own");
        let mut command = Command::new("sway");
        command.arg("-c").arg(settings).env_remove("WAYLAND_DISPLAY");
        command.env("XDG_RUNTIME_DIR", folder.path()).env("HOME", folder.path());
        command.env("WLR_RENDERER", "pixman").env("WLR_LIBINPUT_NO_DEVICES", "1");
        on(&mut command);
        if fs::metadata(folder.path()).expect("it is there").uid() == 0 {
            chown(folder.path(), Some(NOBODY), Some(NOBODY)).expect("root may");
            command.uid(NOBODY).gid(NOBODY);
        }
        let sway = command.stdout(Stdio::null()).stderr(Stdio::null()).spawn().expect("it is on the path");
        let mut desktop = Self { sway, folder, name: String::new(), orders: PathBuf::new() };
        desktop.wait_for("sway", |desktop| {
            desktop.socket("wayland-").is_some() && desktop.socket("sway-ipc").is_some()
        });
        desktop.name = desktop.socket("wayland-").expect("it has been seen");
        desktop.orders = desktop.folder.path().join(desktop.socket("sway-ipc").expect("it has been seen"));
        desktop.wait_for("its outputs", |desktop| desktop.pixels(&format!("{kind}-4")).is_some());
        Some(desktop)
    }

    /// A file of this kind among its sockets.
    fn socket(&self, kind: &str) -> Option<String> {
        let entries = fs::read_dir(self.folder.path()).expect("it is there");
        let mut names = entries.filter_map(|entry| entry.ok()?.file_name().into_string().ok());
        names.find(|name| name.starts_with(kind) && !name.ends_with(".lock"))
    }

    /// A program on this desktop.
    pub fn on(&self, mut command: Command) -> Command {
        command
            .env("XDG_RUNTIME_DIR", self.folder.path())
            .env("WAYLAND_DISPLAY", &self.name)
            .env_remove("DISPLAY");
        command
    }

    /// Gives sway an order.
    pub fn order(&self, words: &str) {
        let mut command = Command::new("swaymsg");
        command.arg("-s").arg(&self.orders).arg(words).stdout(Stdio::null());
        let done = self.on(command).status();
        assert!(done.is_ok_and(|status| status.success()), "swaymsg {words}");
    }

    /// The windows of lightloom there, by the desktop's numbers.
    pub fn windows(&self) -> BTreeSet<u64> {
        let mut command = Command::new("swaymsg");
        command.arg("-s").arg(&self.orders).args(["-r", "-t", "get_tree"]);
        let told = self.on(command).output().expect("it comes with sway").stdout;
        let tree: Value = serde_json::from_slice(&told).expect("the tree is JSON");
        let (mut windows, mut left) = (BTreeSet::new(), vec![&tree]);
        while let Some(node) = left.pop() {
            if node["app_id"] == "lightloom" {
                windows.extend(node["id"].as_u64());
            }
            left.extend(["nodes", "floating_nodes"].iter().filter_map(|of| node[of].as_array()).flatten());
        }
        windows
    }

    /// Takes an output away: closes its window on the X server.
    pub fn unplug(&self, server: &XServer, output: &str) {
        close_window_of(server, output).expect("the X server answers");
    }

    /// What is to be seen on an output: its width, and 0x00RRGGBB by rows. None where there is no such output.
    pub fn pixels(&self, output: &str) -> Option<(usize, Vec<u32>)> {
        let mut command = Command::new("grim");
        command.args(["-o", output, "-t", "png", "-"]).stderr(Stdio::null());
        let taken = self.on(command).output().expect("it is on the path");
        let picture = image::load_from_memory(&taken.stdout).ok()?.to_rgb8();
        Some((picture.width() as usize, packed(&picture)))
    }

    /// Looks until what is wanted is to be seen, and fails if it is not within a while.
    #[track_caller]
    pub fn wait_for(&self, what: &str, is_there: impl Fn(&Self) -> bool) {
        machine::wait_for(what, || is_there(self));
    }
}

/// Asks the window that is an output to close.
fn close_window_of(server: &XServer, output: &str) -> Result<(), ReplyError> {
    let XServer { connection, root, .. } = server;
    let name = atom(server, "_NET_WM_NAME")?;
    let is_its = |window: u32| -> Result<bool, ReplyError> {
        let title = connection.get_property(false, window, name, AtomEnum::ANY, 0, 64)?;
        Ok(title.reply()?.value.ends_with(output.as_bytes()))
    };
    let leave = [atom(server, "WM_DELETE_WINDOW")?, 0, 0, 0, 0];
    for window in connection.query_tree(*root)?.reply()?.children {
        if is_its(window)? {
            let message = ClientMessageEvent::new(32, window, atom(server, "WM_PROTOCOLS")?, leave);
            connection.send_event(false, window, EventMask::NO_EVENT, message)?.check()?;
        }
    }
    Ok(())
}

fn atom(server: &XServer, name: &str) -> Result<Atom, ReplyError> {
    Ok(server.connection.intern_atom(false, name.as_bytes())?.reply()?.atom)
}

impl Drop for WaylandDesktop {
    fn drop(&mut self) {
        let _ = self.sway.kill();
        let _ = self.sway.wait();
    }
}
