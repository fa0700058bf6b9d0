//! Loader threads: they fetch and unpack bricks while others wait or work.

use crate::store::{BRICK_VOXELS, BrickError, BrickSource, CellRanges, Codes, NodeKey};
use crossbeam_channel::{Receiver, Sender, unbounded};
use std::sync::Arc;
use std::thread::JoinHandle;

/// A brick as a device's cache holds it.
#[derive(Clone, Debug)]
pub struct LoadedBrick {
    /// 32³ samples; 65535 stands for 1. 8-bit codes are spread over the same range without loss.
    pub samples: Vec<u16>,
    /// Range of the samples around each of the 8³ cells.
    pub cells: CellRanges,
    /// Data value of sample 0.
    pub low: f64,
    /// Data value of sample 65535, less `low`.
    pub span: f64,
    /// Bytes of the codes as the store held them, decoded.
    pub bytes: u64,
}

/// A node, and its brick or why it cannot be had.
pub type Fetched = (NodeKey, Result<LoadedBrick, BrickError>);

/// A few threads that read bricks.
#[derive(Debug)]
pub struct Loader {
    requests: Option<Sender<NodeKey>>,
    results: Receiver<Fetched>,
    threads: Vec<JoinHandle<()>>,
}

impl Loader {
    /// Starts `threads` threads that read from `source`.
    pub fn new(source: Arc<dyn BrickSource>, threads: usize) -> Self {
        let (requests, inbox) = unbounded::<NodeKey>();
        let (outbox, results) = unbounded();
        let threads = (0..threads.max(1))
            .map(|_| {
                let (source, inbox, outbox) = (Arc::clone(&source), inbox.clone(), outbox.clone());
                std::thread::spawn(move || {
                    for key in inbox {
                        if outbox.send((key, load(&*source, key))).is_err() {
                            return;
                        }
                    }
                })
            })
            .collect();
        Self { requests: Some(requests), results, threads }
    }

    /// Fetches bricks, in any order of arrival, and hands each, or why it cannot be had, to `arrived`.
    ///
    /// # Errors
    /// The threads ended before their time.
    pub fn fetch(&self, keys: &[NodeKey], mut arrived: impl FnMut(Fetched)) -> Result<(), BrickError> {
        let requests = self.requests.as_ref().expect("requests end only when the loader is dropped");
        for &key in keys {
            requests.send(key).map_err(|_| lost())?;
        }
        for _ in keys {
            arrived(self.results.recv().map_err(|_| lost())?);
        }
        Ok(())
    }
}

fn lost() -> BrickError {
    BrickError("a loader thread ended before its time; start the program again".into())
}

impl Drop for Loader {
    fn drop(&mut self) {
        self.requests = None;
        for thread in self.threads.drain(..) {
            // A thread that panicked has said so itself.
            let _ = thread.join();
        }
    }
}

fn load(source: &dyn BrickSource, key: NodeKey) -> Result<LoadedBrick, BrickError> {
    // A reader's panic must not leave the others waiting for this brick.
    let brick = std::panic::catch_unwind(std::panic::AssertUnwindSafe(|| source.brick(key)))
        .unwrap_or_else(|_| Err(BrickError(format!("reading brick {key:?} failed inside the program"))))?;
    let largest = f64::from(brick.codes.largest());
    let factor = u16::MAX / brick.codes.largest();
    let cells = brick.cells.unwrap_or_else(|| CellRanges::of(&brick.codes)).scaled(factor);
    let (samples, bytes) = match brick.codes {
        Codes::U8(codes) => {
            let bytes = codes.len() as u64;
            (codes.into_iter().map(|code| u16::from(code) * factor).collect(), bytes)
        }
        Codes::U16(codes) => {
            let bytes = 2 * codes.len() as u64;
            (codes, bytes)
        }
    };
    let samples: Vec<u16> = samples;
    if samples.len() != BRICK_VOXELS {
        return Err(BrickError(format!(
            "brick {key:?} has {} samples instead of {BRICK_VOXELS}",
            samples.len()
        )));
    }
    Ok(LoadedBrick {
        samples,
        cells,
        low: f64::from(brick.low),
        span: f64::from(brick.step) * largest,
        bytes,
    })
}
