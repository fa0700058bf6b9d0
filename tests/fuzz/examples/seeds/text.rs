//! Seeds of the target that reads what people write: the files that the program brings along.

use std::error::Error;
use std::fs;
use std::path::Path;

/// Where they lie, and what `text` reads them as.
const FOLDERS: [(u8, &str); 4] = [
    (0, "display-config/presets"),
    (1, "frontend/exhibit/examples"),
    (2, "frontend/inputs/examples"),
    (2, "frontend/exhibit/examples"),
];

const LINE: &str = "name = \"a\"\nscreen_width_m = 0.4\nscreen_height_m = 0.3\npixel_size_m = 0.001\n\
    angular_accuracy_deg = 0.5\nobserver_m = [0, 0, 1]\neta = 1\n[projector_line]\ncount = 3\nfrom_m = [-1, 0, -1]\n\
    to_m = [1, 0, -1]\nwidth_px = 64\nheight_px = 48\ncovers = \"screen\"\nbackends = 2\n";

/// Every such file.
pub fn files(out: &Path) -> Result<(), Box<dyn Error>> {
    for (number, (kind, folder)) in FOLDERS.into_iter().enumerate() {
        for entry in fs::read_dir(folder)? {
            let path = entry?.path();
            let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
            fs::write(out.join(format!("{number}_{name}")), [vec![kind], fs::read(&path)?].concat())?;
        }
    }
    Ok(fs::write(out.join("line"), [b"\x00", LINE.as_bytes()].concat())?)
}
