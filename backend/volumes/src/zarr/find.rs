//! From a Zarr folder to the image in it.

use super::super::Selection;
use super::super::choice::no_series;
use super::image::Image;
use super::node::Node;
use bricks::volume::VolumeError;
use std::path::{Path, PathBuf};

/// Entries of a folder that are looked at, and images that are listed.
const MOST_ENTRIES: usize = 10_000;
const MOST_LISTED: usize = 20;

/// The image or array in a folder; of a folder of images (as bioformats2raw writes them) the only one, or the one
/// that [`Selection::series`] names: its folder's name, or its number from 1.
pub(super) fn image(path: &Path, selection: &Selection) -> Result<Image, VolumeError> {
    let node = Node::read(path)?.ok_or_else(|| VolumeError::unsupported(path, "it is not a Zarr folder"))?;
    if node.shape.is_some() {
        no_series(path, selection.series.as_deref())?;
        return Image::of_array(path, &node);
    }
    if node.is_image() {
        return Image::of_group(path, &node, selection.series.as_deref());
    }
    let children = children(path)?;
    let images: Vec<_> = children.iter().filter(|(_, child)| child.is_image()).collect();
    let chosen = match (&images[..], &selection.series) {
        ([], _) => return Err(no_image(path, &node, &children)),
        ([only], None) => Some(*only),
        (_, None) => None,
        (_, Some(series)) => chosen(&images, series),
    };
    match chosen {
        Some((folder, child)) => Image::of_group(folder, child, None),
        None => Err(VolumeError::unsupported(
            path,
            format!(
                "it holds {} images, {}: give the folder of one of them, such as {}",
                images.len(),
                names(images.iter().map(|(folder, _)| folder)),
                images[0].0.display()
            ),
        )),
    }
}

fn chosen<'a>(images: &[&'a (PathBuf, Node)], series: &str) -> Option<&'a (PathBuf, Node)> {
    let by_name = images.iter().find(|(folder, _)| folder.file_name().is_some_and(|name| name == series));
    let by_number = || images.get(series.parse::<usize>().ok()?.checked_sub(1)?);
    by_name.or_else(by_number).copied()
}

/// The groups and arrays directly below a folder, in the order of their numbers and names.
fn children(path: &Path) -> Result<Vec<(PathBuf, Node)>, VolumeError> {
    let entries = std::fs::read_dir(path).map_err(VolumeError::open(path))?;
    let mut folders: Vec<PathBuf> =
        entries.take(MOST_ENTRIES).flatten().map(|entry| entry.path()).filter(|path| path.is_dir()).collect();
    folders.sort_by_cached_key(|folder| {
        let name = folder.file_name().unwrap_or_default().to_string_lossy().into_owned();
        (name.parse().unwrap_or(u64::MAX), name)
    });
    // A child that cannot be read is not a choice, nor a reason to skip the others.
    let read = |folder: PathBuf| Node::read(&folder).ok().flatten().map(|node| (folder, node));
    Ok(folders.into_iter().filter_map(read).collect())
}

fn no_image(path: &Path, node: &Node, children: &[(PathBuf, Node)]) -> VolumeError {
    let arrays: Vec<_> = children.iter().filter(|(_, child)| child.shape.is_some()).collect();
    let what = if node.ome()["plate"].is_object() {
        "it is a plate of many images: give the folder of one of them, such as A/1/0 below it".to_owned()
    } else if arrays.is_empty() {
        "it holds neither an image (`multiscales`) nor arrays: give the folder of an image or an array"
            .to_owned()
    } else {
        let names = names(arrays.iter().map(|(folder, _)| folder));
        format!("it is a group without an image (`multiscales`): give one of its arrays, {names}")
    };
    VolumeError::unsupported(path, what)
}

fn names<'a>(folders: impl Iterator<Item = &'a PathBuf>) -> String {
    let names: Vec<_> = folders
        .take(MOST_LISTED)
        .map(|folder| folder.file_name().unwrap_or_default().to_string_lossy().into_owned())
        .collect();
    names.join(", ")
}
