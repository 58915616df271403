//! Shadow rays to area lights.
//!
//! Which points of a light's grid are needed shows step by step, because cells are divided whose corners differ. Each round finds out which
//! points every lit point needs next; their shadow rays go in packets, those to one point of the grid behind each other.

use crate::observer::TraceObserver;
use crate::shadow::Shadow;
use crate::trace::{Aim, Arriving, FEW, Point, TreeTracer};
use arrayvec::ArrayVec;
use strahl_accel::PACKET;
use strahl_math::DVec3;
use strahl_shade::{AreaGrid, AreaLight, Color, Light, LightSample};

/// If the visibilities of the corners of a cell differ by more than this, an adaptive light subdivides the cell: less than a
/// step of an 8-bit channel.
const THRESHOLD: f64 = 1.0 / 256.0;

/// Most points of all grids that are gone through together, unless a single grid has more.
const TOGETHER: usize = 1 << 12;

/// The mean of four colours.
fn mean([a, b, c, d]: [Color; 4]) -> Color {
    ((a + b) + (c + d)) * 0.25
}

/// A rectangle of the grid, corners included.
#[derive(Clone, Copy, Debug)]
struct Cell {
    i: [u32; 2],
    j: [u32; 2],
    /// How often the grid has been halved to get here.
    level: u32,
}

impl Cell {
    /// The whole grid of a light.
    fn whole(area: &AreaLight) -> Self {
        Self {
            i: [0, area.size_1.saturating_sub(1)],
            j: [0, area.size_2.saturating_sub(1)],
            level: 0,
        }
    }

    /// The points at its corners, row by row.
    fn corners(&self) -> [GridPoint; 4] {
        let ([i0, i1], [j0, j1]) = (self.i, self.j);
        [(i0, j0), (i1, j0), (i0, j1), (i1, j1)].map(|(i, j)| GridPoint { i, j })
    }

    /// Its quarters, if it can be divided.
    fn quarters(&self) -> Option<[Self; 4]> {
        let ([i_low, i_high], i_splits) = halves(self.i);
        let ([j_low, j_high], j_splits) = halves(self.j);
        let quarter = |i, j| Self {
            i,
            j,
            level: self.level + 1,
        };
        (i_splits || j_splits).then(|| {
            [
                quarter(i_low, j_low),
                quarter(i_high, j_low),
                quarter(i_low, j_high),
                quarter(i_high, j_high),
            ]
        })
    }

    /// Whether it is divided in any case.
    fn is_coarse(&self, area: &AreaLight) -> bool {
        area.adaptive.is_none_or(|level| self.level < level)
    }

    /// Calls `visit` with the parts whose corners are certainly needed.
    fn parts(self, area: &AreaLight, visit: &mut impl FnMut(Self)) {
        match self.quarters() {
            Some(quarters) if self.is_coarse(area) => {
                quarters.into_iter().for_each(|q| q.parts(area, visit));
            }
            _ => visit(self),
        }
    }
}

/// Halves an interval of the grid: one with an even number of cells at its middle point, which both halves share, one with an
/// odd number in the gap between its two middle points. An interval of one cell is not divided.
fn halves([low, high]: [u32; 2]) -> ([[u32; 2]; 2], bool) {
    let width = high - low;
    if width <= 1 {
        return ([[low, high]; 2], false);
    }
    let middle = low + width / 2;
    ([[low, middle], [middle + width % 2, high]], true)
}

/// A point of the grid: its place in its row, and its row.
#[derive(Clone, Copy, Debug)]
struct GridPoint {
    i: u32,
    j: u32,
}

impl GridPoint {
    /// Its number, row by row.
    #[inline(always)]
    fn number(self, area: &AreaLight) -> usize {
        self.j as usize * area.size_1 as usize + self.i as usize
    }
}

/// An area light as seen from one lit point.
struct AreaQuery<'q> {
    number: usize,
    light: &'q Light,
    area: &'q AreaLight,
    grid: AreaGrid<'q>,
    /// The centre of the light.
    center: &'q LightSample,
    point: &'q Point<'q>,
}

