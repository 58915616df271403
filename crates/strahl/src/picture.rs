use std::path::Path;
use strahl_formats::image::{
    ImageError, Layer, LayerData, Picture, Window, WriteOptions, write_picture,
};
use strahl_render::{Film, PixelInfo};

/// Writes a film to a picture file whose extension chooses the format; layers are written if the film and the format have
/// them.
///
/// # Errors
/// [`ImageError`]: unknown extension, or the file can't be written. There is never half a file.
pub fn save(path: &Path, film: &Film, options: &WriteOptions) -> Result<(), ImageError> {
    let layers = layers(film);
    write_picture(path, &picture(film, &layers, metadata()), options)
}

/// A film in the form that writers take.
pub fn picture<'a>(
    film: &'a Film,
    layers: &'a [Layer],
    metadata: Vec<(String, String)>,
) -> Picture<'a> {
    let r = film.region;
    Picture {
        width: film.width,
        height: film.height,
        window: Window {
            x: r.x,
            y: r.y,
            width: r.width,
            height: r.height,
        },
        rgb: &film.pixels,
        alpha: film.alpha.as_deref(),
        layers,
        metadata,
    }
}

/// Metadata of a picture: the program and its version.
pub fn metadata() -> Vec<(String, String)> {
    vec![(
        "Software".into(),
        concat!("strahl ", env!("CARGO_PKG_VERSION")).into(),
    )]
}

/// The film's further data as layers: `depth.Z`, `normal.XYZ`, `position.XYZ`, `object.id`, `material.id`, `tree.depth`,
/// `tests.count`. Empty if the film has none.
pub fn layers(film: &Film) -> Vec<Layer> {
    let Some(info) = &film.info else {
        return vec![];
    };
    let floats = |name: &str, channels: &[&str], value: &dyn Fn(&PixelInfo) -> Vec<f32>| Layer {
        name: name.into(),
        channels: channels.iter().map(|c| (*c).into()).collect(),
        data: LayerData::F32(info.iter().flat_map(value).collect()),
    };
    let numbers = |name: &str, channel: &str, value: &dyn Fn(&PixelInfo) -> u32| Layer {
        name: name.into(),
        channels: vec![channel.into()],
        data: LayerData::U32(info.iter().map(value).collect()),
    };
    vec![
        floats("depth", &["Z"], &|p| vec![p.depth]),
        floats("normal", &["X", "Y", "Z"], &|p| p.normal.to_vec()),
        floats("position", &["X", "Y", "Z"], &|p| p.position.to_vec()),
        numbers("object", "id", &|p| p.object),
        numbers("material", "id", &|p| p.material),
        numbers("tree", "depth", &|p| p.tree_depth),
        numbers("tests", "count", &|p| p.tests),
    ]
}
