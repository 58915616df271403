//! Objects: one file each, and a line in [`OBJECTS`].
//!
//! `modifiers` reads the items common to all objects; `reuse` lets uses of a declared object share a group.

mod bicubic_patch;
mod blob;
mod bounds;
mod boxes;
mod brep;
mod cone;
mod csg;
mod cylinder;
mod disc;
mod extents;
mod height_field;
mod isosurface;
mod julia_fractal;
mod lathe;
mod lemon;
mod mandelbulb;
mod menger;
mod mesh;
mod modifiers;
mod named;
mod nurbs;
mod ovus;
mod parametric;
mod plane;
mod polygon;
mod polynomial;
mod prism;
mod quadric;
mod reuse;
mod sor;
mod sphere;
mod sphere_sweep;
mod subdivision;
mod superellipsoid;
mod terrain;
mod text;
mod torus;
mod triangle;

pub(super) use extents::told_extent;
pub(super) use isosurface::KnownIsosurfaces;
pub(super) use named::object;
pub(crate) use reuse::{Shared, Tally, expanded};
pub(super) use text::KnownFont;

use super::{Entity, by_word, words_of};
use crate::keywords::Word;
use crate::parser::{PResult, Parser};
use crate::token::{Kind, Token};
use strahl_scene::Object;

/// Reads an object from its `{` to its `}`; its keyword is taken.
pub(super) type ObjectParser = fn(&mut Parser<'_>) -> PResult<Entity>;

/// All objects by keyword.
static OBJECTS: [Option<ObjectParser>; Word::ALL.len()] = by_word::<ObjectParser, _>([
    (Word::BicubicPatch, bicubic_patch::bicubic_patch),
    (Word::Blob, blob::blob),
    (Word::Box, boxes::cuboid),
    (Word::Brep, brep::brep),
    (Word::Isosurface, isosurface::isosurface),
    (Word::JuliaFractal, julia_fractal::julia_fractal),
    (Word::Lathe, lathe::lathe),
    (Word::Lemon, lemon::lemon),
    (Word::LightGroup, super::lights::light_group),
    (Word::LightSource, super::lights::light_source),
    (Word::Cone, cone::cone),
    (Word::Cubic, polynomial::cubic),
    (Word::Cylinder, cylinder::cylinder),
    (Word::Difference, csg::difference),
    (Word::Disc, disc::disc),
    (Word::HeightField, height_field::height_field),
    (Word::Intersection, csg::intersection),
    (Word::Mandelbulb, mandelbulb::mandelbulb),
    (Word::Menger, menger::menger),
    (Word::Merge, csg::merge),
    (Word::Mesh, mesh::mesh),
    (Word::Mesh2, mesh::mesh2),
    (Word::Nurbs, nurbs::nurbs),
    (Word::Object, object),
    (Word::Ovus, ovus::ovus),
    (Word::Parametric, parametric::parametric),
    (Word::Plane, plane::plane),
    (Word::Poly, polynomial::poly),
    (Word::Polygon, polygon::polygon),
    (Word::Prism, prism::prism),
    (Word::Polynomial, polynomial::polynomial),
    (Word::Quadric, quadric::quadric),
    (Word::Quartic, polynomial::quartic),
    (Word::SmoothTriangle, triangle::smooth_triangle),
    (Word::Sor, sor::sor),
    (Word::Sphere, sphere::sphere),
    (Word::SphereSweep, sphere_sweep::sphere_sweep),
    (Word::Terrain, terrain::terrain),
    (Word::Subdivision, subdivision::subdivision),
    (Word::Text, text::text),
    (Word::Superellipsoid, superellipsoid::superellipsoid),
    (Word::Torus, torus::torus),
    (Word::Triangle, triangle::triangle),
    (Word::Union, csg::union),
]);

/// The keywords of all supported objects.
pub fn object_words() -> impl Iterator<Item = Word> {
    words_of(&OBJECTS)
}

impl Parser<'_> {
    /// Which of an extension's words a token is: a keyword of the language, or a name that has its meaning only there.
    fn own_word(&self, token: Token, words: &[&'static str]) -> Option<&'static str> {
        let text = match token.word() {
            Some(word) => word.text(),
            None if token.kind == Kind::Name => self.symbols.text(token.symbol()?),
            None => return None,
        };
        words.iter().find(|word| **word == text).copied()
    }

    /// Reads an object, if one follows.
    ///
    /// # Errors
    /// If the object is invalid.
    pub(crate) fn object(&mut self) -> PResult<Option<Object>> {
        Ok(self.entity()?.map(|entity| entity.object))
    }

    /// Reads an object or the name of one, if one follows, with its texture.
    ///
    /// # Errors
    /// If the object is invalid.
    pub(crate) fn entity(&mut self) -> PResult<Option<Entity>> {
        let token = self.peek()?;
        if token.kind == Kind::Name {
            let named = self.named_object(None)?;
            if named.is_some() {
                self.count_objects(1)?;
            }
            return Ok(named);
        }
        match self.object_parser(token)? {
            Some(parse) => self.nested(parse).map(Some),
            None => Ok(None),
        }
    }

    /// The parser for the object that begins with a token, which is then taken.
    ///
    /// # Errors
    /// If there are too many objects.
    #[inline]
    pub(in crate::grammar) fn object_parser(
        &mut self,
        token: Token,
    ) -> PResult<Option<ObjectParser>> {
        let word = match token.word() {
            // The union of version 1.0.
            Some(Word::Composite) => Word::Union,
            Some(word) => word,
            None => return Ok(None),
        };
        let Some(parse) = OBJECTS.get(word as usize).copied().flatten() else {
            return Ok(None);
        };
        self.take(token)?;
        self.count_objects(1)?;
        // A declared object may be in the braces of any object; CSG operations and lights check for it themselves, and a `brep` has several.
        let looks_itself = matches!(
            word,
            Word::LightSource
                | Word::LightGroup
                | Word::Union
                | Word::Merge
                | Word::Intersection
                | Word::Difference
                | Word::Brep
        );
        let named = !looks_itself && self.object_name_follows()?;
        Ok(Some(if named { object } else { parse }))
    }

    /// Skips an unsupported statement with a warning; `token` is its keyword.
    ///
    /// # Errors
    /// If it has no end.
    pub(in crate::grammar) fn leave_out(&mut self, token: Token) -> PResult<()> {
        self.take(token)?;
        let text = token.word().map_or("", Word::text);
        self.warn_hint(
            self.place(),
            format!("`{text}` is not supported yet and is left out"),
            "the picture will lack it",
        );
        self.skip_body()
    }
}
