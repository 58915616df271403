//! Meshes of files as subdivision surfaces.

use std::collections::HashMap;
use std::str::FromStr;
use std::sync::Arc;
use strahl_geometry::{Shape, Subdivision, SubdivisionData, SubdivisionScheme, TriangleMesh};
use strahl_math::DVec3;
use strahl_scene::{Children, Diagnostic, Object, ObjectKind, Scene};

/// The sharpness of edges that stay sharp for ever.
const SHARP: f64 = 10.0;

/// How the meshes of a file are subdivided.
///
/// As a text, such as `loop` or `catmull-clark:crease=30`: the scheme, and the angle of creases in degrees.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SubdivideOptions {
    /// The scheme.
    pub scheme: SubdivisionScheme,
    /// Edges are sharp where the normals of their two faces differ by more than this, in degrees from 0 to 180; `None` makes no edge
    /// sharp but those of one face only, which always are.
    pub crease_angle: Option<f64>,
}

impl From<SubdivisionScheme> for SubdivideOptions {
    fn from(scheme: SubdivisionScheme) -> Self {
        Self {
            scheme,
            crease_angle: None,
        }
    }
}

impl FromStr for SubdivideOptions {
    type Err = String;

    fn from_str(s: &str) -> Result<Self, String> {
        let (scheme, option) = match s.split_once(':') {
            None => (s, None),
            Some((scheme, option)) => (scheme, Some(option)),
        };
        let scheme = match scheme {
            "catmull-clark" => SubdivisionScheme::CatmullClark,
            "loop" => SubdivisionScheme::Loop,
            _ => return Err("the schemes are `catmull-clark` and `loop`".to_owned()),
        };
        let Some(option) = option else {
            return Ok(scheme.into());
        };
        let value = option.strip_prefix("crease=").ok_or_else(|| {
            format!("`{option}` is not known: edges are made sharp with `crease=DEGREES`, such as `crease=30`")
        })?;
        let angle = value
            .parse()
            .ok()
            .filter(|angle| (0.0..=180.0).contains(angle));
        let angle =
            angle.ok_or_else(|| format!("`{value}` is not an angle from 0 to 180 degrees"))?;
        Ok(Self {
            scheme,
            crease_angle: Some(angle),
        })
    }
}

/// Replaces every mesh of a scene by the subdivision surface that it controls; returns what is wrong with those for which that is not
/// possible. A scene without meshes is an error, too.
///
/// Vertices at the same place are one, whatever their normals and texture coordinates. For Catmull and Clark's scheme, triangles that were
/// one polygon in the file are one face again. Each mesh is subdivided by itself: where two of them meet (a file has one for
/// each material) both end in the same smooth curve.
pub fn subdivide(scene: &mut Scene, options: SubdivideOptions) -> Vec<Diagnostic> {
    let mut problems = vec![];
    let mut count = all(&mut scene.objects, options, &mut problems);
    for group in &mut scene.groups {
        count += all(&mut group.objects, options, &mut problems);
    }
    if count == 0 {
        let problem = Diagnostic::error("the scene has no mesh that could be subdivided");
        problems.push(problem.hint("meshes are in OBJ, PLY, STL and glTF files"));
    }
    problems
}

/// Returns how many meshes there were.
fn all(objects: &mut Children, options: SubdivideOptions, problems: &mut Vec<Diagnostic>) -> usize {
    let mut count = 0;
    for object in &mut objects.0 {
        let found = match &mut object.kind {
            ObjectKind::Shape(Shape::TriangleMesh(mesh)) => surface(mesh, options),
            ObjectKind::Csg { children, .. } => {
                count += all(children, options, problems);
                continue;
            }
            _ => continue,
        };
        count += 1;
        match found {
            Ok(shape) => object.kind = ObjectKind::Shape(shape),
            Err(why) => problems.push(problem(object, &why)),
        }
    }
    count
}

fn problem(object: &Object, why: &str) -> Diagnostic {
    let name = object.name.as_deref().unwrap_or("a mesh");
    Diagnostic::error(format!("`{name}` cannot be subdivided: {why}")).at(object.span)
}

fn surface(mesh: &Arc<TriangleMesh>, options: SubdivideOptions) -> Result<Shape, String> {
    let mut data = control_mesh(mesh, options.scheme)?;
    if let Some(angle) = options.crease_angle {
        data.creases = creases(&data, angle);
    }
    let surface = Subdivision::try_new(&data).map_err(|error| error.to_string())?;
    Ok(surface.into())
}

