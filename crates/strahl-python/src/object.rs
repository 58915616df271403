//! Objects, which belong to no scene until they are added to one.

use crate::convert::contiguous;
use crate::errors;
use crate::looks::Material;
use crate::maps::{self, Map};
use numpy::PyReadonlyArray2;
use pyo3::prelude::*;
use std::sync::Arc;
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
    pub(crate) fn of_parts(
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

    /// As made at a line of a program.
    fn made_at(&self, place: Option<(String, u32)>) -> Self {
        let mut piece = (*self.0).clone();
        if let Some((file, line)) = place {
            piece.object.span = Span::line(piece.sources.add(&file), line);
        }
        Self(Arc::new(piece))
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

    #[pyo3(name = "transformed")]
    pub(crate) fn moved(&self, map: &Map) -> Self {
        self.0.with(|object| object.transformed(&map.0))
    }

    fn double_illuminated(&self) -> Self {
        self.0.with(|object| scene::Object {
            double_illuminated: true,
            ..object
        })
    }

    fn uv_mapped(&self) -> Self {
        self.0.with(|object| scene::Object {
            uv_mapped: true,
            ..object
        })
    }

    /// As the body of a light, which casts no shadow.
    fn lamp(&self) -> Self {
        self.0.with(|object| scene::Object {
            is_lamp: true,
            visibility: Visibility {
                shadow: false,
                ..object.visibility
            },
            ..object
        })
    }

    /// Once for each row of matrices as `Map.matrix` takes them. The places share the object, which is stored once.
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
            let map = maps::of_matrix(row)
                .map_err(|error| errors::value(format!("matrices: number {number}: {error}")))?;
            Ok(scene::Object::instance(shared).transformed(&map))
        });
        let object = scene::Object::csg(CsgOp::Union, each.collect::<PyResult<_>>()?);
        let depth = self.0.depth + 1;
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
            && !(object.double_illuminated || object.uv_mapped || object.is_lamp)
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