impl AreaQuery<'_> {
    /// From the centre of the light to a point of its grid, as seen from the lit point.
    #[inline]
    fn offset(&self, GridPoint { i, j }: GridPoint) -> DVec3 {
        let offset = self.grid.offset(i, j);
        if self.light.is_parallel() {
            offset * (self.center.shadow_direction.length() / self.area.reach)
        } else {
            offset
        }
    }
}

/// What is known of the grids of a few lit points, one after the other.
#[derive(Debug, Default)]
struct Grids {
    /// The points of a grid.
    size: usize,
    /// Which points are needed, for the lit points that receive different light from the first ones.
    needed: Vec<bool>,
    /// The share of the light of a needed point that arrives, once its shadow ray is traced.
    visible: Vec<Color>,
}

impl Grids {
    /// So many grids of so many points, of which nothing is known.
    fn make(&mut self, count: usize, size: usize) {
        self.size = size;
        if self.visible.len() < size * count {
            self.visible.resize(size * count, Color::BLACK);
            self.needed.resize(size * count, false);
        }
    }

    /// Which points of the grid a lit point needs.
    fn needed_by(&mut self, lit: usize) -> &mut [bool] {
        &mut self.needed[lit * self.size..][..self.size]
    }

    /// The share of the light of a point that arrives at a lit point; it is known.
    #[inline(always)]
    fn color(&self, area: &AreaLight, lit: usize, point: GridPoint) -> Color {
        self.visible[lit * self.size + point.number(area)]
    }

    /// The colours of the corners of a cell, as a lit point sees them; they are known.
    #[inline(always)]
    fn corner_colors(&self, area: &AreaLight, lit: usize, cell: &Cell) -> [Color; 4] {
        let grid = &self.visible[lit * self.size..][..self.size];
        cell.corners().map(|corner| grid[corner.number(area)])
    }

    /// The mean over a cell, whose points are known as far as they are needed: of its four corners, or of its four quarters if the corners
    /// differ too much. The depth of the recursion is the logarithm of [`AreaLight::MAX_SIZE`].
    fn mean_of(&self, area: &AreaLight, lit: usize, cell: Cell) -> Color {
        let quarters = cell.quarters();
        if quarters.is_none() || !cell.is_coarse(area) {
            let corners = self.corner_colors(area, lit, &cell);
            if quarters.is_none() || !differ(&corners) {
                return mean(corners);
            }
        }
        let quarters = quarters.unwrap_or([cell; 4]);
        mean(quarters.map(|quarter| self.mean_of(area, lit, quarter)))
    }
}

/// What every lit point needs at first.
#[derive(Debug, Default)]
struct FirstRound {
    /// The parts of the grid.
    cells: Vec<Cell>,
    /// Their corners, each once.
    points: Vec<GridPoint>,
    /// Which points of the grid these are.
    needed: Vec<bool>,
}

impl FirstRound {
    fn find(&mut self, area: &AreaLight) {
        self.cells.clear();
        self.points.clear();
        self.needed.clear();
        self.needed
            .resize(area.size_1 as usize * area.size_2 as usize, false);
        Cell::whole(area).parts(area, &mut |cell| {
            self.cells.push(cell);
            for point in cell.corners() {
                if !std::mem::replace(&mut self.needed[point.number(area)], true) {
                    self.points.push(point);
                }
            }
        });
    }
}

/// A point of the grid that a lit point needs.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Wanted {
    /// The number of the lit point.
    lit: u32,
    point: GridPoint,
}

/// A part of the grid whose corners a lit point needs.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Part {
    lit: u32,
    cell: Cell,
}

/// The working memory of area lights.
#[derive(Debug, Default)]
pub(crate) struct AreaMemory {
    first: FirstRound,
    grids: Grids,
    /// The parts of this round, and of the next one.
    parts: Vec<Part>,
    next: Vec<Part>,
    /// The points of this round.
    wanted: Vec<Wanted>,
}

