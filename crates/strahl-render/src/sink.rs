use crate::film::Film;
use std::ops::ControlFlow;

/// A pass over the picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Pass {
    /// Its number, from 0.
    pub number: u32,
    /// How many passes the picture takes.
    pub of: u32,
    /// Side of the blocks of pixels that show one sample, in pixels; 1 is the full resolution.
    pub step: u32,
    /// Whether it takes more samples of pixels that are shown already: antialiasing.
    pub refines: bool,
}

/// Receives a picture part by part while it is made. All calls come from the thread that renders, one after the other, so a sink
/// may own and borrow what it likes.
///
/// Each pass hands over every pixel of the film exactly once, a stop and its continuation counted together. A closure that takes a
/// [`Tile`] is a sink.
pub trait Sink {
    /// A pass begins, or goes on after a stop.
    fn pass(&mut self, _pass: &Pass) -> ControlFlow<()> {
        ControlFlow::Continue(())
    }

    /// A part of the picture is done, as far as the pass goes. `Break` stops the render; what other threads have begun is kept.
    fn tile(&mut self, tile: &Tile<'_>) -> ControlFlow<()>;
}

impl<F: FnMut(&Tile<'_>) -> ControlFlow<()>> Sink for F {
    fn tile(&mut self, tile: &Tile<'_>) -> ControlFlow<()> {
        self(tile)
    }
}

/// A part of a picture that a pass has finished.
#[derive(Clone, Copy, Debug)]
pub struct Tile<'t> {
    /// The pass.
    pub pass: Pass,
    /// The pixels, with the channels of the picture. Where [`Pass::step`] is more than 1, each sample stands for a block.
    pub film: &'t Film,
    /// Whether the pass has traced rays here; if not, the pixels are those of the pass before.
    pub changed: bool,
    /// Number of parts handed over in this pass, this one included.
    pub done: usize,
    /// Number of parts of the pass.
    pub of: usize,
}
