//! Focal blur, and normals that perturb camera rays.

use super::Draft;
use crate::keywords::Word;
use crate::parser::{PResult, Parser, Place};
use crate::token::Token;
use std::sync::Arc;
use strahl_math::{DVec3, Transform};
use strahl_scene::{Bokeh, Camera, Lens};
use strahl_shade::patterns::TexturePoint;

/// A lens being read.
#[derive(Default)]
pub(super) struct LensDraft {
    aperture: f64,
    focal_point: DVec3,
    samples: Option<(Option<u32>, u32)>,
    confidence: Option<f64>,
    variance: Option<f64>,
    bokeh: Option<Arc<Bokeh>>,
}

impl LensDraft {
    /// The lens of a declared camera.
    pub(super) fn of(camera: &Camera) -> Self {
        let Some(lens) = &camera.lens else {
            return Self::default();
        };
        Self {
            aperture: lens.aperture,
            focal_point: lens.focal_point,
            samples: Some((Some(lens.min_samples), lens.max_samples)),
            confidence: Some(lens.confidence),
            variance: Some(lens.variance),
            bokeh: lens.bokeh.clone(),
        }
    }

    /// The lens, transformed with the camera; `None` without blur.
    pub(super) fn finish(self, moved: &Transform) -> Option<Lens> {
        let (fewest, most) = self.samples?;
        if !(self.aperture > 0.0) || most == 0 {
            return None;
        }
        let point = moved.point_to_world(self.focal_point);
        let plain = Lens::new(self.aperture, point, most);
        Some(Lens {
            min_samples: fewest.unwrap_or(plain.min_samples).min(most),
            confidence: self.confidence.unwrap_or(plain.confidence),
            variance: self.variance.unwrap_or(plain.variance),
            bokeh: self.bokeh,
            ..plain
        })
    }
}

impl Parser<'_> {
    /// Items that blur or perturb the view.
    pub(super) fn camera_effect(
        &mut self,
        draft: &mut Draft,
        token: Token,
        word: Word,
    ) -> PResult<()> {
        let place = self.place_of(token);
        let lens = &mut draft.lens;
        match word {
            Word::Aperture => {
                self.take(token)?;
                lens.aperture = self.float()?;
            }
            Word::BlurSamples => {
                self.take(token)?;
                let first = self.blur_samples(place)?;
                self.comma()?;
                lens.samples = Some(if self.number_follows()? {
                    (Some(first), self.blur_samples(place)?)
                } else {
                    (None, first)
                });
            }
            Word::Confidence => {
                self.take(token)?;
                let value = self.float()?;
                if !(0.0..1.0).contains(&value) {
                    let message = format!(
                        "confidence must be from 0 to less than 1, not {value}; 0.9 is used"
                    );
                    self.warn(place, message);
                } else {
                    lens.confidence = Some(value);
                }
            }
            Word::Variance => {
                self.take(token)?;
                let value = self.float()?;
                if !(0.0..1.0).contains(&value) {
                    let message = format!(
                        "variance must be from 0 to less than 1, not {value}; 1/10000 is used"
                    );
                    self.warn(place, message);
                } else {
                    lens.variance = Some(value);
                }
            }
            Word::FocalPoint => {
                self.take(token)?;
                lens.focal_point = self.vector3()?;
            }
            Word::Bokeh => {
                self.take(token)?;
                lens.bokeh = self.bokeh()?;
            }
            Word::Normal => {
                self.take(token)?;
                draft.normal = Some(Arc::new(self.normal_block()?));
            }
            _ => return self.skip_item(token, "`camera`"),
        }
        Ok(())
    }

    fn blur_samples(&mut self, place: Place) -> PResult<u32> {
        let count = self.float()?;
        let most = Lens::MAX_SAMPLES;
        if (0.0..=f64::from(most)).contains(&count) {
            return Ok(count as u32);
        }
        let message = format!("blur_samples must be 0 to {most}, not {count}");
        Err(self.fail(place, message))
    }

    /// `{ pigment { ... } }` after `bokeh`: the brightness of the pigment in the unit square of x and y.
    fn bokeh(&mut self) -> PResult<Option<Arc<Bokeh>>> {
        let place = self.place();
        let pigment = self.braces(|p| {
            let token = p.peek()?;
            if !token.is(Word::Pigment) {
                return Err(p.unexpected(token, "`pigment`"));
            }
            p.take(token)?;
            p.free_pigment_block()
        })?;
        let bokeh = Bokeh::new(|x, y| {
            let point = TexturePoint::in_space(DVec3::new(x, y, 0.0));
            let color = pigment.color_at(&point).rgb;
            (color.r + color.g + color.b) / 3.0
        });
        if bokeh.is_none() {
            self.warn(place, "the bokeh is black; a round one is used");
        }
        Ok(bokeh.map(Arc::new))
    }
}