/// The mesh with polygons for faces.
fn control_mesh(mesh: &TriangleMesh, scheme: SubdivisionScheme) -> Result<SubdivisionData, String> {
    let mut data = SubdivisionData {
        scheme,
        ..SubdivisionData::default()
    };
    // Vertices at the same place are one.
    let mut known: HashMap<[u32; 3], u32> = HashMap::new();
    let mut numbers = Vec::with_capacity(mesh.positions().len());
    for position in mesh.positions() {
        // -0 is 0.
        let number = *known
            .entry(position.map(|x| (x + 0.0).to_bits()))
            .or_insert_with(|| {
                let offset = DVec3::from(position.map(f64::from));
                data.points.push(mesh.anchor() + offset);
                data.points.len() as u32 - 1
            });
        numbers.push(number);
    }
    let triangles = mesh.indices();
    let mut start = 0;
    while start < triangles.len() {
        let mut end = start + 1;
        let is_joined = scheme == SubdivisionScheme::CatmullClark;
        while is_joined && end < triangles.len() && mesh.continues_polygon(end as u32) {
            end += 1;
        }
        let mut polygon = outline(&triangles[start..end]).ok_or_else(|| {
            let line = mesh.face_line(start as u32);
            let place = line.map_or_else(
                || format!("with triangle {start} (counted from 0)"),
                |line| format!("in line {line}"),
            );
            format!("the triangles of the polygon {place} have no simple outline")
        })?;
        start = end;
        if mesh.fronts_are_clockwise() {
            polygon.reverse();
        }
        let corners: Vec<u32> = polygon.iter().map(|v| numbers[*v as usize]).collect();
        // A triangle with two corners at the same place has no area, and no neighbours that could miss it.
        if let [a, b, c] = corners[..]
            && (a == b || b == c || c == a)
        {
            continue;
        }
        data.sizes.push(corners.len() as u32);
        data.indices.extend(corners);
        data.uvs.extend(polygon.iter().filter_map(|v| mesh.uv(*v)));
    }
    Ok(data)
}

/// The edges at which the normals of two faces differ by more than an angle in degrees.
fn creases(data: &SubdivisionData, angle: f64) -> Vec<([u32; 2], f64)> {
    let least = angle.to_radians().cos();
    let mut creases = vec![];
    // The normal of the face that came first.
    let mut known: HashMap<[u32; 2], DVec3> = HashMap::new();
    let mut corners = data.indices.as_slice();
    for size in &data.sizes {
        let (face, rest) = corners.split_at(*size as usize);
        corners = rest;
        let normal = normal(face.iter().map(|v| data.points[*v as usize]));
        for (k, a) in face.iter().enumerate() {
            let b = face[(k + 1) % face.len()];
            let edge = [*a.min(&b), *a.max(&b)];
            match known.insert(edge, normal) {
                Some(other) if normal.dot(other) < least => creases.push((edge, SHARP)),
                _ => {}
            }
        }
    }
    creases
}

/// The mean normal of a polygon (M. Newell), of length 1; 0 if it has no area.
fn normal(corners: impl Iterator<Item = DVec3> + Clone) -> DVec3 {
    let next = corners.clone().skip(1).chain(corners.clone().take(1));
    let area: DVec3 = corners.zip(next).map(|(a, b)| a.cross(b)).sum();
    area.normalize_or_zero()
}

