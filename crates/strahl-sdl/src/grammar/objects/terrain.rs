use crate::grammar::Entity;
use crate::parser::{PResult, Parser};
use strahl_geometry::{Terrain, TerrainDetail, TerrainKind, TerrainOptions};
use strahl_math::DVec2;
use strahl_math::noise::NoiseGenerator;

/// The items of the object.
const ITEMS: [&str; 11] = [
    "fbm",
    "hetero",
    "ridged",
    "h",
    "lacunarity",
    "octaves",
    "offset",
    "gain",
    "noise_generator",
    "extent",
    "detail",
];

/// `terrain { [fbm | hetero | ridged] [h n] [lacunarity n] [octaves n] [offset n] [gain n] [noise_generator n] [extent <x, z>, <x, z>]
/// [detail <viewpoint>, angle] ... }`
///
/// An extension. Its words that are no keywords have their meaning only here, so that scenes may use them as names.
pub(super) fn terrain(p: &mut Parser<'_>) -> PResult<Entity> {
    p.shape(|p| {
        let mut options = TerrainOptions::default();
        let mut offset = None;
        loop {
            let token = p.peek()?;
            let Some(item) = p.own_word(token, &ITEMS) else {
                break;
            };
            p.take(token)?;
            let place = p.place();
            match item {
                "fbm" => options.kind = TerrainKind::Fbm,
                "hetero" => options.kind = TerrainKind::Hetero,
                "ridged" => options.kind = TerrainKind::Ridged,
                "h" => options.h = p.float()?,
                "lacunarity" => options.lacunarity = p.float()?,
                "octaves" => options.octaves = p.float()?,
                "offset" => offset = Some(p.float()?),
                "gain" => options.gain = p.float()?,
                "noise_generator" => {
                    let number = p.float()?;
                    // The cast turns what is no number into 0.
                    let known = NoiseGenerator::from_number(number as u32);
                    let Some(generator) = known.filter(|_| number.fract() == 0.0) else {
                        let message = format!("there is no noise generator {number}");
                        return Err(p.fail_hint(place, message, "they are 1, 2 and 3"));
                    };
                    options.generator = generator;
                }
                "extent" => {
                    let a = p.corner()?;
                    p.comma()?;
                    options.extent = Some([a, p.corner()?]);
                }
                _ => {
                    let viewpoint = p.vector3()?;
                    p.comma()?;
                    let angle = p.float()?.to_radians();
                    options.detail = Some(TerrainDetail { viewpoint, angle });
                }
            }
            p.comma()?;
        }
        options.offset = offset.unwrap_or(match options.kind {
            TerrainKind::Fbm => 0.0,
            TerrainKind::Hetero => 0.7,
            _ => 1.0,
        });
        Ok(Terrain::try_new(&options))
    })
}

impl Parser<'_> {
    /// `<x, z>`
    fn corner(&mut self) -> PResult<DVec2> {
        let place = self.place();
        let value = self.expression()?;
        if value.len() != 2 {
            let message = format!(
                "a corner of the extent has two components, x and z, found {}",
                value.len()
            );
            return Err(self.fail_hint(place, message, "write `extent <-5, -5>, <5, 5>`"));
        }
        let [x, z, ..] = value.components();
        Ok(DVec2::new(x, z))
    }
}
