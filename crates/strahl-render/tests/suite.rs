//! One program for nearly all tests of what the crate offers: linking one takes less time than linking fifteen, and long tests run side by side.

mod brep;
mod clips;
mod common;
mod determinism;
mod explain;
mod grazing;
mod instances;
mod large;
mod memory;
mod optics;
mod profile;
mod queries;
mod session;
mod textures;
mod transport;
mod watertight;
