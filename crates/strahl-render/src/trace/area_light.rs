//! Shadow rays to area lights.
//!
//! Which points of a light's grid are needed shows step by step, because cells are divided whose corners differ. Each round finds out which
//! points every lit point needs next; their shadow rays go in packets, those to one point of the grid behind each other.

use super::{Aim, Arriving, Point, TreeTracer};
use crate::area::{AreaMemory, Cell, GridPoint, Grids, Part, Wanted, differ};
use crate::observer::TraceObserver;
use crate::query::PACKET_MIN;
use crate::shadow::Shadow;
use arrayvec::ArrayVec;
use strahl_accel::PACKET;
use strahl_math::DVec3;
use strahl_shade::{AreaGrid, AreaLight, Color, Light, LightSample};

/// Most points of all grids that are gone through together, unless a single grid has more.
const TOGETHER: usize = 1 << 12;

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

impl<'s> TreeTracer<'s> {
    /// Fills in the light that arrives from an area light at points: one shadow ray for each point of the grid that is needed.
    #[cold]
    pub(super) fn area_light<O: TraceObserver>(
        &mut self,
        area: &AreaLight,
        light: usize,
        points: &[Point<'s>],
        arriving: &mut [Arriving],
        observer: &mut O,
    ) {
        let size = area.size_1 as usize * area.size_2 as usize;
        let together = (TOGETHER / size.max(1)).clamp(1, PACKET);
        for chunk in arriving.chunks_mut(together) {
            let light_source = &self.intersector.scene.lights[light].light;
            let samples: ArrayVec<LightSample, PACKET> =
                chunk.iter().map(|one| one.sample).collect();
            let mut queries = ArrayVec::<AreaQuery<'_>, PACKET>::new();
            queries.extend(chunk.iter().zip(&samples).map(|(one, center)| {
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
            memory.grids.make(chunk.len(), size);
            self.area_rays(&queries, &mut memory, chunk, observer);
            self.area_memory = memory;
            if area.illumination {
                let lit = chunk.iter_mut().zip(&queries);
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
        for chunk in wanted.chunks(PACKET) {
            self.area_packet(queries, chunk, grids, observer);
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
            for chunk in wanted.chunks(PACKET) {
                self.area_packet(queries, chunk, grids, observer);
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
        let together = self.settings.packets && self.intersector.scene.mask(light).is_none();
        if together && aims.len() >= PACKET_MIN {
            self.shadows_of(aims.len(), |index| aims[index], light, &mut shadows);
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
