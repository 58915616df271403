//! Objects, which belong to no scene until they are added to one.

use crate::convert::{Triple, contiguous, vector};
use crate::errors;
use crate::looks::Material;
use numpy::PyReadonlyArray2;
use pyo3::prelude::*;
use std::sync::Arc;
use strahl::math::{DMat3, DVec3, SingularTransform, Transform};
use strahl::prelude::{CsgOp, ObjectExt, Visibility};
use strahl::scene::{
    self, Children, FileId, Group, GroupId, ObjectKind, SceneLight, SourceMap, Span,
};

/// An object with all that its numbers refer to.
#[derive(Clone, Debug)]
pub(crate) struct Piece {
    pub(crate) object: scene::Object,
    pub(crate) groups: Vec<Group>,
    pub(crate) sources: SourceMap,
    /// Whether only the object itself refers to the sources, and nothing to groups.
    pub(crate) plain: bool,
    /// How deep objects are nested.
    pub(crate) depth: u32,
}

/// The transformation by a matrix of three rows and four columns that multiplies columns.
fn map(matrix: &[f64; 12]) -> Result<Transform, SingularTransform> {
    let column = |c: usize| DVec3::new(matrix[c], matrix[4 + c], matrix[8 + c]);
    let linear = DMat3::from_cols(column(0), column(1), column(2));
    Transform::try_new(linear, column(3))
}

/// The deepest nesting of objects.
const DEEPEST: u32 = 1000;

impl Piece {
    /// An object without parts that was made at a line of a program.
    pub(crate) fn new(object: scene::Object, place: Option<&(String, u32)>) -> Self {
        let mut sources = SourceMap::default();
        let mut object = object;
        if let Some((file, line)) = place {
            object.span = Span::line(sources.add(file), *line);
        }
        Self {
            object,
            groups: vec![],
            sources,
            plain: true,
            depth: 1,
        }
    }

    /// An object with parts that was made at a line of a program.
    fn of_parts(
        mut object: scene::Object,
        groups: Vec<Group>,
        mut sources: SourceMap,
        depth: u32,
        place: Option<(String, u32)>,
    ) -> Self {
        if let Some((file, line)) = place {
            object.span = Span::line(sources.add(&file), line);
        }
        Self {
            object,
            groups,
            sources,
            plain: false,
            depth,
        }
    }

    fn with(&self, change: impl FnOnce(scene::Object) -> scene::Object) -> Object {
        Object(Arc::new(Self {
            object: change(self.object.clone()),
            ..self.clone()
        }))
    }
}

/// How numbers of one scene become those of another.
pub(crate) struct Renumbering {
    files: Vec<FileId>,
    groups: u32,
}

impl Renumbering {
    /// Adds sources and groups to others; both are renumbered already.
    pub(crate) fn new(
        sources: &SourceMap,
        into: &mut SourceMap,
        groups: &[Group],
        all: &mut Vec<Group>,
    ) -> Self {
        let mut files = vec![];
        while let Some(name) = sources.name(FileId(files.len() as u32)) {
            files.push(into.add(name));
        }
        let new = Self {
            files,
            groups: all.len() as u32,
        };
        for group in groups {
            let mut group = group.clone();
            new.objects(&mut group.objects);
            all.push(group);
        }
        new
    }

    pub(crate) fn span(&self, span: &mut Span) {
        if let Some(file) = self.files.get(span.file.0 as usize) {
            span.file = *file;
        }
    }

    pub(crate) fn light(&self, light: &mut SceneLight) {
        self.span(&mut light.span);
        if let Some(mask) = &mut light.mask {
            mask.group.0 += self.groups;
        }
    }

    /// All objects, however deep.
    pub(crate) fn objects(&self, objects: &mut Children) {
        let mut waiting: Vec<&mut scene::Object> = objects.0.iter_mut().collect();
        while let Some(object) = waiting.pop() {
            self.span(&mut object.span);
            match &mut object.kind {
                ObjectKind::Shape(_) => {}
                ObjectKind::Instance(GroupId(number)) => *number += self.groups,
                ObjectKind::Light(light) => self.light(light),
                ObjectKind::Csg { children, .. } => waiting.extend(&mut children.0),
            }
        }
    }
}

/// A copy of a piece's object for a scene or another piece.
pub(crate) fn adopt(
    piece: &Piece,
    sources: &mut SourceMap,
    groups: &mut Vec<Group>,
) -> scene::Object {
    let map = Renumbering::new(&piece.sources, sources, &piece.groups, groups);
    let mut object = piece.object.clone();
    if piece.plain {
        map.span(&mut object.span);
        return object;
    }
    let mut one = Children(vec![object]);
    map.objects(&mut one);
    object = one.0.swap_remove(0);
    object
}

/// A surface, a solid or several of them. It never changes.
#[pyclass(frozen, module = "strahl._strahl")]
#[derive(Clone)]
pub(crate) struct Object(pub(crate) Arc<Piece>);

impl Object {
    pub(crate) fn new(object: scene::Object, place: Option<(String, u32)>) -> Self {
        Self(Arc::new(Piece::new(object, place.as_ref())))
    }

    fn transformed(&self, transform: &Transform) -> Self {
        self.0.with(|object| object.transformed(transform))
    }
}

#[pymethods]
impl Object {
    #[getter]
    fn name(&self) -> Option<String> {
        self.0.object.name.as_deref().map(str::to_owned)
    }