/// The corners of the polygon that triangles make, in their order.
fn outline(triangles: &[[u32; 3]]) -> Option<Vec<u32>> {
    if let [triangle] = triangles {
        return Some(triangle.to_vec());
    }
    let mut next: HashMap<u32, u32> = HashMap::new();
    let sides = |[a, b, c]: &[u32; 3]| [(*a, *b), (*b, *c), (*c, *a)];
    let all: std::collections::HashSet<(u32, u32)> = triangles.iter().flat_map(sides).collect();
    for (a, b) in triangles.iter().flat_map(sides) {
        if !all.contains(&(b, a)) && next.insert(a, b).is_some() {
            return None;
        }
    }
    let first = triangles.first()?[0];
    let mut polygon = vec![first];
    let mut at = *next.get(&first)?;
    while at != first {
        if polygon.len() > next.len() {
            return None;
        }
        polygon.push(at);
        at = *next.get(&at)?;
    }
    (polygon.len() == next.len()).then_some(polygon)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Format, LoadOptions, load_bytes};
    use strahl_geometry::Primitive as _;

    const CUBE: &str = "v -1 -1 -1\nv 1 -1 -1\nv -1 1 -1\nv 1 1 -1\nv -1 -1 1\nv 1 -1 1\nv -1 1 1\nv 1 1 1\n\
        f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n";
    const PLY: &str = "ply\nformat ascii 1.0\nelement vertex 8\nproperty float x\nproperty float y\nproperty float z\n\
        element face 6\nproperty list uchar int vertex_indices\nend_header\n\
        -1 -1 -1\n1 -1 -1\n-1 1 -1\n1 1 -1\n-1 -1 1\n1 -1 1\n-1 1 1\n1 1 1\n\
        4 0 2 3 1\n4 4 5 7 6\n4 0 1 5 4\n4 2 6 7 3\n4 0 4 6 2\n4 1 3 7 5\n";

    fn loaded(text: &str, format: &str, options: SubdivideOptions) -> crate::Loaded {
        let options = LoadOptions {
            subdivide: Some(options),
            ..LoadOptions::default()
        };
        let format: Format = format.parse().expect("a format");
        load_bytes(text.into(), "file", format, options)
    }

    fn data(text: &str, format: &str, options: impl Into<SubdivideOptions>) -> SubdivisionData {
        let scene = loaded(text, format, options.into()).scene.expect("a scene");
        match &scene.objects.0[0].kind {
            ObjectKind::Shape(Shape::Subdivision(surface)) => surface.data().clone(),
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn polygons_of_files_stay_polygons() {
        for (text, format) in [(CUBE, "obj"), (PLY, "ply")] {
            let cube = data(text, format, SubdivisionScheme::CatmullClark);
            assert_eq!((cube.points.len(), cube.sizes.as_slice()), (8, &[4; 6][..]));
            let triangles = data(text, format, SubdivisionScheme::Loop);
            assert_eq!(triangles.sizes, [3; 12], "{format}");
        }
        let pentagon = "v 0 0 0\nv 2 0 0\nv 1 1 0\nv 2 2 0\nv 0 2 0\nf 1 2 3 4 5\n";
        let found = data(pentagon, "obj", SubdivisionScheme::CatmullClark);
        assert_eq!(found.sizes, [5]);
    }

    /// Corners with texture coordinates of their own are one vertex, and keep these.
    #[test]
    fn vertices_at_one_place_are_one() {
        let text = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 0 0\nv 2 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n\
            f 1/1 2/2 3/3 4/4\nf 2/1 5/2 6/3 3/4\n";
        let found = data(text, "obj", SubdivisionScheme::CatmullClark);
        assert_eq!((found.points.len(), found.uvs.len()), (6, 8));
        assert_eq!(found.uvs[0], found.uvs[4]);
    }

    /// A cube of 24 vertices, four for each side as other programs write them, and two triangles for each side. The buffer is in the file.
    fn gltf_cube() -> String {
        const DIGITS: &[u8; 64] =
            b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
        let sides = [
            [0, 2, 3, 1],
            [4, 5, 7, 6],
            [0, 1, 5, 4],
            [2, 6, 7, 3],
            [0, 4, 6, 2],
            [1, 3, 7, 5],
        ];
        let corners = sides
            .iter()
            .flatten()
            .flat_map(|n| [n & 1, n >> 1 & 1, n >> 2]);
        let mut bytes: Vec<u8> = corners
            .flat_map(|bit| (2.0 * bit as f32 - 1.0).to_le_bytes())
            .collect();
        bytes.extend((0..6).flat_map(|s| [0, 1, 2, 0, 2, 3].map(|k| 4 * s + k)));
        // Its length is a multiple of three.
        let text: String = bytes
            .chunks(3)
            .flat_map(|c| {
                [
                    c[0] >> 2,
                    (c[0] << 4 | c[1] >> 4) & 63,
                    (c[1] << 2 | c[2] >> 6) & 63,
                    c[2] & 63,
                ]
            })
            .map(|digit| char::from(DIGITS[usize::from(digit)]))
            .collect();
        format!(
            r#"{{"asset":{{"version":"2.0"}},
            "buffers":[{{"byteLength":324,"uri":"data:application/octet-stream;base64,{text}"}}],
            "bufferViews":[{{"buffer":0,"byteLength":288}},{{"buffer":0,"byteOffset":288,"byteLength":36}}],
            "accessors":[
              {{"bufferView":0,"componentType":5126,"count":24,"type":"VEC3","min":[-1,-1,-1],"max":[1,1,1]}},
              {{"bufferView":1,"componentType":5121,"count":36,"type":"SCALAR"}}],
            "meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}},"indices":1}}]}}],
            "scene":0,"scenes":[{{"nodes":[0]}}],"nodes":[{{"mesh":0}}]}}"#
        )
    }

    fn creased(text: &str, format: &str, options: &str) -> SubdivisionData {
        data(
            text,
            format,
            options.parse::<SubdivideOptions>().expect("options"),
        )
    }

    /// The edges of a cube, but not the diagonals of its sides, which are at 90 degrees. A cube that is sharp everywhere is a cube.
    #[test]
    fn edges_above_the_angle_of_creases_are_sharp() {
        for scheme in ["catmull-clark", "loop"] {
            for (text, format) in [(CUBE, "obj"), (PLY, "ply"), (&gltf_cube(), "gltf")] {
                let cube = creased(text, format, &format!("{scheme}:crease=89"));
                assert_eq!(cube.creases.len(), 12, "{scheme} {format}");
                let surface = Subdivision::try_new(&cube).expect("a surface");
                let solid = surface.as_solid().expect("a solid");
                assert!(solid.contains(DVec3::splat(0.999)), "{scheme} {format}");
                assert!(!solid.contains(DVec3::splat(1.001)), "{scheme} {format}");
                let round = creased(text, format, &format!("{scheme}:crease=91"));
                assert!(round.creases.is_empty(), "{scheme} {format}");
            }
        }
        // A roof over two triangles, whose normals are at 60 degrees.
        let roof = "v 0 0 0\nv 1 0 0\nv 0.5 1 0\nv 0.5 -0.5 0.8660254\nf 1 2 3\nf 2 1 4\n";
        assert_eq!(creased(roof, "obj", "loop:crease=59").creases.len(), 1);
        assert_eq!(creased(roof, "obj", "loop:crease=61").creases.len(), 0);
    }

    #[test]
    fn options_are_read() {
        let read = |s: &str| s.parse::<SubdivideOptions>();
        let angle = |s: &str| read(s).map(|options| options.crease_angle);
        assert_eq!(read("loop"), Ok(SubdivisionScheme::Loop.into()));
        assert_eq!(angle("catmull-clark:crease=30"), Ok(Some(30.0)));
        assert_eq!(angle("loop:crease=0"), Ok(Some(0.0)));
        for bad in [
            "loop:crease=181",
            "loop:crease=-1",
            "loop:crease=nan",
            "loop:crease=",
            "loop:",
        ] {
            assert!(read(bad).is_err(), "{bad}");
        }
        assert!(read("loop:creases=3").is_err_and(|e| e.contains("`crease=DEGREES`")));
    }

    /// Files in glTF know triangles only; those of a cube's sides meet, and it has an inside.
    #[test]
    fn triangles_of_gltf_are_one_surface() {
        let triangles = CUBE.replace("f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n", "\
            f 1 3 4\nf 1 4 2\nf 5 6 8\nf 5 8 7\nf 1 2 6\nf 1 6 5\nf 3 7 8\nf 3 8 4\nf 1 5 7\nf 1 7 3\nf 2 4 8\nf 2 8 6\n");
        for scheme in [SubdivisionScheme::CatmullClark, SubdivisionScheme::Loop] {
            let found = data(&gltf_cube(), "gltf", scheme);
            assert_eq!((found.scheme, found.points.len()), (scheme, 8));
            assert_eq!(found.sizes, [3; 12]);
            // The points are those of the other format in another order.
            let faces = |data: &SubdivisionData| {
                let corners = data.indices.iter().map(|n| data.points[*n as usize]);
                corners.map(|p| p.to_array()).collect::<Vec<_>>()
            };
            assert_eq!(faces(&found), faces(&data(&triangles, "obj", scheme)));
            let surface = Subdivision::try_new(&found).expect("a surface");
            assert!(surface.as_solid().is_some());
        }
    }

    #[test]
    fn what_is_no_surface_is_explained() {
        let fan = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 0 -1 0\nf 1 2 3\nf 1 2 4\nf 2 1 5\n";
        let pov = "sphere { 0, 1 }";
        let ball = "s 0 0 0 1\n";
        for (text, format, expected) in [
            (fan, "obj", "3 faces meet at the edge"),
            (ball, "nff", "no mesh that could be subdivided"),
            (pov, "pov", "write a `subdivision { }` object"),
        ] {
            let loaded = loaded(text, format, SubdivisionScheme::Loop.into());
            assert!(loaded.scene.is_none());
            let all: Vec<String> = loaded
                .diagnostics
                .iter()
                .map(|d| format!("{d} {:?}", d.hints))
                .collect();
            assert!(all.iter().any(|m| m.contains(expected)), "{all:?}");
        }
    }
}
