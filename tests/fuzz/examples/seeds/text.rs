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

/// Every such file.
pub fn files(out: &Path) -> Result<(), Box<dyn Error>> {
    for (number, (kind, folder)) in FOLDERS.into_iter().enumerate() {
        for entry in fs::read_dir(folder)? {
            let path = entry?.path();
            let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
            fs::write(out.join(format!("{number}_{name}")), [vec![kind], fs::read(&path)?].concat())?;
        }
    }
    Ok(())
}
