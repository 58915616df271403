use super::faces::Faces;
use super::header::{Element, Encoding, Header, Property, Scalar};
use super::positions::Positions;
use super::source::{Source, list_length};
use crate::input::report::{Fallible, Report};
use crate::mesh::{COLORS_HINT, COLORS_IGNORED};
use strahl_geometry::MeshData;
use strahl_math::DVec3;
use strahl_scene::Diagnostic;

/// The use of a vertex property: the place of its value, or none.
type Use = Option<usize>;

/// Places of values in a vertex row.
const POSITION: usize = 0;
const NORMAL: usize = 3;
const UV: usize = 6;
const VALUES: usize = 8;

/// The names of the properties that are used, with their places.
const USED: [(&str, usize); 14] = [
    ("x", POSITION),
    ("y", POSITION + 1),
    ("z", POSITION + 2),
    ("nx", NORMAL),
    ("ny", NORMAL + 1),
    ("nz", NORMAL + 2),
    ("s", UV),
    ("t", UV + 1),
    ("u", UV),
    ("v", UV + 1),
    ("texture_u", UV),
    ("texture_v", UV + 1),
    ("texture_s", UV),
    ("texture_t", UV + 1),
];

/// Reads the rows.
pub(super) struct Body<'h, 'r> {
    header: &'h Header,
    name: &'h str,
    report: &'r mut Report,
    positions: Positions,
    normals: Option<Vec<[f32; 3]>>,
    uvs: Option<Vec<[f32; 2]>>,
    /// Whether there are positions that are not finite.
    has_odd_positions: bool,
    faces: Faces,
}

impl<'h, 'r> Body<'h, 'r> {
    /// Checks everything that can be checked before the rows.
    pub(super) fn new(header: &'h Header, name: &'h str, report: &'r mut Report) -> Fallible<Self> {
        let fail =
            |problem: String| Err(Box::new(Diagnostic::error(format!("`{name}`: {problem}"))));
        let Some(vertices) = header.elements.iter().position(|e| e.name == "vertex") else {
            return fail("the header declares no element `vertex`".into());
        };
        if let Some(early) = header.elements[..vertices]
            .iter()
            .find(|e| e.name == "face" || e.name == "tristrips")
        {
            return fail(format!(
                "element `{}` comes before element `vertex`; only the usual order is read",
                early.name
            ));
        }
        if let Some((i, twice)) = header
            .elements
            .iter()
            .enumerate()
            .find(|(i, e)| e.name == "vertex" && *i > vertices)
        {
            return fail(format!(
                "element `{}` is declared twice (the second time as element {})",
                twice.name,
                i + 1
            ));
        }
        let properties = &header.elements[vertices].properties;
        let scalar = |name: &str| {
            properties
                .iter()
                .find(|p| p.name == name && p.length.is_none())
        };
        for axis in ["x", "y", "z"] {
            if scalar(axis).is_none() {
                return fail(format!("the vertices have no property `{axis}`"));
            }
        }
        let has = |names: &[&str]| names.iter().all(|n| scalar(n).is_some());
        let single = ["x", "y", "z"]
            .iter()
            .all(|n| scalar(n).is_some_and(|p| p.scalar == Scalar::F32));
        let with_uv = [
            ["s", "t"],
            ["u", "v"],
            ["texture_u", "texture_v"],
            ["texture_s", "texture_t"],
        ]
        .iter()
        .any(|pair| has(pair));
        if has(&["red", "green", "blue"]) || has(&["diffuse_red", "diffuse_green", "diffuse_blue"])
        {
            report.warning(|| {
                Diagnostic::warning(format!("`{name}`: {COLORS_IGNORED}")).hint(COLORS_HINT)
            });
        }
        // MeshLab's coordinates of the corners of each face.
        let has_wedges = header.elements.iter().any(|element| {
            element.name == "face" && element.properties.iter().any(|p| p.name == "texcoord")
        });
        if has_wedges {
            report.warning(|| {
                let what = "the texture coordinates of the faces (`texcoord`) are ignored";
                Diagnostic::warning(format!("`{name}`: {what}"))
                    .hint("those of vertices (`s` and `t`) are read, and so are those of OBJ files")
            });
        }
        Ok(Self {
            header,
            name,
            report,
            positions: if single {
                Positions::Single(vec![])
            } else {
                Positions::Double(vec![])
            },
            normals: has(&["nx", "ny", "nz"]).then(Vec::new),
            uvs: with_uv.then(Vec::new),
            has_odd_positions: false,
            faces: Faces::default(),
        })
    }

