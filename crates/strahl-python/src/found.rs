//! Hits in little memory.

use crate::shelf::Shelf;
use rayon::prelude::*;
use strahl::prelude::{DVec3, Hit, Ray};

/// A ray: origin and direction.
type Line = [f64; 6];

/// What a hit has besides `t`: `id`, `facet` and the bits of `uv`.
type Rest = [u64; 4];

static LINES: Shelf<Line> = Shelf::new();
static RESTS: Shelf<Rest> = Shelf::new();

/// Hits without `t`, which is in an array, and their rays. Entries of rays that hit nothing say nothing.
pub(crate) struct Found {
    // Lists of arrays of numbers: fresh ones are zeros that take no time until they are written to.
    lines: Vec<Line>,
    rests: Vec<Rest>,
}

/// A part of it.
pub(crate) struct Part<'a> {
    lines: &'a mut [Line],
    rests: &'a mut [Rest],
}

impl Found {
    pub(crate) fn new(count: usize) -> Self {
        let (line, rest) = (Line::default(), Rest::default());
        Self {
            lines: LINES.take(count, line).unwrap_or_else(|| vec![line; count]),
            rests: RESTS.take(count, rest).unwrap_or_else(|| vec![rest; count]),
        }
    }

    /// Parts of this length.
    pub(crate) fn parts(&mut self, length: usize) -> impl IndexedParallelIterator<Item = Part<'_>> {
        let (lines, rests) = (&mut self.lines, &mut self.rests);
        let both = lines
            .par_chunks_mut(length)
            .zip(rests.par_chunks_mut(length));
        both.map(|(lines, rests)| Part { lines, rests })
    }

    /// The ray with a number, and its hit at `t`.
    pub(crate) fn get(&self, number: usize, t: f64) -> (Ray, Hit) {
        let [x, y, z, u, v, w] = self.lines[number];
        let [id, facet, first, second] = self.rests[number];
        let hit = Hit {
            t,
            id,
            facet: facet as u32,
            uv: [first, second].map(f64::from_bits),
        };
        (Ray::new(DVec3::new(x, y, z), DVec3::new(u, v, w)), hit)
    }
}

impl Part<'_> {
    /// Stores a ray and its hit.
    pub(crate) fn set(&mut self, number: usize, ray: &Ray, hit: &Hit) {
        let ([x, y, z], [u, v, w]) = (ray.origin.to_array(), ray.direction.to_array());
        let [first, second] = hit.uv.map(f64::to_bits);
        self.lines[number] = [x, y, z, u, v, w];
        self.rests[number] = [hit.id, u64::from(hit.facet), first, second];
    }
}

impl Drop for Found {
    fn drop(&mut self) {
        LINES.put(std::mem::take(&mut self.lines));
        RESTS.put(std::mem::take(&mut self.rests));
    }
}
