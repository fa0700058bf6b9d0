//! The keys of each kind of input.

use super::entry::Entry;
use crate::calibration::transform;
use crate::datagrams::Port;
use crate::error::InputError;
use crate::input::{Input, Kind};
use crate::script::{RawScript, Script};
use display_config::text::{brief_text, did_you_mean, read_text};
use std::net::{Ipv4Addr, SocketAddr, SocketAddrV4};
use std::path::{Path, PathBuf};
use tracking::RigidTransform;

/// Kinds, each with its own keys.
const KINDS: [(&str, &[&str]); 8] = [
    ("vrpn", &["name", "kind", "calibration", "address", "device", "udp"]),
    ("dtrack", &["name", "kind", "calibration", "listen"]),
    ("osc", &["name", "kind", "calibration", "listen"]),
    ("opentrackio", &["name", "kind", "calibration", "listen", "source", "interface", "port"]),
    ("freed", &["name", "kind", "calibration", "listen"]),
    ("gamepad", &["name", "kind", "path"]),
    ("spacemouse", &["name", "kind", "path"]),
    ("script", &["name", "kind", "calibration", "path"]),
];
/// Where VRPN servers listen if nothing else is said.
const VRPN_PORT: u16 = 3883;
/// Where OpenTrackIO's sources send.
const OPENTRACKIO_PORT: u16 = 55_555;
const GAMEPAD: &str = "/dev/input/js0";
const SPACENAVD: &str = "/var/run/spnav.sock";

/// The input of an entry. Files that it names lie in a folder.
pub(super) fn input(entry: &Entry<'_>, folder: &Path) -> Result<Input, InputError> {
    let kind = entry.text("kind")?;
    let names = KINDS.map(|(name, _)| name);
    let Some((_, keys)) = KINDS.iter().find(|(name, _)| *name == kind) else {
        let suggestion = did_you_mean(kind, names);
        return Err(entry.wrong_name("kind", suggestion, format!("one of {}", names.join(", "))));
    };
    entry.has_only(&format!("kind {kind}"), keys)?;
    let kind = match kind {
        "vrpn" => vrpn(entry)?,
        "dtrack" => Kind::Dtrack(listen(entry)?),
        "osc" => Kind::Osc(listen(entry)?),
        "freed" => Kind::Freed(listen(entry)?),
        "opentrackio" => Kind::OpenTrackIo(opentrackio(entry)?),
        "gamepad" => Kind::Gamepad(entry.optional_text("path")?.unwrap_or(GAMEPAD).into()),
        "spacemouse" => Kind::Spacemouse(entry.optional_text("path")?.unwrap_or(SPACENAVD).into()),
        _ => script(entry, folder)?,
    };
    let display_from_tracker = calibration(entry, folder)?;
    Ok(Input { name: entry.text("name")?.to_owned(), kind, display_from_tracker })
}

fn calibration(entry: &Entry<'_>, folder: &Path) -> Result<Option<RigidTransform>, InputError> {
    let Some(path) = entry.optional_text("calibration")?.map(|path| folder.join(path)) else {
        return Ok(None);
    };
    let text = read_text(&path).map_err(|error| error.to_string());
    let wrong =
        |message| InputError::Calibration { place: entry.place("calibration"), path: path.clone(), message };
    text.and_then(|text| transform(&text)).map(Some).map_err(wrong)
}

fn vrpn(entry: &Entry<'_>) -> Result<Kind, InputError> {
    let (address, device) = (entry.text("address")?, entry.text("device")?);
    let address = if address.contains(':') { address.to_owned() } else { format!("{address}:{VRPN_PORT}") };
    let is_address = address.rsplit_once(':').is_some_and(|(host, port)| {
        !host.is_empty() && !host.contains([' ', '/', '@']) && port.parse::<u16>().is_ok_and(|port| port > 0)
    });
    if !is_address {
        return Err(entry.wrong("address", "the server's host, or host and port, such as \"tracker:3883\""));
    }
    Ok(Kind::Vrpn { address, device: device.to_owned(), takes_datagrams: entry.flag("udp")? })
}

/// An address of this host and a port.
fn listen(entry: &Entry<'_>) -> Result<Port, InputError> {
    let expected = "an address of this host and a port, such as \"127.0.0.1:5000\", or \"0.0.0.0:5000\" for all of its \
                    networks";
    let address: SocketAddr = entry.parsed("listen", expected)?;
    if address.port() == 0 { Err(entry.wrong("listen", expected)) } else { Ok(Port::Own(address)) }
}

fn opentrackio(entry: &Entry<'_>) -> Result<Port, InputError> {
    if entry.has("listen") {
        return match ["source", "interface", "port"].into_iter().find(|key| entry.has(key)) {
            Some(other) => Err(InputError::TwoKeys { place: entry.place("listen"), other }),
            None => listen(entry),
        };
    }
    let source: u8 = entry.whole("source", 1..=200)?;
    let port = if entry.has("port") { entry.whole("port", 1..=u16::MAX)? } else { OPENTRACKIO_PORT };
    let interface = match entry.has("interface") {
        true => entry.parsed("interface", "the IPv4 address of this host on the sender's network")?,
        false => Ipv4Addr::LOCALHOST,
    };
    Ok(Port::Group(SocketAddrV4::new(Ipv4Addr::new(239, 135, 1, source), port), interface))
}

fn script(entry: &Entry<'_>, folder: &Path) -> Result<Kind, InputError> {
    let path: PathBuf = folder.join(entry.text("path")?);
    let script = read_text(&path).map_err(|error| format!("{error}; give the path of a readable .toml file"));
    let script = script.and_then(|text| {
        let raw = toml::from_str::<RawScript>(&text);
        let raw = raw.map_err(|error| {
            let line = super::entry::line(&text, error.span().map_or(0, |span| span.start));
            format!("line {line}: {}", brief_text(error.message()))
        })?;
        Script::try_from(raw)
    });
    script.map(Kind::Script).map_err(|message| InputError::Script {
        place: entry.place("path"),
        path,
        message,
    })
}
