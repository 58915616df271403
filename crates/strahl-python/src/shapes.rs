//! Constructors of shapes: numbers are checked by the shapes themselves, kinds and shapes of arrays by the Python half.

use crate::convert::{Triple, contiguous, list, vector, vectors, vectors_2};
use crate::object::{Object, Piece};
use crate::{errors, work};
use hashbrown::HashMap;
use numpy::{PyReadonlyArray1, PyReadonlyArray2, PyReadonlyArray3, PyUntypedArrayMethods};
use pyo3::prelude::*;
use std::sync::Arc;
use strahl::geometry::{
    Blob, BlobComponent, GeometryError, GridIsosurface, GridOptions, HeightField, Lathe,
    Polynomial, Primitive, Prism, PrismSweep, Shape, Sor, SphereSweep, Spline, Superellipsoid,
    SweepSpline,
};
use strahl::math::DVec3;
use strahl::prelude::{
    Brep, Color, Cone, CsgOp, Cuboid, Cylinder, Disc, Lemon, MeshData, Ovus, Plane, Polygon,
    Quadric, Sphere, Torus, TriangleMesh,
};
use strahl::scene;

/// The line of the program that makes an object.
pub(crate) type Place = Option<(String, u32)>;

/// A checked shape as an object.
pub(crate) fn object(shape: impl Into<Shape>, place: Place) -> PyResult<Object> {
    let shape = shape.into();
    shape.validate().map_err(errors::value)?;
    Ok(Object::new(shape.into(), place))
}

/// Adds all functions to the module.
pub(crate) fn register(module: &Bound<'_, PyModule>) -> PyResult<()> {
    macro_rules! add {
        ($($name:ident)+) => { $(module.add_function(wrap_pyfunction!($name, module)?)?;)+ };
    }
    add!(sphere plane cuboid disc cylinder cone torus ovus lemon quadric superellipsoid polygon mesh spheres);
    add!(blob prism lathe sor sphere_sweep polynomial height_field isosurface);
    Ok(())
}

#[pyfunction]
fn sphere(center: Triple, radius: f64, place: Place) -> PyResult<Object> {
    object(Sphere::new(vector(center), radius), place)
}

#[pyfunction]
fn plane(point: Triple, normal: Triple, place: Place) -> PyResult<Object> {
    object(Plane::new(vector(point), vector(normal)), place)
}

#[pyfunction]
fn cuboid(a: Triple, b: Triple, place: Place) -> PyResult<Object> {
    object(Cuboid::from_corners(vector(a), vector(b)), place)
}

#[pyfunction]
fn disc(center: Triple, normal: Triple, radius: f64, hole: f64, place: Place) -> PyResult<Object> {
    let disc = Disc::new(vector(center), vector(normal), radius, hole);
    object(disc, place)
}

#[pyfunction]
fn cylinder(base: Triple, apex: Triple, radius: f64, open: bool, place: Place) -> PyResult<Object> {
    let (base, apex) = (vector(base), vector(apex));
    match open {
        true => object(Cylinder::open(base, apex, radius), place),
        false => object(Cylinder::new(base, apex, radius), place),
    }
}

#[pyfunction]
fn cone(
    base: Triple,
    base_radius: f64,
    apex: Triple,
    apex_radius: f64,
    open: bool,
    place: Place,
) -> PyResult<Object> {
    let (base, apex) = (vector(base), vector(apex));
    match open {
        true => object(Cone::open(base, base_radius, apex, apex_radius), place),
        false => object(Cone::new(base, base_radius, apex, apex_radius), place),
    }
}

#[pyfunction]
fn torus(center: Triple, axis: Triple, major: f64, minor: f64, place: Place) -> PyResult<Object> {
    object(
        Torus::new(vector(center), vector(axis), major, minor),
        place,
    )
}

