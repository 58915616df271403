//! A picture in the making: what has been traced so far, and what comes next.

use super::crew::{Canvas, Ended, Part, TileList, Turn};
use super::plan::{Stage, edge, points};
use super::refine::Comparison;
use super::{Crew, Lattice, RenderError, RenderOptions, Rendered};
use crate::cost::PixelCost;
use crate::film::{Film, Region, try_filled};
use crate::sampling::{Quadrants, Sample, Sampling};
use crate::sink::{Pass, Sink};
use crate::tiles::{TILE, tiles, tiles_of, whole_tiles};
use crate::trace::{BatchMemory, RayCounts};
use arrayvec::ArrayVec;
use std::collections::HashMap;
use strahl_accel::TraversalStats;

/// What a film that is not finished has of a pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PixelState {
    /// Nothing: it is black.
    Missing,
    /// A colour that later passes replace: that of a pixel nearby, or one without antialiasing.
    Provisional,
    /// Its final colour.
    Final,
}

/// A picture in the making.
#[derive(Clone, Debug)]
pub(crate) struct Work {
    options: RenderOptions,
    canvas: Canvas,
    stages: Vec<Stage>,
    /// Number of the current stage.
    at: usize,
    /// The tiles of the current stage, if it has begun.
    list: Option<TileList>,
    /// The first samples of pixels, or those of corners, where a later pass needs them.
    lattice: Option<Lattice>,
    /// The pixels of the lattice that are refined.
    rough: Vec<Quadrants>,
}

impl Work {
    /// Nothing is traced yet.
    pub(crate) fn new(options: &RenderOptions) -> Result<Self, RenderError> {
        let mut film = Film::try_new(options.width, options.height, options.region, options.info)?;
        let region = film.region;
        if options.alpha {
            film.alpha = Some(try_filled(region, 1.0)?);
        }
        let sampled = match options.sampling {
            Sampling::Center => None,
            Sampling::Grid(_) => options.coarse_first.then_some(region),
            // The pixels that decide about those of a tile, so that what is refined does not depend on regions.
            Sampling::Adaptive(_) => {
                let (width, height) = (options.width, options.height);
                Some(whole_tiles(region, width, height).grown(1, width, height))
            }
            Sampling::Corners | Sampling::Recursive(_) => Some(Region {
                width: region.width + 1,
                height: region.height + 1,
                ..region
            }),
        };
        let lattice = match sampled {
            None => None,
            Some(region) => Some(Lattice {
                region,
                samples: try_filled(region, Sample::BLACK)?,
            }),
        };
        let costs = match options.costs {
            true => Some(try_filled(region, PixelCost::default())?),
            false => None,
        };
        Ok(Self {
            stages: Stage::all(options),
            options: options.clone(),
            canvas: Canvas {
                film,
                counts: RayCounts::default(),
                traversal: TraversalStats::default(),
                batches: BatchMemory::default(),
                costs,
            },
            at: 0,
            list: None,
            lattice,
            rough: vec![],
        })
    }

    /// The film so far.
    pub(crate) fn film(&self) -> &Film {
        &self.canvas.film
    }

    /// The film so far, without the rest.
    pub(crate) fn into_film(self) -> Film {
        self.canvas.film
    }

    /// The rays so far.
    pub(crate) fn rays(&self) -> RayCounts {
        self.canvas.counts
    }

    /// The pass that is going on, or comes next.
    pub(crate) fn pass(&self) -> Pass {
        Stage::pass(&self.stages, self.at)
    }

    /// The finished picture.
    pub(crate) fn rendered(self, threads: usize) -> Rendered {
        Rendered {
            film: self.canvas.film,
            rays: self.canvas.counts,
            traversal: self.canvas.traversal,
            batches: self.canvas.batches,
            threads,
            costs: self.canvas.costs,
        }
    }

