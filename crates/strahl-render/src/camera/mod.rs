//! Primary rays: one or more for each position in the picture.

mod bundle;
mod lens;
mod mesh;
mod square;
mod wide;

pub(crate) use bundle::{NextRays, RayBundle};

use lens::LensSampler;
use mesh::FourFaces;
use strahl_accel::Beam;
use strahl_math::{DVec3, Ray};
use strahl_scene::{Camera, Projection};
use strahl_shade::Color;
use strahl_shade::patterns::TexturePoint;

/// Makes the primary rays of a picture.
#[derive(Clone, Debug)]
pub struct PrimaryRays {
    camera: Camera,
    width: f64,
    height: f64,
    lens: Option<LensSampler>,
    /// For each four meshes of a mesh camera, how their rays are made at once.
    fours: Vec<Option<FourFaces>>,
}

impl PrimaryRays {
    /// For a picture of `width` by `height` pixels.
    pub fn new(camera: &Camera, width: u32, height: u32) -> Self {
        let (width, height) = (f64::from(width), f64::from(height));
        let mut camera = camera.clone();
        camera.right *= camera.aspect.unwrap_or(width / height);
        Self {
            lens: LensSampler::new(&camera, [width, height]),
            fours: match &camera.projection {
                Projection::Mesh(mesh) => FourFaces::of(mesh),
                _ => vec![],
            },
            camera,
            width,
            height,
        }
    }

    /// The colour of a position in the picture, in pixels: `(0, 0)` is the top left corner of the picture, `(0.5, 0.5)` the
    /// centre of its first pixel. `trace` is called for each ray, with a unit direction; where the camera sees nothing it is
    /// not called.
    pub fn color(&self, x: f64, y: f64, mut trace: impl FnMut(&Ray) -> Color) -> Color {
        if self.is_sharp() {
            return self.ray(x, y).map_or(Color::BLACK, |ray| trace(&ray));
        }
        let more = |bundle: &mut RayBundle, rays: &mut NextRays| self.more(bundle, rays);
        self.bundle(x, y).traced(more, trace).mean().color
    }

    /// The rays of a position, for [`PrimaryRays::more`].
    pub(crate) fn bundle(&self, x: f64, y: f64) -> RayBundle {
        RayBundle::new(x, y)
    }

    /// Appends the rays of a position that come next, once all those before have been added to the bundle; none if there are enough.
    /// There must be fewer rays than a packet has; there are at most as many more afterwards.
    pub(crate) fn more(&self, bundle: &mut RayBundle, rays: &mut NextRays) {
        if let Projection::Mesh(mesh) = &self.camera.projection {
            self.more_of_mesh(mesh, bundle, rays);
        } else if let Some(lens) = &self.lens {
            lens.more(bundle, |x, y| self.chief::<false>(x, y), rays);
        }
    }

    /// The chief ray, through the centre of the lens; `None` where the camera sees nothing, and for mesh cameras with several rays for a pixel.
    #[inline]
    pub fn ray(&self, x: f64, y: f64) -> Option<Ray> {
        self.chief::<true>(x, y)
    }

    /// [`PrimaryRays::ray`], whose direction has length 1 if `UNIT` and any length if not.
    // Inline for the camera that nearly all scenes have, and nothing returned in memory by others: such a ray would be copied before its
    // stores have ended.
    #[inline(always)]
    fn chief<const UNIT: bool>(&self, x: f64, y: f64) -> Option<Ray> {
        let c = &self.camera;
        if self.is_special() {
            let mut ray = [DVec3::ZERO; 2];
            let [origin, direction] = &mut ray;
            return self
                .special_chief([x, y], origin, direction)
                .then(|| Ray::new(ray[0], ray[1]));
        }
        let [u, v] = self.on_film(x, y);
        let direction = c.direction + (c.right * u + c.up * v);
        Some(Ray::new(
            c.eye,
            match UNIT {
                true => direction.normalize(),
                false => direction,
            },
        ))
    }

    /// Whether the camera isn't perspective or has a `normal`.
    #[inline(always)]
    fn is_special(&self) -> bool {
        self.camera.normal.is_some() || !matches!(self.camera.projection, Projection::Perspective)
    }

    /// A position in the picture as coordinates from -1 to 1, the first to the right and the second upwards.
    #[inline(always)]
    fn on_film(&self, x: f64, y: f64) -> [f64; 2] {
        [2.0 * x / self.width - 1.0, 1.0 - 2.0 * y / self.height]
    }

    /// Stores the chief ray of a camera that isn't perspective or has a `normal`, at a position in the picture; its direction has length 1.
    /// Returns `false` where there is none.
    #[inline(never)]
    fn special_chief(&self, at: [f64; 2], origin: &mut DVec3, direction: &mut DVec3) -> bool {
        let Some(ray) = self.special_ray(at) else {
            return false;
        };
        (*origin, *direction) = (ray.origin, ray.direction);
        true
    }

    fn special_ray(&self, [x, y]: [f64; 2]) -> Option<Ray> {
        let c = &self.camera;
        if let Projection::Mesh(mesh) = &c.projection {
            return (!mesh::has_many_rays(mesh)).then(|| self.mesh_ray(mesh, (x, y), 0))?;
        }
        let [u, v] = self.on_film(x, y);
        let sideways = c.right * u + c.up * v;
        let (ray, place) = match &c.projection {
            Projection::Perspective => {
                let direction = (c.direction + sideways).normalize();
                (Ray::new(c.eye, direction), [0.5 * u, 0.5 * v])
            }
            Projection::Orthographic => {
                let direction = c.direction.normalize();
                (Ray::new(c.eye + sideways, direction), [0.5 * u, 0.5 * v])
            }
            _ => wide::ray(c, [u, v])?,
        };
        Some(match &c.normal {
            None => ray,
            Some(normal) => {
                let place = TexturePoint::in_space(DVec3::new(place[0], place[1], 0.0));
                let bent = normal.tilt(&place, ray.direction);
                Ray::new(ray.origin, bent.normalize_or(ray.direction))
            }
        })
    }

    /// Whether each position in the picture has at most one ray, that of [`PrimaryRays::ray`].
    pub(crate) fn is_sharp(&self) -> bool {
        match &self.camera.projection {
            Projection::Mesh(mesh) => !mesh::has_many_rays(mesh),
            _ => self.lens.is_none(),
        }
    }

    /// The beam of all rays through a rectangle of the picture, given by two opposite corners; `None` for other projections
    /// than perspective and orthographic, and for cameras with a lens or a `normal`.
    pub(crate) fn beam(&self, low: [f64; 2], high: [f64; 2]) -> Option<Beam> {
        let flat = matches!(
            self.camera.projection,
            Projection::Perspective | Projection::Orthographic
        );
        if !flat || self.lens.is_some() || self.camera.normal.is_some() {
            return None;
        }
        let ([x0, y0], [x1, y1]) = (low, high);
        Beam::between(&[
            self.ray(x0, y0)?,
            self.ray(x1, y0)?,
            self.ray(x1, y1)?,
            self.ray(x0, y1)?,
        ])
    }
}

#[cfg(test)]
mod tests;
