//! What goes through the stages.

use crate::branch::Branch;
use crate::hit::Hit;
use crate::surface::Surface;
use arrayvec::ArrayVec;
use strahl_accel::PACKET;
use strahl_shade::texture::TexturePaint;
use strahl_shade::{Color, ShadingModel};

/// The lanes of a batch that a stage has to do with, in order.
pub(crate) type Lanes = ArrayVec<usize, PACKET>;

/// A ray and its hit on their way through the stages.
#[derive(Debug)]
pub(crate) struct Point<'s> {
    pub(crate) branch: Branch,
    pub(crate) hit: Hit,
    /// Number of the ray's node.
    pub(crate) node: u32,
    /// The distance of the hit from the ray's origin.
    pub(super) length: f64,
    pub(crate) surface: Surface<'s>,
    pub(crate) model: ShadingModel,
    /// The layers of the texture; none without a texture.
    pub(crate) paint: TexturePaint<'s>,
    /// The light that the surface sends to the origin of the ray by itself.
    pub(super) local: Color,
}

impl<'s> Point<'s> {
    /// A place for a point; `paint` has the settings of textures.
    pub(super) fn unknown(paint: &TexturePaint<'s>) -> Self {
        Self {
            branch: Branch::NONE,
            hit: Hit::NONE,
            node: 0,
            length: 0.0,
            surface: Surface::unknown(),
            model: ShadingModel::Lambert,
            paint: paint.clone(),
            local: Color::BLACK,
        }
    }
}
