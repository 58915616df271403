//! From what is known of pixels to the colours that show it.

use crate::pictures::{Kind, Picture};
use crate::protocol::{Channel, Curve};
use strahl::prelude::Region;
use strahl::tracing::{PixelCost, PixelInfo};

impl Channel {
    /// What has to be rendered for it.
    pub(crate) fn kind(self) -> Kind {
        match self {
            Self::Color => Kind::Color,
            Self::Normal
            | Self::Depth
            | Self::Object
            | Self::Material
            | Self::Levels
            | Self::Tests => Kind::Info,
            Self::Steps | Self::Rays | Self::Time => Kind::Costs,
        }
    }

    fn count(self, info: &PixelInfo) -> Option<f64> {
        match self {
            Self::Levels => Some(info.tree_depth.into()),
            Self::Tests => Some(info.tests.into()),
            _ => None,
        }
    }

    fn cost(self, cost: &PixelCost) -> f64 {
        match self {
            Self::Steps => cost.steps as f64,
            Self::Rays => cost.rays as f64,
            _ => cost.nanoseconds as f64 / 1000.0,
        }
    }

    /// The value that gets the brightest colour: the largest of all but a thousandth of the pixels. 0 where no colour means a number.
    pub(crate) fn scale(self, picture: &Picture) -> f64 {
        let canvas = picture.canvas();
        let mut values: Vec<f64> = match self.kind() {
            Kind::Costs => canvas.costs.iter().map(|cost| self.cost(cost)).collect(),
            _ => canvas
                .info
                .iter()
                .filter_map(|info| self.count(info))
                .collect(),
        };
        values.sort_by(f64::total_cmp);
        let index = (values.len() * 999 / 1000).min(values.len().saturating_sub(1));
        values.get(index).copied().unwrap_or(0.0)
    }
}

/// How pixels are shown.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Look {
    pub(crate) channel: Channel,
    /// What light is multiplied by; 1 shows the colours of the picture's file.
    pub(crate) gain: f64,
    /// The tone curve of colours.
    pub(crate) curve: Curve,
    /// The scale of depths: the scene's diagonal.
    pub(crate) diagonal: f64,
    /// See [`Channel::scale`].
    pub(crate) scale: f64,
}

impl Look {
    /// Whether pixels get the same colours, but for the scale of counts, which is known at the end.
    pub(crate) fn shows_the_same(&self, other: &Self) -> bool {
        (self.channel, self.gain, self.curve) == (other.channel, other.gain, other.curve)
    }
}

/// The sRGB codes of the blocks of a region, row by row.
pub(crate) fn srgb8(picture: &Picture, region: Region, step: u32, look: &Look) -> Vec<u8> {
    let canvas = picture.canvas();
    let mut bytes = Vec::with_capacity(3 * region.pixels() as usize / (step * step) as usize + 3);
    for y in (region.y..region.y + region.height).step_by(step.max(1) as usize) {
        for x in (region.x..region.x + region.width).step_by(step.max(1) as usize) {
            let index = y as usize * picture.view.width as usize + x as usize;
            let color = match look.channel.kind() {
                Kind::Color => {
                    let pixel = canvas.pixels.get(index).copied().unwrap_or_default();
                    pixel.map(|c| encode(look.curve.apply(f64::from(c) * look.gain)))
                }
                Kind::Info => canvas
                    .info
                    .get(index)
                    .map_or([0; 3], |info| of_info(info, look)),
                Kind::Costs => canvas.costs.get(index).map_or([0; 3], |cost| {
                    heat(look.channel.cost(cost) / look.scale.max(1e-9))
                }),
            };
            bytes.extend(color);
        }
    }
    bytes
}

/// The sRGB code of a linear value.
fn encode(value: f64) -> u8 {
    strahl::shade::srgb::encode_u8(value as f32)
}

fn of_info(info: &PixelInfo, look: &Look) -> [u8; 3] {
    let code = |v: f64| (v.clamp(0.0, 1.0) * 255.0).round() as u8;
    match look.channel {
        Channel::Normal => match info.object {
            0 => [0; 3],
            _ => info.normal.map(|n| code(f64::from(n) * 0.5 + 0.5)),
        },
        Channel::Depth => {
            let depth = f64::from(info.depth);
            match depth.is_finite() {
                true => [code(1.0 - depth / (depth + look.diagonal)); 3],
                false => [0; 3],
            }
        }
        Channel::Object => distinct(info.object),
        Channel::Material => distinct(info.material),
        channel => {
            let count = channel.count(info).unwrap_or(0.0);
            heat(count / look.scale.max(1e-9))
        }
    }
}

/// A colour for a number that differs from those of its neighbours; black for 0.
fn distinct(number: u32) -> [u8; 3] {
    if number == 0 {
        return [0; 3];
    }
    // Steps of the golden section go round the colours without coming back soon.
    let turn = (f64::from(number) * 0.618_033_988_75).fract() * 6.0;
    let light = 0.62 + 0.3 * (f64::from(number) * 0.414_213_562_37).fract();
    let channel = |shift: f64| {
        let at = (turn + shift) % 6.0;
        let full = (2.0 - (at - 3.0).abs()).clamp(0.0, 1.0);
        ((1.0 - 0.62 * full) * light * 255.0).round() as u8
    };
    [channel(0.0), channel(2.0), channel(4.0)]
}

/// A scale from black through violet, red and yellow to white, for values from 0 to 1.
fn heat(value: f64) -> [u8; 3] {
    const STOPS: [[f64; 3]; 6] = [
        [4.0, 4.0, 12.0],
        [60.0, 15.0, 110.0],
        [150.0, 40.0, 105.0],
        [225.0, 85.0, 55.0],
        [250.0, 180.0, 30.0],
        [252.0, 255.0, 180.0],
    ];
    let at = value.clamp(0.0, 1.0) * (STOPS.len() - 1) as f64;
    let index = (at as usize).min(STOPS.len() - 2);
    let part = at - index as f64;
    std::array::from_fn(|i| {
        (STOPS[index][i] * (1.0 - part) + STOPS[index + 1][i] * part).round() as u8
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tone_curves_rise_from_black_and_keep_what_is_bright() {
        for curve in [Curve::Srgb, Curve::Reinhard, Curve::Filmic] {
            let codes: Vec<u8> = (0..200)
                .map(|i| encode(curve.apply(f64::from(i) * 0.01)))
                .collect();
            assert!(codes[0] == 0 && codes.is_sorted(), "{curve:?}");
        }
        assert_eq!(encode(Curve::Srgb.apply(0.5)), encode(0.5));
        assert!(Curve::Reinhard.apply(100.0) < 1.0 && Curve::Reinhard.apply(2.0) < 0.7);
    }

    #[test]
    fn heat_rises_and_numbers_differ() {
        let light = |c: [u8; 3]| c.iter().map(|c| u32::from(*c)).sum::<u32>();
        let mut before = 0;
        for i in 0..=20 {
            let now = light(heat(f64::from(i) / 20.0));
            assert!(now > before, "{i}");
            before = now;
        }
        assert_eq!(heat(f64::INFINITY), heat(1.0));
        assert_eq!(distinct(0), [0; 3]);
        for i in 1..50 {
            assert_ne!(distinct(i), distinct(i + 1));
        }
    }
}
