//! The video outputs of an X server, as its RandR extension tells them.

use super::edid::product_name;
use crate::{Mode, OutputInfo, Rectangle, ScreenError};
use std::collections::HashMap;
use x11rb::connection::{Connection, RequestConnection};
use x11rb::protocol::randr::{self, ConnectionExt as _};
use x11rb::protocol::xproto::{AtomEnum, ConnectionExt as _, Window};
use x11rb::rust_connection::RustConnection;

/// A block of EDID has 128 bytes, in words of 4.
const EDID_WORDS: u32 = 32;

/// The outputs of the X server that DISPLAY names.
///
/// # Errors
/// There is no such server, or it cannot tell.
pub fn outputs() -> Result<Vec<OutputInfo>, ScreenError> {
    let (connection, root) = connect()?;
    read(&connection, root)
}

/// A connection to the X server that DISPLAY names, with the root of its screen.
pub(crate) fn connect() -> Result<(RustConnection, Window), ScreenError> {
    let connected = x11rb::connect(None).map_err(|error| ScreenError::NoServer(error.to_string()));
    let (connection, screen) = connected?;
    let root = connection.setup().roots[screen].root;
    Ok((connection, root))
}

/// The outputs of a connected server.
pub(crate) fn read(connection: &RustConnection, root: Window) -> Result<Vec<OutputInfo>, ScreenError> {
    let is_there = connection.extension_information(randr::X11_EXTENSION_NAME)?.is_some();
    // Outputs came with version 1.2, and the call that does not probe them anew, which takes seconds, with 1.3.
    let version = if is_there { Some(connection.randr_query_version(1, 3)?.reply()?) } else { None };
    if version.is_none_or(|version| (version.major_version, version.minor_version) < (1, 3)) {
        return Err(ScreenError::Server {
            what: "RandR 1.3, so its outputs cannot be told apart",
            advice: "leave the names of outputs out of the display file, and give places on the desktop",
        });
    }
    let resources = connection.randr_get_screen_resources_current(root)?.reply()?;
    let modes: HashMap<u32, Mode> = resources.modes.iter().map(|mode| (mode.id, mode_of(mode))).collect();
    let edid = connection.intern_atom(false, b"EDID")?.reply()?.atom;
    let mut outputs = Vec::with_capacity(resources.outputs.len());
    for &id in &resources.outputs {
        let info = connection.randr_get_output_info(id, resources.config_timestamp)?.reply()?;
        let block = connection.randr_get_output_property(
            id,
            edid,
            u32::from(AtomEnum::ANY),
            0,
            EDID_WORDS,
            false,
            false,
        )?;
        let shows = match info.crtc {
            0 => None,
            crtc => Some(connection.randr_get_crtc_info(crtc, resources.config_timestamp)?.reply()?),
        };
        outputs.push(OutputInfo {
            connector: String::from_utf8_lossy(&info.name).into_owned(),
            is_connected: info.connection == randr::Connection::CONNECTED,
            product: product_name(&block.reply()?.data),
            shows: shows.and_then(|crtc| {
                let rectangle = Rectangle { x: crtc.x, y: crtc.y, width: crtc.width, height: crtc.height };
                Some((rectangle, *modes.get(&crtc.mode)?))
            }),
            modes: info.modes.iter().filter_map(|mode| modes.get(mode).copied()).collect(),
        });
    }
    Ok(outputs)
}

/// Pictures per second are dots per second over dots of a picture, blanking included; some servers have no dots.
fn mode_of(mode: &randr::ModeInfo) -> Mode {
    let dots = f64::from(mode.htotal) * f64::from(mode.vtotal);
    let rate_hz = if dots > 0.0 { f64::from(mode.dot_clock) / dots } else { 0.0 };
    Mode { width: mode.width, height: mode.height, rate_hz }
}