    /// Reads all rows of all elements.
    pub(super) fn read(&mut self, source: &mut impl Source) -> Fallible<()> {
        for element in &self.header.elements {
            self.check_size(element, source)?;
            match element.name.as_str() {
                "vertex" => self.vertices(element, source)?,
                "face" => self.faces(element, false, source)?,
                "tristrips" => self.faces(element, true, source)?,
                _ => skip_element(element, source)?,
            }
            if self.report.is_hopeless() {
                break;
            }
        }
        Ok(())
    }

    /// Accepts a count only if the file is long enough for it.
    fn check_size(&self, element: &Element, source: &impl Source) -> Fallible<()> {
        let needed =
            u128::from(element.count) * u128::from(element.smallest_row(self.header.encoding));
        if needed <= u128::from(source.left()) {
            return Ok(());
        }
        let exactly = if self.header.encoding == Encoding::Ascii {
            "at least "
        } else {
            ""
        };
        let problem = format!(
            "`{}`: the header declares {} elements `{}`, which take {exactly}{needed} bytes, but only {} are left",
            self.name,
            element.count,
            element.name,
            source.left()
        );
        Err(Box::new(
            Diagnostic::error(problem).hint("the file is cut off, or its header is damaged"),
        ))
    }

    fn vertices(&mut self, element: &Element, source: &mut impl Source) -> Fallible<()> {
        let uses: Vec<(Property, Use)> = element
            .properties
            .iter()
            .map(|p| (p.clone(), use_of(p)))
            .collect();
        // The count has been checked against the size of the file.
        let count = usize::try_from(element.count).unwrap_or(0);
        match &mut self.positions {
            Positions::Single(list) => list.reserve_exact(count),
            Positions::Double(list) => list.reserve_exact(count),
        }
        for row in 0..element.count {
            let mut values = [0.0; VALUES];
            for (property, used) in &uses {
                match (property.length, used) {
                    (Some(length), _) => skip_list(property, length, source)?,
                    (None, Some(place)) => values[*place] = source.number(property.scalar)?,
                    (None, None) => source.skip(property.scalar, 1)?,
                }
            }
            if !is_finite(&values[..NORMAL]) || !is_single(&values[NORMAL..]) {
                self.mend(row, &mut values);
            }
            self.add_vertex(&values);
        }
        Ok(())
    }