#[pyfunction]
fn ovus(bottom: f64, top: f64, place: Place) -> PyResult<Object> {
    let ovus = Ovus::try_new(bottom, top).map_err(errors::value)?;
    object(Arc::new(ovus), place)
}

#[pyfunction]
fn lemon(
    base: Triple,
    base_radius: f64,
    apex: Triple,
    apex_radius: f64,
    inner: f64,
    place: Place,
) -> PyResult<Object> {
    let lemon = Lemon::try_new(vector(base), base_radius, vector(apex), apex_radius, inner);
    object(Arc::new(lemon.map_err(errors::value)?), place)
}

#[pyfunction]
fn quadric(coefficients: [f64; 10], place: Place) -> PyResult<Object> {
    let quadric = Quadric::try_new(coefficients).map_err(errors::value)?;
    object(Arc::new(quadric), place)
}

#[pyfunction]
fn superellipsoid(e: f64, n: f64, place: Place) -> PyResult<Object> {
    object(Superellipsoid::try_new(e, n).map_err(errors::value)?, place)
}

#[pyfunction]
fn polygon(
    corners: PyReadonlyArray2<'_, f64>,
    holes: Vec<PyReadonlyArray2<'_, f64>>,
    place: Place,
) -> PyResult<Object> {
    let corners = vectors(&corners)?;
    let holes: PyResult<Vec<Vec<DVec3>>> = holes.iter().map(vectors).collect();
    let polygon = Polygon::try_with_holes(&corners, &holes?).map_err(errors::value)?;
    object(polygon, place)
}

