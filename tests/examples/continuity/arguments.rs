//! The arguments of the study.

use protocol::DeviceChoice;
use std::path::PathBuf;

const USAGE: &str = "give [-o DIR] [--fade S] [--blended true|false] [--frames N] [--raster WxH] \
                     [--volume shells|octaves] [--edge N] [--upload-mib N] [--gpu] [--fades S,S,...]";
/// See [`lightloom_tests::motion::continuity`].
const LEAST_FRAMES: u32 = 4;

/// What to measure, and how.
pub struct Arguments {
    /// The folder for pictures.
    pub out: Option<PathBuf>,
    /// Seconds that detail takes to come.
    pub fade_s: f64,
    /// The same, for cold starts alone.
    pub fades_s: Vec<f64>,
    /// Only with blending, or only without.
    pub blended: Option<bool>,
    /// Frames of a sequence.
    pub frames: u32,
    /// Width and height, pixels.
    pub raster: (u32, u32),
    /// Shells, or octaves.
    pub has_shells: bool,
    /// Voxels along an edge.
    pub edge: u32,
    /// Most that a frame uploads.
    pub upload_mib: u64,
    /// What draws.
    pub device: DeviceChoice,
}

/// Those of this process.
pub fn arguments() -> Result<Arguments, String> {
    let mut found = Arguments {
        out: None,
        fade_s: 0.5,
        fades_s: Vec::new(),
        blended: None,
        frames: 61,
        raster: (320, 240),
        has_shells: true,
        edge: 4096,
        upload_mib: 8,
        device: DeviceChoice::Cpu,
    };
    let mut arguments = std::env::args().skip(1);
    while let Some(flag) = arguments.next() {
        if flag == "--gpu" {
            found.device = DeviceChoice::Gpu;
            continue;
        }
        let value = arguments.next().ok_or_else(|| format!("`{flag}` needs a value; {USAGE}"))?;
        let wrong = || format!("`{flag} {value}` makes no sense; {USAGE}");
        match flag.as_str() {
            "-o" => found.out = Some(PathBuf::from(&value)),
            "--fade" => found.fade_s = value.parse().map_err(|_| wrong())?,
            "--fades" => {
                let fades: Result<Vec<f64>, _> = value.split(',').map(str::parse).collect();
                found.fades_s = fades.map_err(|_| wrong())?;
            }
            "--blended" => found.blended = Some(value.parse().map_err(|_| wrong())?),
            "--frames" => found.frames = value.parse().map_err(|_| wrong())?,
            "--volume" => {
                found.has_shells = match value.as_str() {
                    "shells" => true,
                    "octaves" => false,
                    _ => return Err(wrong()),
                }
            }
            "--edge" => found.edge = value.parse().map_err(|_| wrong())?,
            "--upload-mib" => found.upload_mib = value.parse().map_err(|_| wrong())?,
            "--raster" => {
                let (width, height) = value.split_once('x').ok_or_else(wrong)?;
                found.raster = (width.parse().map_err(|_| wrong())?, height.parse().map_err(|_| wrong())?);
            }
            _ => return Err(format!("`{flag}` is unknown; {USAGE}")),
        }
    }
    if !found.has_shells && !found.fades_s.is_empty() {
        return Err("`--fades` measures surfaces, and octaves have none: leave one of them out".to_owned());
    }
    if found.frames < LEAST_FRAMES {
        return Err(format!(
            "`--frames` must be at least {LEAST_FRAMES}: a pop is told from so many pictures"
        ));
    }
    Ok(found)
}
