use super::blend::blended;
use super::builder::{Builder, NONE};
use super::{Parts, has_area};
use crate::grammar::{Entity, Texture};
use crate::keywords::Word;
use crate::parser::{PResult, Parser, Place};
use crate::token::Kind;
use std::collections::{BTreeMap, HashMap};
use strahl_geometry::MeshData;
use strahl_math::DVec3;

/// Faces that may share a mesh: the textures of the corners, the number of a face whose corners differ, and whether the normals are
/// interpolated.
type FaceKind = (Option<[usize; 3]>, Option<usize>, bool);

/// The lists of a `mesh2`.
#[derive(Default)]
struct Lists {
    vertices: Vec<DVec3>,
    normals: Vec<DVec3>,
    uvs: Vec<[f64; 2]>,
    textures: Vec<Texture>,
    faces: Vec<[u32; 3]>,
    /// The textures at the corners of each face with textures.
    face_textures: HashMap<usize, [usize; 3]>,
    normal_faces: Option<Vec<[u32; 3]>>,
    uv_faces: Option<Vec<[u32; 3]>>,
    has_inside: bool,
}

/// The list of faces that indexes normals or texture coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Numbering {
    None,
    Vertices,
    Own,
}

/// `mesh2 { vertex_vectors { ... } face_indices { ... } ... }`
pub(in crate::grammar::objects) fn mesh2(p: &mut Parser<'_>) -> PResult<Entity> {
    let place = p.place();
    p.braces(|p| {
        let mut lists = Lists::default();
        while p.mesh2_list(&mut lists)? {}
        let faces = lists.normal_faces.as_ref().map(Vec::len);
        let normals = p.numbering(place, "normal", lists.normals.len(), faces, &lists)?;
        let faces = lists.uv_faces.as_ref().map(Vec::len);
        // As in POV-Ray (measured). Wings 3D writes `uv_vectors { 0 }` and indices of 0 for models without texture coordinates.
        if faces.is_some() && lists.uvs.is_empty() {
            lists.uvs.push([0.0; 2]);
        }
        let uvs = p.numbering(place, "uv", lists.uvs.len(), faces, &lists)?;
        let mut entity = p.mesh_object(lists.into_parts(normals, uvs), place)?;
        p.modifiers(&mut entity)?;
        Ok(entity)
    })
}

