//! Blobs: the surface where the fields of several sources add up to a threshold.

mod balls;
mod component;
mod walk;

pub use component::BlobComponent;
pub(crate) use walk::Pieces;

use super::event;
use crate::primitives::{check_positive, point_error};
use crate::{
    Crossings, GeometryError, PrimHit, Primitive, Scratch, Shape, Solid, SurfaceId, SurfacePoint,
};
use balls::Balls;
use strahl_accel::{Accelerator, Bvh2, TraversalStats, Visitor};
use strahl_math::error::gamma;
use strahl_math::{Aabb, DVec3, Interval, Ray, Transform};

/// A solid: all points where the sum of the fields of its components is above a threshold.
///
/// Balls and capsules flow together where they come close; components of negative strength make dents. No texture coordinates.
/// Facets: one, 0. A ray that touches it does not hit it.
///
/// Along a ray the field is a polynomial of degree 4 between the places where it enters or leaves the field of a component (after
/// J. F. Blinn, "A generalization of algebraic surface drawing", ACM Transactions on Graphics 1 (1982), with G. and B. Wyvill's finite
/// fields). These are visited in order, each set up about its own beginning, and their roots isolated in Bernstein form.
#[derive(Clone, Debug)]
pub struct Blob {
    threshold: f64,
    components: Vec<BlobComponent>,
    index: Index,
    /// The box around all attracting components.
    reach: Aabb,
    /// The box around the surface.
    bounds: Aabb,
}

/// How the components are found that a ray or a point may reach.
#[derive(Clone, Debug)]
enum Index {
    /// Those of a few are looked at four by four.
    Balls(Balls),
    /// Those of many are found in a tree.
    Tree(Bvh2),
}

/// Up to this many components are few.
const LIST_MAX: usize = 16;

/// Blobs of more components have the box around all of them.
const TIGHTENED: usize = 256;

impl Blob {
    /// The blob of a threshold and components.
    pub fn new(threshold: f64, components: Vec<BlobComponent>) -> Self {
        let boxes: Vec<Aabb> = components.iter().map(BlobComponent::bounds).collect();
        let attracting = components
            .iter()
            .zip(&boxes)
            .filter(|(c, _)| c.strength() > 0.0);
        let reach = attracting.fold(Aabb::EMPTY, |sum, (_, b)| sum.union(b));
        Self {
            threshold,
            reach,
            bounds: match components.len() {
                ..=TIGHTENED => tightened(threshold, &components, &boxes),
                _ => reach,
            },
            index: match components.len() {
                ..=LIST_MAX => Index::Balls(Balls::around(&components)),
                _ => Index::Tree(Bvh2::build(&boxes)),
            },
            components,
        }
    }

    /// Like [`Blob::new`], checked.
    ///
    /// # Errors
    /// A number is not finite, the threshold or a radius is not positive, or all components together don't reach the threshold.
    pub fn try_new(threshold: f64, components: Vec<BlobComponent>) -> Result<Self, GeometryError> {
        let blob = Self::new(threshold, components);
        blob.validate().map(|()| blob)
    }

    /// The value of the field on the surface.
    pub fn threshold(&self) -> f64 {
        self.threshold
    }

    /// The box around the fields of all attracting components.
    pub fn reach(&self) -> Aabb {
        self.reach
    }

    /// The sources of the field.
    pub fn components(&self) -> &[BlobComponent] {
        &self.components
    }

    /// Calls `visit` with the number of each component whose field reaches a point, the field there and its gradient, in
    /// ascending order of the numbers.
    pub fn fields_at(&self, point: DVec3, mut visit: impl FnMut(usize, f64, DVec3)) {
        let tree = match &self.index {
            Index::Tree(tree) => tree,
            Index::Balls(balls) => {
                for i in bits_of(balls.holding(point)) {
                    let Some(component) = self.components.get(i) else {
                        continue;
                    };
                    let (field, gradient) = component.field(point);
                    if field != 0.0 {
                        visit(i, field, gradient);
                    }
                }
                return;
            }
        };
        let mut found = Found {
            blob: self,
            point,
            list: Vec::new(),
        };
        let ray = Ray::new(point, DVec3::X);
        // A ray that is hardly longer than a point.
        let range = Interval::new(-f64::MIN_POSITIVE, f64::MIN_POSITIVE);
        tree.traverse(&ray, range, &mut found, &mut TraversalStats::default());
        found.list.sort_by_key(|(i, ..)| *i);
        for (i, field, gradient) in found.list {
            visit(i as usize, field, gradient);
        }
    }

    /// The field at a point and its gradient.
    fn field(&self, point: DVec3) -> (f64, DVec3) {
        let (mut field, mut gradient) = (0.0, DVec3::ZERO);
        self.fields_at(point, |_, f, g| {
            field += f;
            gradient += g;
        });
        (field, gradient)
    }

    /// The gradient of the field at a point, and the sum of the threshold and the strengths of the fields that reach it.
    fn gradient_and_magnitude(&self, point: DVec3) -> (DVec3, f64) {
        let (mut gradient, mut magnitude) = (DVec3::ZERO, self.threshold);
        self.fields_at(point, |i, _, g| {
            gradient += g;
            magnitude += self.components[i].strength().abs();
        });
        (gradient, magnitude)
    }
}

/// The numbers of the bits that are set.
fn bits_of(mut set: u32) -> impl Iterator<Item = usize> {
    std::iter::from_fn(move || {
        let bit = set.trailing_zeros();
        set &= set.wrapping_sub(1);
        (bit < u32::BITS).then_some(bit as usize)
    })
}

