//! The program people start: its command line, scenes, simulation and reports.

pub mod accuracy;
pub mod adapter;
pub mod calibrate;
pub mod cli;
pub mod command;
pub mod drive;
mod error;
pub mod gallery;
pub mod interrupt;
pub mod monitor;
pub mod orientation;
pub mod progress;
pub mod report;
mod same_file;
pub mod scene;
pub mod simulate;
pub mod staging;
pub mod tune;

pub use error::FrontendError;
