//! The program people start: its command line, scenes, simulation and reports.

pub mod scene;
