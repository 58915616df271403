//! Meshes of files as subdivision surfaces.

use std::collections::HashMap;
use std::sync::Arc;
use strahl_geometry::{Shape, Subdivision, SubdivisionData, SubdivisionScheme, TriangleMesh};
use strahl_math::DVec3;
use strahl_scene::{Children, Diagnostic, Object, ObjectKind, Scene};

/// Replaces every mesh of a scene by the subdivision surface that it controls; returns what is wrong with those for which that is not
/// possible. A scene without meshes is an error, too.
///
/// Vertices at the same place are one, whatever their normals and texture coordinates. For Catmull and Clark's scheme, triangles that were
/// one polygon in the file are one face again. Each mesh is subdivided by itself: where two of them meet (a file has one for
/// each material) both end in the same smooth curve.
pub fn subdivide(scene: &mut Scene, scheme: SubdivisionScheme) -> Vec<Diagnostic> {
    let mut problems = vec![];
    let mut count = all(&mut scene.objects, scheme, &mut problems);
    for group in &mut scene.groups {
        count += all(&mut group.objects, scheme, &mut problems);
    }
    if count == 0 {
        let problem = Diagnostic::error("the scene has no mesh that could be subdivided");
        problems.push(problem.hint("meshes are in OBJ, PLY, STL and glTF files"));
    }
    problems
}

/// Returns how many meshes there were.
fn all(objects: &mut Children, scheme: SubdivisionScheme, problems: &mut Vec<Diagnostic>) -> usize {
    let mut count = 0;
    for object in &mut objects.0 {
        let found = match &mut object.kind {
            ObjectKind::Shape(Shape::TriangleMesh(mesh)) => surface(mesh, scheme),
            ObjectKind::Csg { children, .. } => {
                count += all(children, scheme, problems);
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

fn surface(mesh: &Arc<TriangleMesh>, scheme: SubdivisionScheme) -> Result<Shape, String> {
    let data = control_mesh(mesh, scheme)?;
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

    fn loaded(text: &str, format: &str, scheme: SubdivisionScheme) -> crate::Loaded {
        let options = LoadOptions {
            subdivide: Some(scheme),
            ..LoadOptions::default()
        };
        let format: Format = format.parse().expect("a format");
        load_bytes(text.into(), "file", format, options)
    }

    fn data(text: &str, format: &str, scheme: SubdivisionScheme) -> SubdivisionData {
        let scene = loaded(text, format, scheme).scene.expect("a scene");
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
            let loaded = loaded(text, format, SubdivisionScheme::Loop);
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