    /// Traces until the picture is finished, which is true, or until there is a stop.
    pub(crate) fn go_on(
        &mut self,
        crew: &Crew<'_>,
        mut sink: Option<&mut (dyn Sink + '_)>,
    ) -> Result<bool, RenderError> {
        while let Some(&stage) = self.stages.get(self.at) {
            if self.list.is_none() {
                self.list = Some(self.begin(stage)?);
            }
            let sink = sink.as_mut().map(|sink| &mut **sink as &mut dyn Sink);
            let ended = self.trace(stage, crew, sink);
            if ended == Ended::Stopped {
                return Ok(false);
            }
            self.list = None;
            self.at += 1;
            if ended == Ended::CompleteAndStopped {
                break;
            }
        }
        Ok(self.at == self.stages.len())
    }

    /// The tiles of a stage.
    fn begin(&mut self, stage: Stage) -> Result<TileList, RenderError> {
        let (film, order) = (self.canvas.film.region, self.options.tile_order);
        let region = self.lattice.as_ref().map_or(film, |l| l.region);
        Ok(match stage {
            Stage::Pixels | Stage::Rest | Stage::Divide(_) => one_to_one(tiles(film, order), film),
            Stage::First { step } => one_to_one(tiles_of(region, edge(step), order), film),
            Stage::Corners { step: 1 } => by_corners(tiles(region, order), tiles(film, order)),
            Stage::Corners { step } => one_to_one(tiles_of(region, edge(step), order), film),
            Stage::Refine(refinement) => {
                if let Some(first) = &self.lattice {
                    let comparison = Comparison::new(&refinement, self.options.trace.space());
                    self.rough = first.rough(&comparison)?;
                }
                let rough = |x, y| self.rough[region.index(x, y)];
                let (width, height) = (self.options.width, self.options.height);
                let all = tiles(whole_tiles(film, width, height), order).into_iter();
                let (wanted, rest): (Vec<Region>, Vec<Region>) =
                    all.partition(|tile| tile.positions().any(|(x, y)| !rough(x, y).is_none()));
                let mut list = one_to_one(wanted, film);
                let rest = rest.iter().filter_map(|tile| tile.intersection(&film));
                list.parts.extend(rest.map(|part| Part::new(part, 0)));
                list
            }
        })
    }

    /// The step of the lattice that is known at a stage of this step; `None` at the first stage.
    fn known(&self, step: u32) -> Option<u32> {
        let before = self.at.checked_sub(1).and_then(|n| self.stages.get(n));
        before.map(|_| 2 * step)
    }

    /// Traces the current stage, from where it was left.
    fn trace(
        &mut self,
        stage: Stage,
        crew: &Crew<'_>,
        sink: Option<&mut (dyn Sink + '_)>,
    ) -> Ended {
        let pass = self.pass();
        let known = match stage {
            Stage::First { step } | Stage::Corners { step } => self.known(step),
            _ => None,
        };
        let Some(list) = &mut self.list else {
            return Ended::Complete;
        };
        let turn = Turn {
            crew,
            options: &self.options,
            pass,
            canvas: &mut self.canvas,
            list,
            sink,
        };
        match (stage, &mut self.lattice) {
            (Stage::Pixels, _) => turn.pixels(),
            (Stage::First { step: 1 }, Some(lattice)) if known.is_none() => turn.first(lattice),
            (Stage::First { step }, lattice) => turn.coarse(step, known, false, lattice.as_mut()),
            (Stage::Corners { step: 1 }, Some(lattice)) => turn.corners(known, lattice),
            (Stage::Corners { step }, lattice) => turn.coarse(step, known, true, lattice.as_mut()),
            (Stage::Rest, Some(lattice)) => turn.rest(lattice),
            (Stage::Refine(refinement), Some(lattice)) => {
                turn.refine(&refinement, lattice, &self.rough)
            }
            (Stage::Divide(refinement), Some(lattice)) => turn.divide(&refinement, lattice),
            // All plans with these stages have a lattice.
            (_, None) => Ended::Complete,
        }
    }

    /// What there is of each pixel of the film, row by row.
    pub(crate) fn states(&self) -> Vec<PixelState> {
        let region = self.canvas.film.region;
        let Some(&stage) = self.stages.get(self.at) else {
            return vec![PixelState::Final; region.pixels() as usize];
        };
        // What pixels have that the current stage has not reached, and those it has.
        let last = self.at + 1 == self.stages.len();
        let before = match self.at {
            0 => PixelState::Missing,
            _ => PixelState::Provisional,
        };
        let after = match last {
            true => PixelState::Final,
            false => PixelState::Provisional,
        };
        let mut states = vec![before; region.pixels() as usize];
        // Samples of coarse passes are final where no pass takes more of them.
        let one_each = matches!(self.stages.last(), Some(Stage::First { .. }));
        let origin = (region.x, region.y);
        if let (Stage::First { step }, true) = (stage, one_each)
            && let Some(known) = self.known(step)
        {
            for (x, y) in points(region, origin, known, None) {
                states[region.index(x, y)] = PixelState::Final;
            }
        }
        let parts = self.list.iter().flat_map(|list| &list.parts);
        for part in parts.filter(|part| part.waits == 0) {
            for (x, y) in part.region.positions() {
                let state = &mut states[region.index(x, y)];
                *state = match *state {
                    PixelState::Final => PixelState::Final,
                    _ => after,
                };
            }
            if let (Stage::First { step }, true) = (stage, one_each) {
                for (x, y) in points(part.region, origin, step, None) {
                    states[region.index(x, y)] = PixelState::Final;
                }
            }
        }
        states
    }
}

/// Tiles that each make their own part of the film.
fn one_to_one(tiles: Vec<Region>, film: Region) -> TileList {
    let mut list = TileList {
        done: vec![false; tiles.len()],
        ..TileList::default()
    };
    for tile in &tiles {
        let mut feeds = ArrayVec::new();
        if let Some(region) = tile.intersection(&film) {
            feeds.push(list.parts.len() as u32);
            list.parts.push(Part::new(region, 1));
        }
        list.feeds.push(feeds);
    }
    list.tiles = tiles;
    list
}

/// Tiles of corners: a part needs those of all corners of its pixels.
fn by_corners(corners: Vec<Region>, pixels: Vec<Region>) -> TileList {
    let cell = |x: u32, y: u32| (x / TILE, y / TILE);
    let numbers: HashMap<(u32, u32), usize> = corners
        .iter()
        .enumerate()
        .map(|(number, tile)| (cell(tile.x, tile.y), number))
        .collect();
    let mut list = TileList {
        done: vec![false; corners.len()],
        feeds: vec![ArrayVec::new(); corners.len()],
        ..TileList::default()
    };
    for (number, part) in (0u32..).zip(pixels) {
        let (right, bottom) = (part.x + part.width, part.y + part.height);
        let (left, top) = cell(part.x, part.y);
        let (last, lowest) = cell(right, bottom);
        let mut waits = 0;
        for row in top..=lowest {
            for column in left..=last {
                if let Some(&tile) = numbers.get(&(column, row)) {
                    list.feeds[tile].push(number);
                    waits += 1;
                }
            }
        }
        list.parts.push(Part::new(part, waits));
    }
    list.tiles = corners;
    list
}
