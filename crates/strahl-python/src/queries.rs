//! Questions about many rays and points at once.

use crate::asked::Asked;
use crate::convert::{contiguous, vectors};
use crate::found::Found;
use crate::hits::Hits;
use crate::work::{self, Stop};
use crate::{convert, errors};
use numpy::{PyArray1, PyReadonlyArray2};
use pyo3::prelude::*;
use rayon::prelude::*;
use strahl::prelude::{DVec3, Interval, Ray};
use strahl::tracing::Searcher;

/// Rays between looks at the stop: with their hits they fit into the nearest cache. So few are answered without a further thread.
const PART: usize = 64;

/// Parts that a thread takes at once.
const PARTS: usize = 16;

/// Rays in arrays of the caller: a row for each, or one row for all.
pub(crate) struct Rays<'a> {
    origins: &'a [[f64; 3]],
    directions: &'a [[f64; 3]],
    count: usize,
}

impl<'a> Rays<'a> {
    pub(crate) fn new(
        origins: &'a PyReadonlyArray2<'_, f64>,
        directions: &'a PyReadonlyArray2<'_, f64>,
        count: usize,
    ) -> PyResult<Self> {
        let (origins, _) = contiguous(origins)?.as_chunks::<3>();
        let (directions, _) = contiguous(directions)?.as_chunks::<3>();
        let fits = |rows: &[[f64; 3]]| rows.len() == count || rows.len() == 1;
        match fits(origins) && fits(directions) {
            true => Ok(Self {
                origins,
                directions,
                count,
            }),
            false => Err(errors::value("there must be one row for each ray, or one")),
        }
    }

    fn ray(&self, number: usize) -> Ray {
        let row = |rows: &[[f64; 3]]| DVec3::from_array(*rows.get(number).unwrap_or(&rows[0]));
        Ray::new(row(self.origins), row(self.directions))
    }
}

impl Asked {
    /// Computes many answers, such that Ctrl-C ends it soon.
    pub(crate) fn run<T: Send>(
        &self,
        py: Python<'_>,
        count: usize,
        compute: impl FnOnce(&Stop) -> T + Send,
    ) -> PyResult<T> {
        match count <= PART {
            true => work::run_at_once(py, compute),
            false => work::run_borrowed(py, compute),
        }
    }

    /// Shows the rays, part by part and on all threads, to `answer` with a part of the answers.
    fn each_part<A: Send>(
        &self,
        rays: &Rays<'_>,
        answers: impl IndexedParallelIterator<Item = A>,
        stop: &Stop,
        answer: impl Fn(&mut Searcher<'_>, &[Ray], A) + Sync,
    ) {
        let part = |searcher: &mut Searcher<'_>, (number, answers): (usize, A)| {
            if stop.is_set() {
                return;
            }
            let first = number * PART;
            let list: [Ray; PART] =
                std::array::from_fn(|i| rays.ray((first + i).min(rays.count - 1)));
            answer(searcher, &list[..PART.min(rays.count - first)], answers);
        };
        let parts = answers.enumerate().with_min_len(PARTS);
        self.session
            .install(|| parts.for_each_init(|| self.scene.searcher(), part));
    }

    /// The nearest hits of rays.
    pub(crate) fn intersect(
        self,
        py: Python<'_>,
        rays: &Rays<'_>,
        range: Interval,
    ) -> PyResult<Hits> {
        let (t, found) = self.run(py, rays.count, |stop| {
            // Fresh zeros are memory that the threads touch first, when they write to it.
            let (mut t, mut found) = (vec![0.0; rays.count], Found::new(rays.count));
            let answers = t.par_chunks_mut(PART).zip(found.parts(PART));
            self.each_part(rays, answers, stop, |searcher, rays, (t, mut found)| {
                let hits = &mut [None; PART][..rays.len()];
                searcher.closest_hits(rays, range, hits);
                for (i, hit) in hits.iter().enumerate() {
                    t[i] = hit.map_or(f64::INFINITY, |hit| hit.t);
                    if let Some(hit) = hit {
                        found.set(i, &rays[i], hit);
                    }
                }
            });
            (t, found)
        })?;
        Ok(Hits::new(py, self, t, found))
    }

    /// Whether something opaque is on each ray.
    pub(crate) fn occluded(
        &self,
        py: Python<'_>,
        rays: &Rays<'_>,
        range: Interval,
    ) -> PyResult<Py<PyArray1<bool>>> {
        let answers = self.run(py, rays.count, |stop| {
            let mut all = vec![false; rays.count];
            let parts = all.par_chunks_mut(PART);
            self.each_part(rays, parts, stop, |searcher, rays, answers| {
                searcher.occluded(rays, range, answers);
            });
            all
        })?;
        Ok(convert::frozen(py, answers))
    }

    /// The number of the object around each point, or -1.
    pub(crate) fn inside(
        self,
        py: Python<'_>,
        points: &PyReadonlyArray2<'_, f64>,
    ) -> PyResult<Py<PyArray1<i32>>> {
        let points = vectors(points)?;
        let answers = work::run(py, move || {
            let mut answers = vec![None; points.len()];
            self.session.inside(&self.scene, &points, &mut answers);
            let number = |object: Option<u32>| object.map_or(-1, convert::number);
            answers.into_iter().map(number).collect()
        })?;
        Ok(convert::frozen(py, answers))
    }
}