    /// The field's word for it.
    #[getter]
    fn kind(&self) -> &'static str {
        use strahl::geometry::Primitive;
        match &self.0.object.kind {
            ObjectKind::Shape(shape) => shape.kind(),
            ObjectKind::Csg { op, .. } => op.name(),
            ObjectKind::Instance(_) => "instance",
            ObjectKind::Light(_) => "light",
        }
    }

    /// Number of parts, 0 for a shape.
    #[getter]
    fn parts(&self) -> usize {
        match &self.0.object.kind {
            ObjectKind::Csg { children, .. } => children.0.len(),
            _ => 0,
        }
    }

    /// File and line of the program or scene that made it.
    #[getter]
    fn source(&self) -> Option<String> {
        let place = self.0.sources.locate(self.0.object.span)?;
        Some(place.to_string())
    }

    fn named(&self, name: &str) -> Self {
        self.0.with(|object| object.named(name))
    }

    fn with_material(&self, material: &Material) -> Self {
        self.0
            .with(|object| object.material(Arc::clone(&material.0)))
    }

    fn visible_to(&self, camera: bool, reflections: bool, shadows: bool) -> Self {
        self.0.with(|object| {
            object.visible_to(Visibility {
                camera,
                secondary: reflections,
                shadow: shadows,
            })
        })
    }

    fn hollow(&self, hollow: bool) -> Self {
        self.0.with(|object| scene::Object {
            hollow: Some(hollow),
            ..object
        })
    }

    fn translated(&self, offset: Triple) -> Self {
        self.transformed(&Transform::translate(vector(offset)))
    }

    fn rotated(&self, axis: Triple, radians: f64) -> Self {
        self.transformed(&Transform::rotate(vector(axis), radians))
    }

    fn scaled(&self, factors: Triple) -> PyResult<Self> {
        let scale = Transform::try_scale(vector(factors)).map_err(errors::value)?;
        Ok(self.transformed(&scale))
    }

    /// By a matrix of three rows and four columns that multiplies columns: its 12 numbers row by row.
    fn mapped(&self, matrix: [f64; 12]) -> PyResult<Self> {
        Ok(self.transformed(&map(&matrix).map_err(errors::value)?))
    }

    /// Once for each row of matrices as `mapped` takes them. The places share the object, which is stored once.
    fn instances(
        &self,
        matrices: PyReadonlyArray2<'_, f64>,
        place: Option<(String, u32)>,
    ) -> PyResult<Self> {
        let (sources, mut groups) = (self.0.sources.clone(), self.0.groups.clone());
        let shared = GroupId(groups.len() as u32);
        groups.push(Group {
            name: None,
            objects: Children(vec![self.0.object.clone()]),
        });
        let (rows, _) = contiguous(&matrices)?.as_chunks::<12>();
        let each = rows.iter().enumerate().map(|(number, row)| {
            let map = map(row)
                .map_err(|error| errors::value(format!("matrices: number {number}: {error}")))?;
            Ok(scene::Object::instance(shared).transformed(&map))
        });
        let object = scene::Object::csg(CsgOp::Union, each.collect::<PyResult<_>>()?);
        let depth = self.0.depth + 1;
        Ok(Self(Arc::new(Piece::of_parts(
            object, groups, sources, depth, place,
        ))))
    }

    /// Combines objects; `operation` is that of POV-Ray's language.
    #[staticmethod]
    fn combined(
        operation: &str,
        objects: Vec<Py<Self>>,
        place: Option<(String, u32)>,
    ) -> PyResult<Self> {
        let op = match operation {
            "union" => CsgOp::Union,
            "merge" => CsgOp::Merge,
            "intersection" => CsgOp::Intersection,
            "difference" => CsgOp::Difference,
            "inverse" => CsgOp::Inverse,
            "clip" => CsgOp::Clip,
            "bound" => CsgOp::Bound,
            other => return Err(errors::value(format!("there is no operation `{other}`"))),
        };
        let depth = objects.iter().map(|o| o.get().0.depth).max().unwrap_or(0) + 1;
        if depth > DEEPEST {
            return Err(errors::value(format!(
                "objects are nested more than {DEEPEST} deep: combine lists of them by strahl.union and the like"
            )));
        }
        let (mut sources, mut groups) = (SourceMap::default(), vec![]);
        let children = objects
            .iter()
            .map(|object| adopt(&object.get().0, &mut sources, &mut groups))
            .collect();
        let object = scene::Object::csg(op, children);
        Ok(Self(Arc::new(Piece::of_parts(
            object, groups, sources, depth, place,
        ))))
    }

    /// The parts of a combination by this operation that has no attributes of its own; `None` for anything else.
    fn loose_parts(&self, operation: &str) -> Option<Vec<Self>> {
        let object = &self.0.object;
        let ObjectKind::Csg { op, children } = &object.kind else {
            return None;
        };
        let bare = op.name() == operation
            && object.name.is_none()
            && object.material.is_none()
            && object.transform.is_none()
            && object.hollow.is_none()
            && object.visibility == Visibility::default()
            && !self.0.plain;
        bare.then(|| {
            let part = |object: &scene::Object| {
                Self(Arc::new(Piece {
                    object: object.clone(),
                    groups: self.0.groups.clone(),
                    sources: self.0.sources.clone(),
                    plain: false,
                    depth: self.0.depth - 1,
                }))
            };
            children.0.iter().map(part).collect()
        })
    }
}
