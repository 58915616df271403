use super::blend::blended;
use super::builder::{Builder, NONE};
use super::numbered::Numbered;
use super::{Parts, has_area, texture_number};
use crate::grammar::objects::triangle::{corners, corners_with_normals};
use crate::grammar::{Entity, Texture};
use crate::keywords::Word;
use crate::parser::{PResult, Parser};
use std::collections::HashMap;
use strahl_math::DVec3;

/// The properties common to all triangles of one mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
struct Kind {
    texture: Option<usize>,
    smooth: bool,
    mapped: bool,
}

/// The triangles read so far.
#[derive(Default)]
struct Draft {
    positions: Numbered<[f64; 3]>,
    normals: Numbered<[f64; 3]>,
    uvs: Numbered<[f64; 2]>,
    textures: Vec<Texture>,
    /// Triangles of one kind, in the order of the scene.
    groups: Vec<(Kind, Builder)>,
    known: HashMap<Kind, usize>,
    degenerate: usize,
}

/// `mesh { triangle { ... } smooth_triangle { ... } ... }`
pub(in crate::grammar::objects) fn mesh(p: &mut Parser<'_>) -> PResult<Entity> {
    let place = p.place();
    p.braces(|p| {
        let mut draft = Draft::default();
        let mut has_inside = false;
        loop {
            if p.accept_word(Word::Triangle)? {
                p.braces(|p| {
                    let corners = corners(p)?;
                    p.mesh_triangle(&mut draft, corners, None)
                })?;
            } else if p.accept_word(Word::SmoothTriangle)? {
                p.braces(|p| {
                    let (corners, normals) = corners_with_normals(p)?;
                    p.mesh_triangle(&mut draft, corners, Some(normals))
                })?;
            } else if p.accept_word(Word::InsideVector)? {
                has_inside = p.vector3()? != DVec3::ZERO;
            } else {
                break;
            }
        }
        let mut entity = p.mesh_object(draft.finish(has_inside), place)?;
        p.modifiers(&mut entity)?;
        Ok(entity)
    })
}

impl Parser<'_> {
    /// The items after the corners of a triangle of a mesh.
    fn mesh_triangle(
        &mut self,
        draft: &mut Draft,
        corners: [DVec3; 3],
        normals: Option<[DVec3; 3]>,
    ) -> PResult<()> {
        // Three corners, with their normals and texture coordinates.
        self.count_parts(3)?;
        let (mut texture, mut uvs) = (None, None);
        self.items("the triangle", |p, token| {
            match token.word() {
                Some(Word::Texture) => {
                    p.take(token)?;
                    texture = Some(p.texture_block()?);
                }
                Some(Word::TextureList) => {
                    p.take(token)?;
                    let [a, b, c] = p.braces(|p| {
                        Ok([
                            p.corner_texture()?,
                            p.corner_texture()?,
                            p.corner_texture()?,
                        ])
                    })?;
                    // The triangle is a mesh of its own.
                    p.count_parts(64)?;
                    texture = Some(blended(corners, [&a, &b, &c]));
                }
                Some(Word::UvVectors) => {
                    p.take(token)?;
                    let mut three = [[0.0; 2]; 3];
                    for uv in &mut three {
                        *uv = p.vector2()?;
                        p.comma()?;
                    }
                    uvs = Some(three);
                }
                _ => return p.skip_item(token, "the triangle"),
            }
            Ok(())
        })?;
        // Meshes store corners in f32.
        if !corners.iter().all(|c| c.as_vec3().is_finite()) {
            let place = self.place();
            return Err(self.fail(place, "a corner of the triangle is too far away for a mesh"));
        }
        draft.add(corners, normals, uvs, texture);
        Ok(())
    }

    /// One of the three textures of a triangle: a name, or `texture { ... }`.
    fn corner_texture(&mut self) -> PResult<Texture> {
        self.comma()?;
        if let Some(named) = self.named_texture()? {
            return Ok(named);
        }
        self.expect_word_texture()?;
        self.texture_block()
    }
}

impl Draft {
    fn add(
        &mut self,
        corners: [DVec3; 3],
        normals: Option<[DVec3; 3]>,
        uvs: Option<[[f64; 2]; 3]>,
        texture: Option<Texture>,
    ) {
        if !has_area(corners) {
            self.degenerate += 1;
            return;
        }
        let usable = |n: &DVec3| *n != DVec3::ZERO && n.as_vec3().is_finite();
        // As in POV-Ray, a triangle of a mesh with three equal normals is flat and gets the normal of its plane.
        let normals = normals.filter(|all| {
            let [a, b, c] = all;
            all.iter().all(usable) && !(a == b && b == c)
        });
        let kind = Kind {
            texture: texture.map(|t| texture_number(&mut self.textures, t)),
            smooth: normals.is_some(),
            mapped: uvs.is_some(),
        };
        let positions = corners.map(|p| self.positions.number(p.to_array()));
        let normals = normals.map_or([NONE; 3], |all| {
            all.map(|n| self.normals.number(n.to_array()))
        });
        let uvs = uvs.map_or([NONE; 3], |all| all.map(|uv| self.uvs.number(uv)));
        let group = *self.known.entry(kind).or_insert_with(|| {
            self.groups.push((kind, Builder::default()));
            self.groups.len() - 1
        });
        if let Some((_, builder)) = self.groups.get_mut(group) {
            builder.add(std::array::from_fn(|k| [positions[k], normals[k], uvs[k]]));
        }
    }

    fn finish(self, has_inside: bool) -> Parts {
        let vectors = |list: &Numbered<[f64; 3]>| -> Vec<DVec3> {
            list.list.iter().map(|v| DVec3::from_array(*v)).collect()
        };
        let (positions, normals) = (vectors(&self.positions), vectors(&self.normals));
        let meshes = self.groups.into_iter().map(|(kind, builder)| {
            let texture = kind.texture.and_then(|t| self.textures.get(t).cloned());
            let data = builder.finish(&positions, &normals, &self.uvs.list);
            (texture, data)
        });
        Parts {
            meshes: meshes.collect(),
            degenerate: self.degenerate,
            has_inside,
        }
    }
}