/// Vertices of a mesh, as NumPy has them.
#[derive(FromPyObject)]
enum Vertices<'py> {
    Single(PyReadonlyArray2<'py, f32>),
    Double(PyReadonlyArray2<'py, f64>),
}

/// Vertex numbers of a mesh, as NumPy has them.
#[derive(FromPyObject)]
enum Faces<'py> {
    Unsigned(PyReadonlyArray2<'py, u32>),
    Signed(PyReadonlyArray2<'py, i32>),
    Long(PyReadonlyArray2<'py, i64>),
}

impl Faces<'_> {
    /// The faces as meshes store them: read once, written once.
    fn list(&self, vertices: usize) -> PyResult<Vec<[u32; 3]>> {
        fn checked<T: Copy + Into<i64>>(faces: &[T], vertices: usize) -> PyResult<Vec<[u32; 3]>> {
            let (rows, _) = faces.as_chunks::<3>();
            let vertex = |row: usize, number: T| {
                let number: i64 = number.into();
                let known = usize::try_from(number).is_ok_and(|n| n < vertices);
                let kept = u32::try_from(number).ok().filter(|_| known);
                kept.ok_or_else(|| {
                    errors::value(format!(
                        "faces: row {row} has the vertex {number}; the {vertices} vertices are numbered from 0"
                    ))
                })
            };
            let mut list = Vec::with_capacity(rows.len());
            for (row, &[a, b, c]) in rows.iter().enumerate() {
                list.push([vertex(row, a)?, vertex(row, b)?, vertex(row, c)?]);
            }
            Ok(list)
        }
        match self {
            Self::Unsigned(faces) => checked(contiguous(faces)?, vertices),
            Self::Signed(faces) => checked(contiguous(faces)?, vertices),
            Self::Long(faces) => checked(contiguous(faces)?, vertices),
        }
    }
}

/// Triangles, or the solid within them. f32 vertices are kept as they are, f64 ones are rounded relative to an anchor.
///
/// Every number is copied once, straight into the mesh: Python may change or free its arrays at any time, also while other threads render.
#[pyfunction]
fn mesh(
    py: Python<'_>,
    vertices: Vertices<'_>,
    faces: Faces<'_>,
    normals: Option<PyReadonlyArray2<'_, f32>>,
    uvs: Option<PyReadonlyArray2<'_, f32>>,
    solid: bool,
    place: Place,
) -> PyResult<Object> {
    let mut data = match &vertices {
        Vertices::Single(vertices) => {
            let positions = contiguous(vertices)?.as_chunks::<3>().0.to_vec();
            MeshData {
                indices: faces.list(positions.len())?,
                positions,
                ..MeshData::default()
            }
        }
        Vertices::Double(vertices) => {
            let (rows, _) = contiguous(vertices)?.as_chunks::<3>();
            MeshData::from_f64(rows, faces.list(rows.len())?)
        }
    };
    if let Some(normals) = normals {
        data.normals = Some(contiguous(&normals)?.as_chunks::<3>().0.to_vec());
    }
    if let Some(uvs) = uvs {
        data.uvs = Some(contiguous(&uvs)?.as_chunks::<2>().0.to_vec());
    }
    let shape = work::run(py, move || {
        let mesh = TriangleMesh::try_new(data)?;
        Ok(match solid {
            true => Shape::from(Arc::new(Brep::try_new(mesh)?)),
            false => Arc::new(mesh).into(),
        })
    })?;
    object(
        shape.map_err(|error: GeometryError| errors::value(error))?,
        place,
    )
}

/// Many spheres. Those of the same colour share a material, which is made by `material` from the colour.
#[pyfunction]
fn spheres(
    centers: PyReadonlyArray2<'_, f64>,
    radii: PyReadonlyArray1<'_, f64>,
    colors: Option<PyReadonlyArray2<'_, f64>>,
    specular: f64,
    shininess: f64,
    place: Place,
) -> PyResult<Object> {
    let (centers, _) = contiguous(&centers)?.as_chunks::<3>();
    let radii = list(&radii)?;
    let colors = match &colors {
        None => &[][..],
        Some(colors) => contiguous(colors)?.as_chunks::<3>().0,
    };
    let mut materials = HashMap::new();
    let mut children = Vec::with_capacity(centers.len());
    for (number, (center, radius)) in centers.iter().zip(radii).enumerate() {
        let sphere = Sphere::try_new(DVec3::from_array(*center), *radius)
            .map_err(|error| errors::value(format!("sphere {number}: {error}")))?;
        let mut child = scene::Object::from(sphere);
        if let Some(&[r, g, b]) = colors.get(number) {
            let key = [r, g, b].map(f64::to_bits);
            let material = materials.entry(key).or_insert_with(|| {
                let color = Color::new(r, g, b);
                Arc::new(strahl::prelude::Material::shiny(color, specular, shininess))
            });
            child.material = Some(Arc::clone(material));
        }
        children.push(child);
    }
    let union = scene::Object::csg(CsgOp::Union, children);
    let mut piece = Piece::new(union, place.as_ref());
    piece.depth = 2;
    Ok(Object(Arc::new(piece)))
}

/// Rows of balls (x, y, z, radius, strength) and capsules (x, y, z, x, y, z, radius, strength).
#[pyfunction]
fn blob(
    threshold: f64,
    balls: Vec<[f64; 5]>,
    capsules: Vec<[f64; 8]>,
    place: Place,
) -> PyResult<Object> {
    let balls = balls.into_iter().map(|[x, y, z, radius, strength]| {
        BlobComponent::sphere(DVec3::new(x, y, z), radius, strength)
    });
    let capsules = capsules
        .into_iter()
        .map(|[x, y, z, u, v, w, radius, strength]| {
            let (first, second) = (DVec3::new(x, y, z), DVec3::new(u, v, w));
            BlobComponent::cylinder(first, second, radius, strength)
        });
    let blob = Blob::try_new(threshold, balls.chain(capsules).collect()).map_err(errors::value)?;
    object(Arc::new(blob), place)
}

fn spline(name: &str) -> PyResult<Spline> {
    Ok(match name {
        "linear" => Spline::Linear,
        "quadratic" => Spline::Quadratic,
        "cubic" => Spline::Cubic,
        "bezier" => Spline::Bezier,
        other => {
            return Err(errors::value(format!(
                "there is no spline `{other}`; the splines are linear, quadratic, cubic and bezier"
            )));
        }
    })
}

#[pyfunction]
fn prism(
    points: PyReadonlyArray2<'_, f64>,
    heights: [f64; 2],
    curve: &str,
    conic: bool,
    open: bool,
    place: Place,
) -> PyResult<Object> {
    let sweep = match conic {
        true => PrismSweep::Conic,
        false => PrismSweep::Linear,
    };
    let prism = Prism::try_new(spline(curve)?, sweep, heights, &vectors_2(&points)?, open)
        .map_err(errors::value)?;
    object(Arc::new(prism), place)
}

#[pyfunction]
fn lathe(points: PyReadonlyArray2<'_, f64>, curve: &str, place: Place) -> PyResult<Object> {
    let lathe = Lathe::try_new(spline(curve)?, &vectors_2(&points)?).map_err(errors::value)?;
    object(Arc::new(lathe), place)
}

#[pyfunction]
fn sor(points: PyReadonlyArray2<'_, f64>, open: bool, place: Place) -> PyResult<Object> {
    let sor = Sor::try_new(&vectors_2(&points)?, open).map_err(errors::value)?;
    object(Arc::new(sor), place)
}

#[pyfunction]
fn sphere_sweep(
    centers: PyReadonlyArray2<'_, f64>,
    radii: PyReadonlyArray1<'_, f64>,
    curve: &str,
    place: Place,
) -> PyResult<Object> {
    let spline = match curve {
        "linear" => SweepSpline::Linear,
        "bspline" => SweepSpline::BSpline,
        "cubic" => SweepSpline::Cubic,
        other => {
            return Err(errors::value(format!(
                "there is no spline `{other}`; the splines of sweeps are linear, bspline and cubic"
            )));
        }
    };
    let spheres: Vec<(DVec3, f64)> = vectors(&centers)?
        .into_iter()
        .zip(list(&radii)?.iter().copied())
        .collect();
    let sweep = SphereSweep::try_new(spline, &spheres).map_err(errors::value)?;
    object(Arc::new(sweep), place)
}

/// Terms `(i, j, k, c)` stand for `c xⁱ yʲ zᵏ`.
#[pyfunction]
fn polynomial(terms: Vec<(u32, u32, u32, f64)>, place: Place) -> PyResult<Object> {
    let terms = terms.into_iter().map(|(i, j, k, c)| ([i, j, k], c));
    let polynomial = Polynomial::try_new(terms).map_err(errors::value)?;
    object(Arc::new(polynomial), place)
}

/// A height field on the unit square from heights in units of 1/65536; the first row lies at z = 1.
#[pyfunction]
fn height_field(
    heights: PyReadonlyArray2<'_, u16>,
    width: u32,
    depth: u32,
    water_level: f64,
    smooth: bool,
    place: Place,
) -> PyResult<Object> {
    let rows = contiguous(&heights)?.to_vec();
    let field =
        HeightField::try_new(width, depth, rows, water_level, smooth).map_err(errors::value)?;
    object(Arc::new(field), place)
}

/// The surface of samples at the points with whole coordinates.
#[pyfunction]
fn isosurface(
    values: PyReadonlyArray3<'_, f32>,
    level: f64,
    inside_below: bool,
    open: bool,
    smooth: bool,
    place: Place,
) -> PyResult<Object> {
    let mut samples = [0; 3];
    for (sample, &count) in samples.iter_mut().zip(values.shape()) {
        *sample = u32::try_from(count).map_err(errors::value)?;
    }
    let options = GridOptions {
        level,
        inside_below,
        open,
        smooth,
    };
    let list = values.as_slice().map_err(errors::value)?.to_vec();
    let surface = GridIsosurface::try_new(samples, list, options).map_err(errors::value)?;
    object(Arc::new(surface), place)
}