impl Parser<'_> {
    /// Reads one of the lists; returns `false` if none follows.
    fn mesh2_list(&mut self, lists: &mut Lists) -> PResult<bool> {
        let token = self.peek()?;
        let word = match token.word() {
            Some(
                word @ (Word::VertexVectors
                | Word::NormalVectors
                | Word::UvVectors
                | Word::TextureList
                | Word::FaceIndices
                | Word::NormalIndices
                | Word::UvIndices
                | Word::InsideVector),
            ) => word,
            _ => return Ok(false),
        };
        self.take(token)?;
        match word {
            Word::VertexVectors => lists.vertices = self.counted_list(Self::f32_vector)?,
            Word::NormalVectors => lists.normals = self.counted_list(Self::f32_vector)?,
            Word::UvVectors => lists.uvs = self.counted_list(Self::vector2)?,
            Word::TextureList => {
                lists.textures = self.counted_list(|p| {
                    p.expect_word_texture()?;
                    p.texture_block()
                })?;
            }
            Word::FaceIndices => self.face_indices(lists)?,
            Word::NormalIndices => {
                let count = lists.normals.len();
                let faces = self.counted_list(|p| p.face(count, "normal_vectors"))?;
                lists.normal_faces = Some(faces);
            }
            Word::UvIndices => {
                let count = lists.uvs.len().max(1);
                let faces = self.counted_list(|p| p.face(count, "uv_vectors"))?;
                lists.uv_faces = Some(faces);
            }
            _ => lists.has_inside = self.vector3()? != DVec3::ZERO,
        }
        self.comma()?;
        Ok(true)
    }

    fn face_indices(&mut self, lists: &mut Lists) -> PResult<()> {
        let (vertices, textures) = (lists.vertices.len(), lists.textures.len());
        let mut face_textures = HashMap::new();
        let mut index = 0;
        lists.faces = self.counted_list(|p| {
            let face = p.face(vertices, "vertex_vectors")?;
            if textures > 0
                && let Some(texture) = p.face_texture(textures)?
            {
                face_textures.insert(index, texture);
            }
            index += 1;
            Ok(face)
        })?;
        lists.face_textures = face_textures;
        Ok(())
    }

    pub(super) fn expect_word_texture(&mut self) -> PResult<()> {
        if self.accept_word(Word::Texture)? {
            return Ok(());
        }
        let token = self.peek()?;
        Err(self.unexpected(token, "`texture`"))
    }

    /// `{ count, item, ... }`
    fn counted_list<T>(
        &mut self,
        mut item: impl FnMut(&mut Self) -> PResult<T>,
    ) -> PResult<Vec<T>> {
        self.braces(|p| {
            let token = p.peek()?;
            let place = p.place_of(token);
            let count = p.float()?;
            let mut list = vec![];
            // Each item is read, so the count cannot ask for more memory than the text has.
            while (list.len() as f64) < count {
                p.comma()?;
                if p.peek()?.kind == Kind::RightBrace {
                    let found = list.len();
                    let message = format!("the list should have {count} entries, found {found}");
                    return Err(p.fail(place, message));
                }
                p.count_parts(1)?;
                list.push(item(p)?);
            }
            p.comma()?;
            Ok(list)
        })
    }

    /// A vector that fits into f32, in which the mesh stores it.
    fn f32_vector(&mut self) -> PResult<DVec3> {
        let vector = self.vector3()?;
        if vector.as_vec3().is_finite() {
            return Ok(vector);
        }
        let place = self.place();
        Err(self.fail(place, "this vector is too large for a mesh"))
    }

    /// `<a, b, c>`, indices into a list.
    fn face(&mut self, count: usize, list: &str) -> PResult<[u32; 3]> {
        let token = self.peek()?;
        let place = self.place_of(token);
        let numbers = self.vector3()?.to_array();
        let mut face = [0; 3];
        for (index, number) in face.iter_mut().zip(numbers) {
            *index = self.entry(number, count, list, place)? as u32;
        }
        Ok(face)
    }

    /// Checks an index into a list.
    fn entry(&mut self, number: f64, count: usize, list: &str, place: Place) -> PResult<usize> {
        if number >= 0.0 && number < count as f64 {
            return Ok(number as usize);
        }
        let message = format!("there is no entry {number} in {list}, which has {count}");
        Err(self.fail_hint(place, message, "entries are counted from 0"))
    }

    /// The indices of the textures at the corners of a face, if it has textures.
    fn face_texture(&mut self, count: usize) -> PResult<Option<[usize; 3]>> {
        let mut corners = [None; 3];
        for corner in &mut corners {
            // The comma may also separate this face from the next.
            self.comma()?;
            if !self.number_follows()? {
                break;
            }
            let token = self.peek()?;
            let place = self.place_of(token);
            let number = self.float()?;
            *corner = Some(self.entry(number, count, "texture_list", place)?);
        }
        let [first, second, third] = corners;
        let textures = first.map(|a| [a, second.unwrap_or(a), third.unwrap_or(a)]);
        if textures.is_some_and(|t| !is_same(t)) {
            // The face becomes an object of its own.
            self.count_parts(64)?;
        }
        Ok(textures)
    }

    /// The list of faces that indexes normals or texture coordinates: their own, that of the vertices, or none.
    fn numbering(
        &mut self,
        place: Place,
        what: &str,
        vectors: usize,
        faces: Option<usize>,
        lists: &Lists,
    ) -> PResult<Numbering> {
        let (expected, vertices) = (lists.faces.len(), lists.vertices.len());
        if vectors == 0 {
            return Ok(Numbering::None);
        }
        let Some(faces) = faces else {
            if vectors >= vertices {
                return Ok(Numbering::Vertices);
            }
            let message =
                format!("there are {vectors} {what}_vectors for {vertices} vertex_vectors");
            let hint = format!("give one for each vertex, or {what}_indices");
            return Err(self.fail_hint(place, message, hint));
        };
        // The last faces may do without normals: they are flat.
        let may_be_fewer = what == "normal";
        if faces == expected || (may_be_fewer && faces < expected) {
            return Ok(Numbering::Own);
        }
        let message = format!("there are {faces} {what}_indices for {expected} face_indices");
        let hint = if may_be_fewer {
            "give one for each face, or for the first ones, whose normals are interpolated"
        } else {
            "give one for each face"
        };
        Err(self.fail_hint(place, message, hint))
    }
}

