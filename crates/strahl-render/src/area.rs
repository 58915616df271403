//! Shadow rays to area lights.

use crate::observer::TraceObserver;
use crate::shadow::ShadowRay;
use crate::trace::{Arriving, Point, TreeTracer};
use strahl_math::{DVec3, Ray};
use strahl_shade::{AreaGrid, AreaLight, Color, Light, LightSample};

/// If the visibilities of the corners of a cell differ by more than this, an adaptive light subdivides the cell: less than a
/// step of an 8-bit channel.
const THRESHOLD: f64 = 1.0 / 256.0;

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
    fn offset(&self, i: u32, j: u32) -> DVec3 {
        let offset = self.grid.offset(i, j);
        if self.light.is_parallel() {
            offset * (self.center.shadow_direction.length() / self.area.reach)
        } else {
            offset
        }
    }
}

impl<'s> TreeTracer<'s> {
    /// Fills in the light that arrives from an area light: one shadow ray for each point of the grid that is needed.
    #[cold]
    pub(crate) fn area_light<O: TraceObserver>(
        &mut self,
        area: &AreaLight,
        light: usize,
        point: &Point<'s>,
        arriving: &mut Arriving,
        observer: &mut O,
    ) {
        let sample = &arriving.sample;
        let query = AreaQuery {
            number: light,
            light: &self.tracer.scene.lights[light].light,
            area,
            grid: area.grid(point.surface.resolved.point.position, sample.l),
            center: sample,
            point,
        };
        let before = self.counts.shadow;
        let mut known = std::mem::take(&mut self.area_points);
        known.clear();
        known.resize(area.size_1 as usize * area.size_2 as usize, None);
        let whole = Cell {
            i: [0, area.size_1.saturating_sub(1)],
            j: [0, area.size_2.saturating_sub(1)],
            level: 0,
        };
        let visible = self.area_cell(&query, whole, &mut known, observer);
        self.area_points = known;
        if area.illumination {
            arriving.reflected = Some(if visible.is_black() {
                (Color::BLACK, Color::BLACK)
            } else {
                self.area_shading(&query, visible)
            });
        }
        arriving.visible = visible;
        arriving.shadow_rays = (self.counts.shadow - before) as u32;
    }

    /// The light reflected from an area light with `area_illumination`: the mean over its points, each shaded by itself, times
    /// the visibility of the whole light (as in POV-Ray).
    fn area_shading(&self, query: &AreaQuery<'_>, visible: Color) -> (Color, Color) {
        let lit = query.point.surface.resolved.point.position;
        let (mut diffuse, mut specular) = (Color::BLACK, Color::BLACK);
        for j in 0..query.area.size_2 {
            for i in 0..query.area.size_1 {
                let offset = query.offset(i, j);
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
        }
        let count = f64::from(query.area.size_1) * f64::from(query.area.size_2);
        (diffuse / count, specular / count)
    }

    /// The mean over a cell: of its four corners, or of its four quarters if the corners differ too much. The depth of the
    /// recursion is the logarithm of [`AreaLight::MAX_SIZE`].
    fn area_cell<O: TraceObserver>(
        &mut self,
        query: &AreaQuery<'_>,
        cell: Cell,
        known: &mut [Option<Color>],
        observer: &mut O,
    ) -> Color {
        let ([i_low, i_high], i_splits) = halves(cell.i);
        let ([j_low, j_high], j_splits) = halves(cell.j);
        let splits = i_splits || j_splits;
        let must = query.area.adaptive.is_none_or(|level| cell.level < level);
        if !(splits && must) {
            let [i0, i1] = cell.i;
            let [j0, j1] = cell.j;
            let corners = [(i0, j0), (i1, j0), (i0, j1), (i1, j1)]
                .map(|(i, j)| self.area_point(query, (i, j), known, observer));
            let differ = |a: &Color| {
                let difference = *a - corners[0];
                difference.map(f64::abs).max_component() > THRESHOLD
            };
            if !splits || !corners.iter().any(differ) {
                return mean(corners);
            }
        }
        let level = cell.level + 1;
        let quarters = [
            (i_low, j_low),
            (i_high, j_low),
            (i_low, j_high),
            (i_high, j_high),
        ];
        mean(quarters.map(|(i, j)| self.area_cell(query, Cell { i, j, level }, known, observer)))
    }

    /// The visibility of one point of the grid; its shadow ray is traced once.
    fn area_point<O: TraceObserver>(
        &mut self,
        query: &AreaQuery<'_>,
        (i, j): (u32, u32),
        known: &mut [Option<Color>],
        observer: &mut O,
    ) -> Color {
        let index = j as usize * query.area.size_1 as usize + i as usize;
        if let Some(Some(visible)) = known.get(index) {
            return *visible;
        }
        let (point, center) = (query.point, query.center);
        let direction = center.shadow_direction + query.offset(i, j);
        let (origin_point, from) = point.surface.start(&point.hit, direction);
        let shadow_ray = ShadowRay {
            ray: Ray::new(origin_point, direction),
            range: center.range,
            from,
            light: query.number,
            media: point.branch.media,
        };
        let (media, hits) = (&mut self.media, &mut self.shadow_hits);
        let shadow = self.tracer.shadow(&shadow_ray, media, hits);
        self.counts.shadow += 1;
        self.counts.shadow_hit += u64::from(shadow.hit);
        if O::DETAILED {
            let report = self.tracer.shadow_report(&shadow_ray, media, hits);
            observer.area_shadow(point.node, query.number as u32, report);
        }
        if let Some(slot) = known.get_mut(index) {
            *slot = Some(shadow.visible);
        }
        shadow.visible
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
