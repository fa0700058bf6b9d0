//! The file of a mesh: text.

use crate::finish::{MOST_MESH_ALONG, MapFault, Mesh};
use crate::text::read_text;
use glam::Vec2;
use std::path::Path;

/// `mesh COLUMNS ROWS`, then x and y of each point; `#` begins a comment.
pub(super) fn read(path: &Path) -> Result<Mesh, MapFault> {
    let text = read_text(path).map_err(MapFault::Read)?;
    let mut lines = text.lines().enumerate().map(|(at, line)| (at + 1, without_comment(line)));
    let head = lines.find(|(_, line)| !line.is_empty()).map_or("", |(_, line)| line);
    let [columns, rows] = size(head).ok_or(MapFault::MeshHead)?;
    let mut numbers = Vec::with_capacity(2 * columns as usize * rows as usize);
    for (line, words) in lines {
        let read = |word: &str| word.parse().ok().filter(|number: &f32| number.is_finite());
        for word in words.split_whitespace() {
            numbers.push(read(word).ok_or(MapFault::MeshNumber { line })?);
        }
    }
    if numbers.len() != 2 * columns as usize * rows as usize {
        return Err(MapFault::MeshCount { found: numbers.len(), columns, rows });
    }
    Mesh::new(columns, rows, numbers.chunks_exact(2).map(Vec2::from_slice).collect())
}

fn without_comment(line: &str) -> &str {
    line.split('#').next().unwrap_or_default().trim()
}

/// Columns and rows.
fn size(head: &str) -> Option<[u32; 2]> {
    let words: Vec<&str> = head.split_whitespace().collect();
    let ["mesh", columns, rows] = words[..] else { return None };
    let along = |word: &str| word.parse().ok().filter(|along| (2..=MOST_MESH_ALONG).contains(along));
    Some([along(columns)?, along(rows)?])
}
