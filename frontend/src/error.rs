//! Why the program cannot do what it was asked to.

use crate::accuracy::AccuracyError;
use crate::scene::SceneError;
use renderer::output::OutputError;
use std::path::PathBuf;
use tracking::RegistrationError;

/// Each is one sentence for the person who started the program.
#[derive(Debug, thiserror::Error)]
pub enum FrontendError {
    /// The scene is wrong.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// A file cannot be written.
    #[error(transparent)]
    Output(#[from] OutputError),
    /// The display or an eye before it is wrong; the sentence is the display's.
    #[error("{0}")]
    Display(String),
    /// The volume cannot be opened or imported; the sentence is the store's.
    #[error("{0}")]
    Volume(String),
    /// A signal ended the work; the sentence is that of whoever stopped.
    #[error("{0}")]
    Stopped(String),
    /// A store is not whole.
    #[error(
        "{} is damaged in {}; copy it again or import the volume again",
        path.display(),
        if *damages == 1 { "1 place".to_owned() } else { format!("{damages} places") }
    )]
    DamagedStore {
        /// The store.
        path: PathBuf,
        /// How many damages there are.
        damages: u64,
    },
    /// The system does not report signals.
    #[error("cannot listen for the signals that end a program: {0}")]
    Signals(std::io::Error),
    /// A back-end cannot go on; the sentence is its own.
    #[error("{0}")]
    Backend(String),
    /// There is no window; the sentence says what to do.
    #[error("{0}")]
    Screen(String),
    /// A frame ended without all of its pictures.
    #[error(
        "frame {frame} ended without the pictures of projectors {missing:?}; the back-ends that draw them are at fault"
    )]
    MissingPictures {
        /// The frame.
        frame: u32,
        /// Indices into the display.
        missing: Vec<usize>,
    },
    /// Accuracy cannot be measured.
    #[error(transparent)]
    Accuracy(#[from] AccuracyError),
    /// `--frames` asks for what the scene does not have.
    #[error("--frames {first}..{end} lies outside the scene's frames 0..{count}; give a part of them")]
    Frames {
        /// The first frame asked for.
        first: u32,
        /// The frame after the last one asked for.
        end: u32,
        /// How many there are.
        count: u32,
    },
    /// A tape cannot be written or read.
    #[error(transparent)]
    Tape(#[from] tape::TapeError),
    /// The exhibit is wrong; a line for each fault.
    #[error("{0}")]
    Exhibit(String),
    /// The input file is wrong, or a source cannot be started.
    #[error(transparent)]
    Inputs(#[from] inputs::InputError),
    /// `--trace` without `--live`.
    #[error("--trace records what live frames ask for, and these frames are complete ones; add --live")]
    TraceOfCompleteFrames,
    /// What is for a scene, asked for with an exhibit.
    #[error(
        "{option} is for scenes, and the items of an exhibit have scenes and looks of their own; leave it out, or give one of these scenes"
    )]
    NotForExhibits {
        /// The option.
        option: &'static str,
    },
    /// A trace cannot be read, or is not of the volume that it is replayed with.
    #[error("{0}")]
    Trace(String),
    /// A display that no eye at the observer's distance sees whole.
    #[error(
        "{distance_m} m from this display there is no viewing zone to spread eyes over; choose another display or another observer"
    )]
    NoViewingZone {
        /// The observer's distance from the screen, metres.
        distance_m: f64,
    },
    /// The file of point pairs cannot be read.
    #[error("cannot read the point pairs {}: {source}; give the path of a readable .toml file", path.display())]
    ReadPairs {
        /// The file.
        path: PathBuf,
        /// What the file system said.
        source: std::io::Error,
    },
    /// The file of point pairs is none.
    #[error("{}, line {line}: {message}; each [[pair]] has tracker_m and display_m, and may have a name", path.display())]
    Pairs {
        /// The file.
        path: PathBuf,
        /// The line, from 1.
        line: usize,
        /// What the reader said.
        message: String,
    },
    /// Point pairs that fix no transform.
    #[error("{}: {source}", path.display())]
    Registration {
        /// Their file.
        path: PathBuf,
        /// Why not.
        source: RegistrationError,
    },
    /// The transform would take the place of its own point pairs.
    #[error("{} holds the point pairs themselves; give --out another name", path.display())]
    PairsOverwritten {
        /// The file.
        path: PathBuf,
    },
    /// What was asked for cannot be told.
    #[error(
        "cannot write to standard output: {0}; check the free space of the disk that it goes to, or send it elsewhere"
    )]
    StandardOutput(std::io::Error),
    /// The report does not go into JSON.
    #[error("cannot put the report into JSON: {0}")]
    Json(#[from] serde_json::Error),
}

impl From<transport::SessionError> for FrontendError {
    fn from(error: transport::SessionError) -> Self {
        Self::Backend(error.to_string())
    }
}

impl From<Vec<exhibit::Fault>> for FrontendError {
    fn from(faults: Vec<exhibit::Fault>) -> Self {
        let lines: Vec<String> = faults.iter().map(ToString::to_string).collect();
        Self::Exhibit(lines.join("\n"))
    }
}

impl From<screens::ScreenError> for FrontendError {
    fn from(error: screens::ScreenError) -> Self {
        Self::Screen(error.to_string())
    }
}

impl From<protocol::DrawError> for FrontendError {
    fn from(error: protocol::DrawError) -> Self {
        Self::Backend(error.to_string())
    }
}