/// The box around the surface: where as many as n attracting components overlap, one of them must have an nth of the threshold at least.
fn tightened(threshold: f64, components: &[BlobComponent], boxes: &[Aabb]) -> Aabb {
    let all = || {
        components
            .iter()
            .zip(boxes)
            .filter(|(c, _)| c.strength() > 0.0)
    };
    all().fold(Aabb::EMPTY, |sum, (component, bounds)| {
        let meets = |other: &Aabb| !other.intersection(bounds).is_empty();
        let overlapping = all().filter(|(_, other)| meets(other)).count();
        let part = threshold / (overlapping as f64 * component.strength());
        // NaN and what is not positive are errors that are found later.
        if part > 0.0 && part <= 1.0 {
            sum.union(&component.bounds_of(part * (1.0 - gamma(64))))
        } else {
            sum
        }
    })
}

/// Collects the components whose field reaches a point.
struct Found<'a> {
    blob: &'a Blob,
    point: DVec3,
    list: Vec<(u32, f64, DVec3)>,
}

impl Visitor for Found<'_> {
    fn visit(&mut self, id: u32, t_max: f64) -> f64 {
        if let Some(component) = self.blob.components.get(id as usize) {
            let (field, gradient) = component.field(self.point);
            if field != 0.0 {
                self.list.push((id, field, gradient));
            }
        }
        t_max
    }
}

impl Primitive for Blob {
    fn kind(&self) -> &'static str {
        "blob"
    }

    fn validate(&self) -> Result<(), GeometryError> {
        check_positive("threshold of the blob", self.threshold)?;
        for component in &self.components {
            component.validate()?;
        }
        let strengths = self.components.iter().map(BlobComponent::strength);
        let most: f64 = strengths.filter(|s| *s > 0.0).sum();
        if most > self.threshold {
            return Ok(());
        }
        Err(GeometryError::Degenerate {
            what: "blob",
            why: "all components together don't reach the threshold",
        })
    }

    fn bounds(&self) -> Aabb {
        self.bounds
    }

    fn closest_hit(
        &self,
        ray: &Ray,
        range: Interval,
        from: Option<SurfaceId>,
        scratch: &mut Scratch,
    ) -> Option<PrimHit> {
        let mut pieces = scratch.take_pieces();
        let hit = event::closest(range, from, |question, visit| {
            self.walk(ray, question, &mut pieces, visit);
        });
        scratch.give_pieces(pieces);
        hit
    }

    fn all_hits(
        &self,
        ray: &Ray,
        range: Interval,
        from: Option<SurfaceId>,
        scratch: &mut Scratch,
        out: &mut Vec<PrimHit>,
    ) {
        let mut pieces = scratch.take_pieces();
        event::all(range, from, out, |question, visit| {
            self.walk(ray, question, &mut pieces, visit);
        });
        scratch.give_pieces(pieces);
    }

    fn surface_at(&self, ray: &Ray, hit: &PrimHit) -> SurfacePoint {
        let p = ray.at(hit.t);
        let (field, gradient) = self.field(p);
        // One Newton step along the gradient.
        let step = gradient * ((self.threshold - field) / gradient.length_squared());
        let size = self.reach.size().max_element();
        let position = if step.length() < size { p + step } else { p };
        let (gradient, magnitude) = self.gradient_and_magnitude(position);
        let n = (-gradient).normalize_or(DVec3::Y);
        let (across, most) = (
            gamma(32) * magnitude / gradient.length(),
            gamma(1).sqrt() * size,
        );
        let across = if across < most { across } else { most };
        let error = point_error(position, size, 2) + DVec3::splat(across);
        SurfacePoint::bare(position, error, n)
    }

    fn as_solid(&self) -> Option<&dyn Solid> {
        Some(self)
    }

    /// Any map turns a blob into a blob.
    fn baked(&self, map: &Transform) -> Option<Shape> {
        let components = self.components.iter().map(|c| c.transformed(map));
        Some(Shape::from(Self::new(self.threshold, components.collect())))
    }
}

impl Solid for Blob {
    /// From the least and the greatest values of the single fields, which is exact far from the surface, and from the field and its gradient in
    /// the middle, which is exact to the second order.
    fn side_of(&self, cell: &Aabb) -> Option<bool> {
        let (center, half) = (cell.center(), cell.size() * 0.5);
        let (mut low, mut high, mut size) = (0.0, 0.0, self.threshold);
        let (mut middle, mut gradient, mut bend) = (0.0, DVec3::ZERO, 0.0);
        for component in &self.components {
            let (least, most) = component.field_in(cell);
            if least == 0.0 && most == 0.0 {
                continue;
            }
            let (field, slope) = component.field(center);
            low += least;
            high += most;
            size += component.strength().abs();
            middle += field;
            gradient += slope;
            bend += component.bend();
        }
        let reach = gradient.abs().dot(half) + 0.5 * bend * half.length_squared();
        let (low, high) = (low.max(middle - reach), high.min(middle + reach));
        let slack = 1e-9 * (size + reach);
        if high < self.threshold - slack {
            return Some(false);
        }
        (low > self.threshold + slack).then_some(true)
    }

    fn crossings(
        &self,
        ray: &Ray,
        range: Interval,
        from: Option<SurfaceId>,
        scratch: &mut Scratch,
        out: &mut Crossings,
    ) {
        let mut pieces = scratch.take_pieces();
        event::list(range, from, out, |question, visit| {
            self.walk(ray, question, &mut pieces, visit);
        });
        scratch.give_pieces(pieces);
    }

    fn contains(&self, point: DVec3) -> bool {
        self.field(point).0 >= self.threshold
    }
}

#[cfg(test)]
mod tests;