/// Whether the corners of a cell differ so much that it is divided.
fn differ(corners: &[Color; 4]) -> bool {
    let differs = |a: &Color| {
        let difference = *a - corners[0];
        difference.map(f64::abs).max_component() > THRESHOLD
    };
    corners.iter().any(differs)
}

impl<'s> TreeTracer<'s> {
    /// Fills in the light that arrives from an area light at points: one shadow ray for each point of the grid that is needed.
    #[cold]
    pub(crate) fn area_light<O: TraceObserver>(
        &mut self,
        area: &AreaLight,
        light: usize,
        points: &[Point<'s>],
        arriving: &mut [Arriving],
        observer: &mut O,
    ) {
        let size = area.size_1 as usize * area.size_2 as usize;
        let together = (TOGETHER / size.max(1)).clamp(1, PACKET);
        for few in arriving.chunks_mut(together) {
            let light_source = &self.tracer.scene.lights[light].light;
            let samples: ArrayVec<LightSample, PACKET> = few.iter().map(|one| one.sample).collect();
            let mut queries = ArrayVec::<AreaQuery<'_>, PACKET>::new();
            queries.extend(few.iter().zip(&samples).map(|(one, center)| {
                let point = &points[one.lane];
                AreaQuery {
                    number: light,
                    light: light_source,
                    area,
                    grid: area.grid(point.surface.resolved.point.position, center.l),
                    center,
                    point,
                }
            }));
            let mut memory = std::mem::take(&mut self.area_memory);
            memory.grids.make(few.len(), size);
            self.area_rays(&queries, &mut memory, few, observer);
            self.area_memory = memory;
            if area.illumination {
                let lit = few.iter_mut().zip(&queries);
                for (one, query) in lit.filter(|(one, _)| !one.sample.range.is_empty()) {
                    one.reflected = Some(if one.visible.is_black() {
                        (Color::BLACK, Color::BLACK)
                    } else {
                        self.area_shading(query, one.visible)
                    });
                }
            }
        }
    }

    /// Traces the shadow rays of lit points in rounds.
    fn area_rays<O: TraceObserver>(
        &mut self,
        queries: &[AreaQuery<'_>],
        memory: &mut AreaMemory,
        arriving: &mut [Arriving],
        observer: &mut O,
    ) {
        let AreaMemory {
            first,
            grids,
            parts,
            next,
            wanted,
        } = memory;
        let Some(area) = queries.first().map(|query| query.area) else {
            return;
        };
        first.find(area);
        let is_lit = |one: &Arriving| !one.sample.range.is_empty();
        wanted.clear();
        for &point in &first.points {
            let lit = (0..).zip(&*arriving).filter(|(_, one)| is_lit(one));
            wanted.extend(lit.map(|(lit, _)| Wanted { lit, point }));
        }
        for few in wanted.chunks(PACKET) {
            self.area_packet(queries, few, grids, observer);
        }
        // Most lit points receive the same from all of these points of the grid, and then they need no others.
        parts.clear();
        let mut mixed = ArrayVec::<usize, PACKET>::new();
        for (lit, one) in arriving.iter_mut().enumerate() {
            if !is_lit(one) {
                continue;
            }
            one.shadow_rays = first.points.len() as u32;
            let mut colors = first.points.iter().map(|p| grids.color(area, lit, *p));
            one.visible = colors.next().unwrap_or(Color::BLACK);
            if colors.any(|color| color != one.visible) {
                mixed.push(lit);
                grids.needed_by(lit).copy_from_slice(&first.needed);
                let part = |&cell| Part {
                    lit: lit as u32,
                    cell,
                };
                parts.extend(first.cells.iter().map(part));
            }
        }
        while !parts.is_empty() {
            next.clear();
            for Part { lit, cell } in &*parts {
                if let Some(quarters) = cell.quarters()
                    && differ(&grids.corner_colors(area, *lit as usize, cell))
                {
                    next.extend(quarters.map(|cell| Part { lit: *lit, cell }));
                }
            }
            std::mem::swap(parts, next);
            wanted.clear();
            for Part { lit, cell } in &*parts {
                let needed = grids.needed_by(*lit as usize);
                for point in cell.corners() {
                    if !std::mem::replace(&mut needed[point.number(area)], true) {
                        arriving[*lit as usize].shadow_rays += 1;
                        wanted.push(Wanted { lit: *lit, point });
                    }
                }
            }
            for few in wanted.chunks(PACKET) {
                self.area_packet(queries, few, grids, observer);
            }
        }
        for lit in mixed {
            arriving[lit].visible = grids.mean_of(area, lit, Cell::whole(area));
        }
    }

    /// Traces a few shadow rays to points of the grids, and stores what arrives.
    fn area_packet<O: TraceObserver>(
        &mut self,
        queries: &[AreaQuery<'_>],
        wanted: &[Wanted],
        grids: &mut Grids,
        observer: &mut O,
    ) {
        let Some(light) = queries.first().map(|query| query.number) else {
            return;
        };
        let mut aims = ArrayVec::<Aim<'_>, PACKET>::new();
        for Wanted { lit, point } in wanted {
            let query = &queries[*lit as usize];
            aims.push(Aim {
                point: query.point,
                direction: query.center.shadow_direction + query.offset(*point),
                range: query.center.range,
            });
        }
        let mut shadows = [Shadow::NONE; PACKET];
        let together = self.settings.packets && self.tracer.scene.mask(light).is_none();
        if together && aims.len() >= FEW {
            self.shadows_of(&aims, light, &mut shadows);
        } else {
            for (aim, shadow) in aims.iter().zip(&mut shadows) {
                *shadow = self.shadow_of(aim, light);
            }
        }
        for ((wanted, aim), shadow) in wanted.iter().zip(&aims).zip(&shadows) {
            self.counts.shadow += 1;
            self.counts.shadow_hit += u64::from(shadow.hit);
            if O::DETAILED {
                let report = self.shadow_report(aim, light);
                observer.area_shadow(aim.point.node, light as u32, report);
            }
            let number = wanted.point.number(queries[wanted.lit as usize].area);
            let place = wanted.lit as usize * grids.size + number;
            grids.visible[place] = shadow.visible;
        }
    }

    /// The light reflected from an area light with `area_illumination`: the mean over its points, each shaded by itself, times
    /// the visibility of the whole light (as in POV-Ray).
    fn area_shading(&self, query: &AreaQuery<'_>, visible: Color) -> (Color, Color) {
        let lit = query.point.surface.resolved.point.position;
        let (mut diffuse, mut specular) = (Color::BLACK, Color::BLACK);
        let (columns, rows) = (query.area.size_1, query.area.size_2);
        let all = (0..rows).flat_map(|j| (0..columns).map(move |i| GridPoint { i, j }));
        for point in all {
            let offset = query.offset(point);
            let (l, color) = if query.light.is_parallel() {
                // As in POV-Ray (measured) the points light from their own directions, with the intensity of the centre.
                let direction = query.center.shadow_direction + offset;
                (direction.normalize_or(query.center.l), query.center.color)
            } else {
                // The point has the intensity of the centre, seen from the point's position.
                match query.light.illuminate(lit - offset) {
                    Some(sample) => (sample.l, sample.color),
                    None => continue,
                }
            };
            let n_dot_l = query.point.surface.n_shade.dot(l);
            if self.faces(query.point, l, n_dot_l) {
                let light = color * visible;
                let (d, s) = self.reflected(query.point, query.light, light, l, n_dot_l);
                diffuse += d;
                specular += s;
            }
        }
        let count = f64::from(query.area.size_1) * f64::from(query.area.size_2);
        (diffuse / count, specular / count)
    }
}

#[cfg(test)]
mod tests {
    use super::halves;

    #[test]
    fn even_stretches_share_their_middle_and_odd_ones_part() {
        assert_eq!(halves([0, 4]), ([[0, 2], [2, 4]], true));
        assert_eq!(halves([0, 5]), ([[0, 2], [3, 5]], true));
        assert_eq!(halves([3, 4]), ([[3, 4], [3, 4]], false));
        assert_eq!(halves([7, 7]), ([[7, 7], [7, 7]], false));
    }
}
