//! Builds a store, opens it, and reads one brick: `cargo run --release -p frontend --example minimal_store -- DIR`.

use bricks::store::Store;
use bricks::{Brick, BrickSource, NodeKey, OVERLAP};
use glam::UVec3;
use std::error::Error;
use std::path::{Path, PathBuf};
use volumes::{ImportOptions, Selection, import};

fn main() -> Result<(), Box<dyn Error>> {
    let folder = PathBuf::from(std::env::args().nth(1).unwrap_or_else(|| ".".to_owned()));
    let path = folder.join("shells.lloom");

    // The input may be any file that `lightloom import` reads. A built-in volume needs none.
    let options = ImportOptions { procedural_dims: UVec3::splat(64), ..ImportOptions::default() };
    let input = Path::new("procedural:shells");
    let report = import(input, &Selection::default(), &path, &options, &|_, _| {})?;
    println!("{} of {} bricks take {} bytes", report.stored_bricks, report.nodes, report.store_bytes);
    println!("RMS error {:.5}, largest {:.5}", report.rms_error, report.max_error);

    // Opening reads only the header. Bricks are read, and checked, one by one.
    let store = Store::open(&path)?;
    let shape = store.shape();
    println!("{} voxels, finest depth {}", shape.dims(), shape.finest_depth());

    // Depth 0 is the root: the whole volume in one brick. Bits x, y, z of an octant choose a child.
    let node = NodeKey::ROOT.child(0);
    let summary = store.summary(node);
    println!("node {node}: values from {:.3} to {:.3}", summary.min, summary.max);
    let brick = store.brick(node)?;
    // A brick holds 32³ samples, of which the outer two on each side belong to its neighbours.
    let first_own = Brick::index(OVERLAP, OVERLAP, OVERLAP);
    println!("its first voxel is {:.3}", brick.value(first_own));
    Ok(())
}
