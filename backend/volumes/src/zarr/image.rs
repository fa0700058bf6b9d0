//! An image of several levels as OME-Zarr describes it, or a bare array as an image of one.

use super::axes::Axes;
use super::node::Node;
use bricks::volume::VolumeError;
use serde_json::Value;
use std::path::{Component, Path, PathBuf};

/// Images that a sentence lists.
const MOST_LISTED: usize = 20;

/// An image.
pub(super) struct Image {
    /// The group or array.
    pub folder: PathBuf,
    /// Finest first; at least one.
    pub levels: Vec<Level>,
    /// None if it has to follow from the array's number of dimensions.
    pub axes: Option<Axes>,
    /// Names of the channels, where they have any.
    pub channels: Vec<String>,
}

/// One resolution of an image.
pub(super) struct Level {
    /// The array's folder below the image's; empty if they are the same.
    pub path: String,
    /// Units from a voxel to the next one, and place of the first one, for each dimension; None if nothing is said.
    pub placement: Option<Placement>,
}

/// A scaling and then a translation, for each dimension.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Placement {
    pub scale: Vec<f64>,
    pub translation: Vec<f64>,
}

impl Image {
    /// An array alone.
    pub fn of_array(folder: &Path, node: &Node) -> Result<Self, VolumeError> {
        let names = &node.dimension_names;
        let is_named = names.as_array().is_some_and(|names| names.iter().all(Value::is_string));
        let axes = is_named.then(|| Axes::from_json(folder, names)).transpose()?;
        let level = Level { path: String::new(), placement: None };
        Ok(Self { folder: folder.into(), levels: vec![level], axes, channels: Vec::new() })
    }

    /// An image of a group: the only one, or the one of that number (from 1) or name.
    pub fn of_group(folder: &Path, node: &Node, series: Option<&str>) -> Result<Self, VolumeError> {
        let ome = node.ome();
        let image = chosen(folder, &ome["multiscales"], series)?;
        let axes = Some(&image["axes"]).filter(|axes| !axes.is_null());
        let axes = axes.map(|axes| Axes::from_json(folder, axes)).transpose()?;
        let whole = placement(folder, &image["coordinateTransformations"])?;
        let datasets = image["datasets"].as_array().filter(|list| !list.is_empty());
        let datasets =
            datasets.ok_or_else(|| VolumeError::header(folder, "its image has no list of `datasets`"))?;
        let level = |dataset| level(folder, dataset, whole.as_ref());
        let levels = datasets.iter().map(level).collect::<Result<_, _>>()?;
        let channels = ome["omero"]["channels"].as_array().into_iter().flatten();
        let channels = channels.map(|channel| channel["label"].as_str().unwrap_or_default().to_owned());
        Ok(Self { folder: folder.into(), levels, axes, channels: channels.collect() })
    }

    /// Folder of a level's array.
    pub fn level_folder(&self, level: &Level) -> PathBuf {
        match level.path.as_str() {
            // Joined with nothing, the folder would end in a slash.
            "" => self.folder.clone(),
            path => self.folder.join(path),
        }
    }

    /// The levels with their sizes, for a sentence.
    pub fn listing(&self) -> String {
        let size = |level: &Level| {
            let node = Node::read(&self.level_folder(level)).ok().flatten();
            match node.and_then(|node| node.shape) {
                Some(shape) => shape.iter().map(u64::to_string).collect::<Vec<_>>().join(" × "),
                None => "unreadable".to_owned(),
            }
        };
        let levels = self.levels.iter().enumerate().map(|(k, level)| format!("{k} ({})", size(level)));
        levels.collect::<Vec<_>>().join(", ")
    }
}

/// Of several images that one group describes, the chosen one.
fn chosen<'a>(folder: &Path, images: &'a Value, series: Option<&str>) -> Result<&'a Value, VolumeError> {
    let images = images.as_array().map_or(&[][..], Vec::as_slice);
    let name = |image: &'a Value| image["name"].as_str();
    if let ([only], None) = (images, series) {
        return Ok(only);
    }
    let by_name = || images.iter().find(|image| series.is_some() && name(image) == series);
    let by_number = || images.get(series?.trim().parse::<usize>().ok()?.checked_sub(1)?);
    by_name().or_else(by_number).ok_or_else(|| {
        let list = images.iter().enumerate().take(MOST_LISTED);
        let list = list.map(|(i, image)| format!("{} ({})", i + 1, name(image).unwrap_or("without a name")));
        let list = list.collect::<Vec<_>>().join(", ");
        let what = format!(
            "it holds {} images, {list}: choose one as a series, by its number or name",
            images.len()
        );
        VolumeError::unsupported(folder, what)
    })
}

fn level(folder: &Path, dataset: &Value, whole: Option<&Placement>) -> Result<Level, VolumeError> {
    let path = dataset["path"].as_str().unwrap_or_default().trim_matches('/').to_owned();
    // A path that leads out of the folder would expose other files.
    let is_inside = Path::new(&path).components().all(|part| matches!(part, Component::Normal(_)));
    if !is_inside {
        return Err(VolumeError::header(folder, format!("the path `{path}` of a level leads out of it")));
    }
    let own = placement(folder, &dataset["coordinateTransformations"])?;
    let placement = match (own, whole) {
        (Some(own), Some(whole)) => Some(own.then(folder, whole)?),
        (own, whole) => own.or_else(|| whole.cloned()),
    };
    Ok(Level { path, placement })
}

impl Placement {
    fn then(self, folder: &Path, next: &Self) -> Result<Self, VolumeError> {
        if self.scale.len() != next.scale.len() {
            return Err(VolumeError::header(folder, "its transformations have different lengths"));
        }
        let along = |i: usize| self.translation[i] * next.scale[i] + next.translation[i];
        let translation = (0..self.scale.len()).map(along).collect();
        let scale = self.scale.iter().zip(&next.scale).map(|(own, next)| own * next).collect();
        Ok(Self { scale, translation })
    }
}

/// A list of transformations, the first of them applied first.
fn placement(folder: &Path, json: &Value) -> Result<Option<Placement>, VolumeError> {
    let mut placement: Option<Placement> = None;
    for transformation in json.as_array().into_iter().flatten() {
        let Some(step) = step(folder, transformation)? else { continue };
        placement = Some(match placement {
            None => step,
            Some(before) => before.then(folder, &step)?,
        });
    }
    Ok(placement)
}

/// One transformation; None if it does nothing.
fn step(folder: &Path, json: &Value) -> Result<Option<Placement>, VolumeError> {
    let numbers = |key: &str| {
        let list = json[key].as_array().and_then(|list| list.iter().map(Value::as_f64).collect());
        list.ok_or_else(|| VolumeError::header(folder, format!("a transformation lacks its list `{key}`")))
    };
    match json["type"].as_str() {
        Some("identity") => Ok(None),
        Some("scale") => {
            let scale: Vec<f64> = numbers("scale")?;
            let translation = vec![0.0; scale.len()];
            Ok(Some(Placement { scale, translation }))
        }
        Some("translation") => {
            let translation: Vec<f64> = numbers("translation")?;
            let scale = vec![1.0; translation.len()];
            Ok(Some(Placement { scale, translation }))
        }
        _ => Err(VolumeError::unsupported(
            folder,
            format!("it has a transformation of type {}; only scale and translation are read", json["type"]),
        )),
    }
}