fn is_same([a, b, c]: [usize; 3]) -> bool {
    a == b && b == c
}

impl Lists {
    fn into_parts(self, normals: Numbering, uvs: Numbering) -> Parts {
        let vertex = |i: u32| self.vertices.get(i as usize).copied().unwrap_or_default();
        let sound = |face: &[u32; 3]| has_area(face.map(vertex));
        let degenerate = self.faces.iter().filter(|face| !sound(face)).count();
        let has_inside = self.has_inside;
        // The most frequent case: one texture, and corners that are the vertices.
        if self.face_textures.is_empty() && normals == Numbering::None && uvs == Numbering::None {
            let faces: Vec<_> = self.faces.iter().copied().filter(|f| sound(f)).collect();
            let meshes = (!faces.is_empty())
                .then(|| (None, MeshData::from_f64(&self.vertices, faces)))
                .into_iter()
                .collect();
            return Parts {
                meshes,
                degenerate,
                has_inside,
            };
        }
        let numbers = |numbering, own: &Option<Vec<_>>, index: usize, face: [u32; 3]| match (
            numbering, own,
        ) {
            (Numbering::None, _) => [NONE; 3],
            (Numbering::Own, Some(own)) => own.get(index).copied().unwrap_or([NONE; 3]),
            _ => face,
        };
        let usable = |i: &u32| {
            let normal = self.normals.get(*i as usize);
            normal.is_some_and(|n| *n != DVec3::ZERO)
        };
        // Faces by texture and by whether they have normals: the normals of a face may be zero. A face of several textures is a
        // mesh of its own.
        let mut builders = BTreeMap::<FaceKind, Builder>::new();
        for (index, face) in self.faces.iter().enumerate() {
            if !sound(face) {
                continue;
            }
            let n = numbers(normals, &self.normal_faces, index, *face);
            // As in POV-Ray, a face with three equal normals is flat and gets the normal of its plane.
            let [a, b, c] = n.map(|i| self.normals.get(i as usize));
            let smooth = n.iter().all(usable) && !(a == b && b == c);
            let n = if smooth { n } else { [NONE; 3] };
            let uv = numbers(uvs, &self.uv_faces, index, *face);
            let texture = self.face_textures.get(&index).copied();
            let alone = texture.is_some_and(|t| !is_same(t)).then_some(index);
            let builder = builders.entry((texture, alone, smooth)).or_default();
            builder.add(std::array::from_fn(|k| [face[k], n[k], uv[k]]));
        }
        let meshes = builders.into_iter().map(|((texture, alone, _), builder)| {
            let texture = texture.and_then(|corners| {
                let face = alone.and_then(|index| self.faces.get(index));
                match (face, corners.map(|t| self.textures.get(t))) {
                    (Some(face), [Some(a), Some(b), Some(c)]) => {
                        Some(blended(face.map(vertex), [a, b, c]))
                    }
                    (_, [first, ..]) => first.cloned(),
                }
            });
            let data = builder.finish(&self.vertices, &self.normals, &self.uvs);
            (texture, data)
        });
        Parts {
            meshes: meshes.collect(),
            degenerate,
            has_inside,
        }
    }
}