    /// Makes what is not finite what counts as none; the position only if no face uses it.
    #[cold]
    fn mend(&mut self, row: u64, values: &mut [f64; VALUES]) {
        let name = self.name;
        let mut count = |what: &'static str| {
            self.report.count(what, || {
                Diagnostic::warning(format!(
                    "`{name}`: {what}, as of vertex {row} (counted from 0)"
                ))
            });
        };
        if !is_finite(&values[..NORMAL]) {
            count("positions that are not finite are left out");
            self.has_odd_positions = true;
        }
        if !is_single(&values[NORMAL..UV]) {
            count("normals that are not finite count as none");
            values[NORMAL..UV].fill(0.0);
        }
        if !is_single(&values[UV..]) {
            count("texture coordinates that are not finite count as none");
            values[UV..].fill(0.0);
        }
    }

    #[inline]
    fn add_vertex(&mut self, values: &[f64; VALUES]) {
        let &[x, y, z, nx, ny, nz, u, v] = values;
        match &mut self.positions {
            Positions::Single(list) => list.push([x, y, z].map(|x| x as f32)),
            Positions::Double(list) => list.push(DVec3::new(x, y, z)),
        }
        if let Some(normals) = &mut self.normals {
            normals.push([nx, ny, nz].map(|x| x as f32));
        }
        if let Some(uvs) = &mut self.uvs {
            uvs.push([u as f32, v as f32]);
        }
    }

    fn faces(&mut self, element: &Element, strips: bool, source: &mut impl Source) -> Fallible<()> {
        let is_indices =
            |p: &Property| matches!(p.name.as_str(), "vertex_indices" | "vertex_index");
        let Some(indices) = element
            .properties
            .iter()
            .position(|p| is_indices(p) && p.length.is_some())
        else {
            let problem = format!(
                "`{}`: element `{}` has no list `vertex_indices`",
                self.name, element.name
            );
            return Err(Box::new(Diagnostic::error(problem)));
        };
        if matches!(
            element.properties[indices].scalar,
            Scalar::F32 | Scalar::F64
        ) {
            let problem = format!(
                "`{}`: the indices of element `{}` are not of an integer type",
                self.name, element.name
            );
            return Err(Box::new(Diagnostic::error(problem)));
        }
        for row in 0..element.count {
            for (i, property) in element.properties.iter().enumerate() {
                match property.length {
                    Some(length) if i == indices => {
                        self.faces.read_list(property.scalar, length, source)?;
                    }
                    Some(length) => skip_list(property, length, source)?,
                    None => source.skip(property.scalar, 1)?,
                }
            }
            let added = if strips {
                self.faces.add_strips(&self.positions)
            } else {
                self.faces.add_polygon(&self.positions, row, self.report)
            };
            if let Err(problem) = added {
                let problem = Diagnostic::error(format!(
                    "{} {row} (counted from 0): {problem}",
                    element.name
                ));
                self.report.error(|| source.at_last(problem));
                if self.report.is_hopeless() {
                    return Ok(());
                }
            }
        }
        Ok(())
    }

    /// The mesh.
    pub(super) fn finish(mut self) -> MeshData {
        let face_continues = self.faces.marks();
        if let Some([first, ..]) = self.faces.triangles.first()
            && self.has_odd_positions
        {
            self.positions.replace_not_finite(*first);
        }
        let indices = self.faces.triangles;
        let data = match self.positions {
            Positions::Single(positions) => MeshData {
                positions,
                indices,
                ..MeshData::default()
            },
            Positions::Double(positions) => MeshData::from_f64(&positions, indices),
        };
        MeshData {
            normals: self.normals,
            uvs: self.uvs,
            face_continues,
            ..data
        }
    }
}

fn is_finite(values: &[f64]) -> bool {
    values.iter().all(|x| x.is_finite())
}

/// Whether the numbers are finite in single precision, too.
fn is_single(values: &[f64]) -> bool {
    values.iter().all(|x| (*x as f32).is_finite())
}

fn use_of(property: &Property) -> Use {
    USED.iter()
        .find(|(name, _)| *name == property.name)
        .map(|(_, place)| *place)
}

fn skip_list(property: &Property, length: Scalar, source: &mut impl Source) -> Fallible<()> {
    let count = list_length(length, source)?;
    source.skip(property.scalar, count)
}

fn skip_element(element: &Element, source: &mut impl Source) -> Fallible<()> {
    // An element without properties takes no room, however many there are of it.
    if element.properties.is_empty() {
        return Ok(());
    }
    for _ in 0..element.count {
        for property in &element.properties {
            match property.length {
                Some(length) => skip_list(property, length, source)?,
                None => source.skip(property.scalar, 1)?,
            }
        }
    }
    Ok(())
}
