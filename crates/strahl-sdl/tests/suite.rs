//! One program for most tests: linking one takes less time than linking twenty, and long tests run side by side.

mod antialiasing;
mod common;
mod evaluation;
mod features;
mod hostile;
mod language;
mod large;
mod library;
mod looks;
mod media;
mod mirrors;
mod objects;
mod oracle;
mod pictures;
#[path = "common/plates.rs"]
mod plates;
mod quality;
mod questions;
mod random;
mod reading;
mod silhouettes;
mod texture_coordinates;
mod textures;
mod variants;
mod versions;
mod world;
