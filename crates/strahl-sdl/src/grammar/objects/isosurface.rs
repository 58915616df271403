use crate::grammar::Entity;
use crate::keywords::Word;
use crate::parser::{PResult, Parser};
use crate::value::Value;
use std::collections::VecDeque;
use std::sync::Arc;
use strahl_function::Function;
use strahl_geometry::{Container, Cuboid, Isosurface, IsosurfaceOptions, Sphere};

/// `isosurface { function { ... } [contained_by { ... }] [threshold t] [accuracy a] [max_gradient g] [evaluate ...] [open] ... }`
///
/// Items that control only POV-Ray's search are read and ignored: `max_trace`, `all_intersections`, and the gradient, unless the
/// function calls patterns or sums over octaves of noise.
pub(super) fn isosurface(p: &mut Parser<'_>) -> PResult<Entity> {
    p.shape(|p| {
        let function = p.function_item()?;
        let mut container = Container::default();
        let mut options = IsosurfaceOptions::default();
        loop {
            let token = p.peek()?;
            let Some(word) = token.word() else { break };
            match word {
                Word::ContainedBy => {
                    p.take(token)?;
                    container = p.container()?;
                }
                Word::Threshold => {
                    p.take(token)?;
                    options.threshold = p.float()?;
                }
                Word::Accuracy => {
                    p.take(token)?;
                    options.accuracy = p.float()?;
                }
                Word::MaxGradient => {
                    p.take(token)?;
                    options.max_gradient = Some(p.float()?);
                }
                Word::Evaluate => {
                    p.take(token)?;
                    // `evaluate`: the initial gradient, and the factors by which it grows and shrinks.
                    let least = p.float()?;
                    p.comma()?;
                    let factor = p.float()?;
                    p.comma()?;
                    p.float()?;
                    options.max_gradient = Some(least * factor);
                }
                Word::MaxTrace => {
                    p.take(token)?;
                    p.float()?;
                }
                Word::AllIntersections => p.take(token)?,
                Word::Open => {
                    p.take(token)?;
                    options.open = p.switched()?;
                }
                _ => break,
            }
        }
        let surface = Isosurface::try_new(function, container, options);
        Ok(surface.map(|surface| p.state.isosurfaces.share(surface)))
    })
}

/// The isosurfaces read last. Macros and loops repeat the same one; then all of them are one shape, and what is found out about its
/// function is found out once.
#[derive(Debug, Default)]
pub(in crate::grammar) struct KnownIsosurfaces {
    recent: VecDeque<Arc<Isosurface>>,
}

impl KnownIsosurfaces {
    /// How many are kept.
    const RECENT: usize = 16;

    /// The shape of an isosurface, which is an equal one if it is among those.
    fn share(&mut self, surface: Isosurface) -> Arc<Isosurface> {
        if let Some(known) = self.recent.iter().find(|known| ***known == surface) {
            return Arc::clone(known);
        }
        let surface = Arc::new(surface);
        if self.recent.len() >= Self::RECENT {
            self.recent.pop_front();
        }
        self.recent.push_back(Arc::clone(&surface));
        surface
    }
}

impl Parser<'_> {
    /// `function { ... }`, or a number as a constant function.
    pub(super) fn function_item(&mut self) -> PResult<Function> {
        let token = self.peek()?;
        if !token.is(Word::Function) {
            return Err(self.unexpected(token, "`function`"));
        }
        self.take(token)?;
        let place = self.place();
        match self.function_value()? {
            Value::Function(function) => Ok(function),
            other => {
                let message = format!(
                    "a function of numbers is needed here, found {}",
                    other.describe()
                );
                Err(self.fail(place, message))
            }
        }
    }

    /// `{ sphere { centre, radius } }` or `{ box { corner, corner } }` after `contained_by`.
    pub(super) fn container(&mut self) -> PResult<Container> {
        self.braces(|p| {
            if p.accept_word(Word::Sphere)? {
                return p.braces(|p| {
                    let center = p.vector3()?;
                    p.comma()?;
                    let radius = p.float()?;
                    Ok(Container::Sphere(Sphere::new(center, radius.abs())))
                });
            }
            if p.accept_word(Word::Box)? {
                return p.braces(|p| {
                    let a = p.vector3()?;
                    p.comma()?;
                    let b = p.vector3()?;
                    Ok(Container::Box(Cuboid::from_corners(a, b)))
                });
            }
            let token = p.peek()?;
            Err(p.unexpected(token, "`sphere` or `box`"))
        })
    }
}
