//! What the metadata files of a Zarr folder say: a group or an array, and its attributes.

use bricks::volume::{VolumeError, open_file};
use serde_json::Value;
use std::io::Read;
use std::path::Path;

/// The files that make a folder Zarr: of version 3 the first, of version 2 the others.
pub(super) const METADATA_FILES: [&str; 4] = ["zarr.json", ".zarray", ".zgroup", ".zattrs"];
/// Consolidated metadata of large hierarchies have some megabytes; anything larger is not metadata.
const MOST_METADATA_BYTES: u64 = 64 << 20;

/// A group or an array.
pub(super) struct Node {
    /// What users and conventions say of it; `null` where they say nothing.
    pub attributes: Value,
    /// Of an array: its sizes, slowest first.
    pub shape: Option<Vec<u64>>,
    /// Of an array of version 3: the names of its axes, where they have any.
    pub dimension_names: Value,
}

impl Node {
    /// The node in a folder; None if the folder is not Zarr.
    pub fn read(folder: &Path) -> Result<Option<Self>, VolumeError> {
        if let Some(mut json) = read_json(folder, METADATA_FILES[0])? {
            let attributes = json["attributes"].take();
            let shape = (json["node_type"] == "array").then(|| sizes(folder, &json["shape"])).transpose()?;
            return Ok(Some(Self { attributes, shape, dimension_names: json["dimension_names"].take() }));
        }
        let attributes = read_json(folder, ".zattrs")?;
        let array = read_json(folder, ".zarray")?;
        if array.is_none() && attributes.is_none() && !folder.join(".zgroup").is_file() {
            return Ok(None);
        }
        let shape = array.map(|json| sizes(folder, &json["shape"])).transpose()?;
        let attributes = attributes.unwrap_or_default();
        Ok(Some(Self { attributes, shape, dimension_names: Value::Null }))
    }

    /// What OME-Zarr says of it: version 0.5 has a place of its own among the attributes, 0.4 has not.
    pub fn ome(&self) -> &Value {
        match &self.attributes["ome"] {
            Value::Null => &self.attributes,
            ome => ome,
        }
    }

    /// Whether it is a group with an image.
    pub fn is_image(&self) -> bool {
        self.ome()["multiscales"].as_array().is_some_and(|images| !images.is_empty())
    }
}

fn read_json(folder: &Path, name: &str) -> Result<Option<Value>, VolumeError> {
    let path = folder.join(name);
    if !path.is_file() {
        return Ok(None);
    }
    let mut text = Vec::new();
    let file = open_file(&path).map_err(VolumeError::open(&path))?;
    file.take(MOST_METADATA_BYTES).read_to_end(&mut text).map_err(VolumeError::read(&path))?;
    let json: Value = serde_json::from_slice(&text)
        .map_err(|error| VolumeError::header(&path, format!("it is not JSON: {error}")))?;
    match json.is_object() {
        true => Ok(Some(json)),
        false => Err(VolumeError::header(&path, "it is not a JSON object")),
    }
}

fn sizes(folder: &Path, json: &Value) -> Result<Vec<u64>, VolumeError> {
    let list = json.as_array().and_then(|list| list.iter().map(Value::as_u64).collect());
    list.ok_or_else(|| VolumeError::header(folder, format!("`shape` is {json}, and must be a list of sizes")))
}
