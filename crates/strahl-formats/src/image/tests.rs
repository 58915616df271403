//! Whole pictures: other programs' readers find what was written.

use std::fs;
use std::io::{self, Cursor, Write};

use strahl_shade::image_texture::{ColorSpace, TexelChannels, TexelData};
use strahl_shade::srgb;

use super::*;

/// A picture with every code, values outside of the codes' range, and no symmetry.
fn colors(width: u32, height: u32) -> Vec<[f32; 3]> {
    let mut rgb: Vec<[f32; 3]> = (0..width * height)
        .map(|i| {
            let (x, y) = (i % width, i / width);
            let code = srgb::decode_u8((i % 256) as u8);
            [
                code,
                x as f32 / width as f32,
                3.0 * y as f32 / height as f32,
            ]
        })
        .collect();
    rgb[1] = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY];
    rgb[2] = [-1.0, 1e-30, 1e30];
    rgb
}

fn encoded(format: ImageFormat, picture: &Picture<'_>, options: &WriteOptions) -> Vec<u8> {
    let mut bytes = Vec::new();
    encode_picture(&mut bytes, format, picture, options).unwrap();
    bytes
}

fn with_bits(bit_depth: BitDepth) -> WriteOptions {
    WriteOptions {
        bit_depth,
        ..WriteOptions::default()
    }
}

fn metadata() -> Vec<(String, String)> {
    [
        ("software", "strahl 0.1.0"),
        ("scene", "Übung 3.pov"),
        ("accelerator", "bvh"),
        ("command", "two\nlines = one"),
    ]
    .map(|(key, value)| (key.to_owned(), value.to_owned()))
    .into()
}

fn layers(pixels: usize) -> Vec<Layer> {
    let layer = |name: &str, channels: &[&str], data| Layer {
        name: name.to_owned(),
        channels: channels.iter().map(|&channel| channel.to_owned()).collect(),
        data,
    };
    let numbers = 0..pixels as u32;
    vec![
        layer(
            "depth",
            &["Z"],
            LayerData::F32(numbers.clone().map(|i| i as f32 / 7.0).collect()),
        ),
        layer(
            "N",
            &["X", "Y", "Z"],
            LayerData::F32((0..3 * pixels).map(|i| i as f32).collect()),
        ),
        layer(
            "object",
            &["id"],
            LayerData::U32(numbers.map(|i| u32::MAX - i).collect()),
        ),
    ]
}

/// A 20 x 9 region at (5, 3) of a 40 x 30 picture.
fn region(rgb: &[[f32; 3]]) -> Picture<'_> {
    let window = Window {
        x: 5,
        y: 3,
        width: 20,
        height: 9,
    };
    Picture {
        window,
        metadata: metadata(),
        ..Picture::new(40, 30, rgb)
    }
}

#[test]
fn integer_formats_hold_the_srgb_codes() {
    let rgb = colors(37, 20);
    let picture = Picture::new(37, 20, &rgb);
    for format in [ImageFormat::Png, ImageFormat::Ppm] {
        let bytes = encoded(format, &picture, &with_bits(BitDepth::Eight));
        let back = ::image::load_from_memory(&bytes).unwrap();
        assert_eq!((back.width(), back.height()), (37, 20));
        let expected: Vec<u8> = rgb
            .as_flattened()
            .iter()
            .map(|&x| srgb::encode_u8(x))
            .collect();
        assert_eq!(back.as_rgb8().unwrap().as_raw(), &expected, "{format:?}");
        for (i, pixel) in expected.chunks_exact(3).enumerate().skip(3) {
            assert_eq!(usize::from(pixel[0]), i % 256);
        }
        assert_eq!(expected[3..9], [0, 255, 0, 0, 0, 255]);

        let bytes = encoded(format, &picture, &with_bits(BitDepth::Sixteen));
        let back = ::image::load_from_memory(&bytes).unwrap();
        let expected: Vec<u16> = rgb
            .as_flattened()
            .iter()
            .map(|&x| srgb::encode_u16(f64::from(x)))
            .collect();
        assert_eq!(back.as_rgb16().unwrap().as_raw(), &expected, "{format:?}");
    }
}

/// The expected values are those of POV-Ray 3.7 with `+FNG`.
#[test]
fn grey_pictures_have_one_channel() {
    let rgb = [[1.0, 0.0, 0.0], [0.2, 0.5, 0.8], [2.0; 3], [3.0, 0.1, 0.0]];
    let expected = [0.581155, 0.697963, 1.0, 0.977646].map(|x: f64| (x * 65535.0).round() as u16);
    let options = WriteOptions {
        grayscale: true,
        ..with_bits(BitDepth::Sixteen)
    };
    for format in [ImageFormat::Png, ImageFormat::Ppm] {
        let bytes = encoded(format, &Picture::new(4, 1, &rgb), &options);
        let back = ::image::load_from_memory(&bytes).unwrap();
        let pairs = back.as_luma16().unwrap().as_raw().iter().zip(expected);
        assert!(pairs.clone().all(|(a, b)| a.abs_diff(b) <= 1), "{pairs:?}");
    }
    let alpha = [1.0, 1.0, 1.0, 0.5];
    let picture = Picture {
        alpha: Some(&alpha),
        ..Picture::new(4, 1, &rgb)
    };
    let bytes = encoded(ImageFormat::Png, &picture, &options);
    let back = ::image::load_from_memory(&bytes).unwrap();
    let codes = back.as_luma_alpha16().unwrap().as_raw();
    assert_eq!((codes[1], codes[7]), (65535, 32768));
}

/// Large pictures are compressed row by row, others at once.
#[test]
fn png_pictures_of_all_sizes_hold_the_same_rows() {
    let (width, height) = (2048, 1025);
    let rgb = colors(width, height);
    let codes = |height: u32| {
        let part = &rgb[..(width * height) as usize];
        let bytes = encoded(
            ImageFormat::Png,
            &Picture::new(width, height, part),
            &WriteOptions::default(),
        );
        image::load_from_memory(&bytes).unwrap().into_rgb8()
    };
    let (large, small) = (codes(height), codes(1024));
    assert_eq!(large.as_raw()[..small.as_raw().len()], small.as_raw()[..]);
    assert_eq!(large.dimensions(), (width, height));
}

#[test]
fn png_tells_its_colour_space_metadata_and_region() {
    let rgb = colors(20, 9);
    let bytes = encoded(ImageFormat::Png, &region(&rgb), &WriteOptions::default());
    let reader = ::png::Decoder::new(Cursor::new(&bytes))
        .read_info()
        .unwrap();
    let info = reader.info();
    assert_eq!((info.width, info.height), (20, 9));
    assert_eq!(info.srgb, Some(::png::SrgbRenderingIntent::Perceptual));
    let latin: Vec<(&str, &str)> = info
        .uncompressed_latin1_text
        .iter()
        .map(|chunk| (chunk.keyword.as_str(), chunk.text.as_str()))
        .collect();
    assert_eq!(
        latin,
        [
            ("Software", "strahl 0.1.0"),
            ("accelerator", "bvh"),
            ("command", "two\nlines = one"),
            ("region", "20x9+5+3 of 40x30"),
        ]
    );
    assert_eq!(info.utf8_text[0].keyword, "scene");
    assert_eq!(info.utf8_text[0].get_text().unwrap(), "Übung 3.pov");

    let offset = bytes
        .windows(4)
        .position(|window| window == b"oFFs")
        .unwrap();
    assert_eq!(bytes[offset + 4..offset + 13], [0, 0, 0, 5, 0, 0, 0, 3, 0]);
    let data = bytes
        .windows(4)
        .position(|window| window == b"IDAT")
        .unwrap();
    assert!(offset < data);
}

#[test]
fn text_headers_tell_metadata_and_region() {
    let rgb = colors(20, 9);
    for format in [ImageFormat::Ppm, ImageFormat::Hdr] {
        let bytes = encoded(format, &region(&rgb), &WriteOptions::default());
        let header = String::from_utf8_lossy(&bytes[..300]).into_owned();
        for line in [
            "# software: strahl 0.1.0\n",
            "# scene: Übung 3.pov\n",
            "# command: two lines = one\n",
            "# region: 20x9+5+3 of 40x30\n",
        ] {
            assert!(header.contains(line), "{header}");
        }
        let back = ::image::load_from_memory(&bytes).unwrap();
        assert_eq!((back.width(), back.height()), (20, 9));
    }
}

#[test]
fn radiance_pictures_are_close() {
    // Narrow rows are stored flat, wide ones as runs.
    for (width, height) in [(5, 30), (300, 3)] {
        let mut rgb = colors(width, height);
        rgb[10..]
            .iter_mut()
            .take(100)
            .for_each(|pixel| *pixel = [0.25, 0.5, 2.0]);
        let picture = Picture::new(width, height, &rgb);
        let bytes = encoded(ImageFormat::Hdr, &picture, &WriteOptions::default());
        let back = ::image::load_from_memory(&bytes).unwrap().into_rgb32f();
        assert_eq!((back.width(), back.height()), (width, height));
        for (i, (pixel, back)) in rgb.iter().zip(back.pixels()).enumerate().skip(3) {
            let largest = pixel.iter().copied().fold(0.0, f32::max);
            for channel in 0..3 {
                let error = (pixel[channel] - back[channel]).abs();
                assert!(error <= largest / 256.0, "{i}: {pixel:?} {back:?}");
            }
        }
        assert_eq!(back.get_pixel(1, 0).0[0], 0.0);
        assert_eq!(back.get_pixel(11 % width, 11 / width).0, [0.25, 0.5, 2.0]);
    }
}

/// The samples of a channel of an EXR file.
fn exr_channel(bytes: &[u8], name: &str) -> ::exr::image::FlatSamples {
    use ::exr::prelude::*;
    let image = read()
        .no_deep_data()
        .largest_resolution_level()
        .all_channels()
        .first_valid_layer()
        .all_attributes()
        .from_buffered(Cursor::new(bytes))
        .unwrap();
    let found = |channel: &&AnyChannel<FlatSamples>| channel.name == *name;
    let channels = &image.layer_data.channel_data.list;
    channels.iter().find(found).unwrap().sample_data.clone()
}

#[test]
fn exr_holds_everything_exactly() {
    use ::exr::image::FlatSamples;
    use ::exr::math::Vec2;
    use ::exr::meta::attribute::{AttributeValue, Text};

    let rgb = colors(20, 9);
    let layers = layers(180);
    let picture = Picture {
        layers: &layers,
        ..region(&rgb)
    };
    let bytes = encoded(ImageFormat::Exr, &picture, &WriteOptions::default());

    let meta = ::exr::meta::MetaData::read_from_buffered(Cursor::new(&bytes), true).unwrap();
    assert_eq!(meta.headers.len(), 1);
    let header = &meta.headers[0];
    assert_eq!(header.layer_size, Vec2(20, 9));
    assert_eq!(header.own_attributes.layer_position, Vec2(5, 3));
    assert_eq!(header.shared_attributes.display_window.size, Vec2(40, 30));
    assert_eq!(header.shared_attributes.display_window.position, Vec2(0, 0));
    assert_eq!(
        header.shared_attributes.chromaticities.unwrap().red,
        Vec2(0.64, 0.33)
    );
    let names: Vec<String> = header
        .channels
        .list
        .iter()
        .map(|c| c.name.to_string())
        .collect();
    assert_eq!(
        names,
        ["B", "G", "N.X", "N.Y", "N.Z", "R", "depth.Z", "object.id"]
    );
    assert_eq!(
        header.own_attributes.software_name,
        Text::new_or_none("strahl 0.1.0")
    );
    let scene = &header.own_attributes.other[&Text::from("strahl:scene")];
    let AttributeValue::Text(scene) = scene else {
        panic!("{scene:?}")
    };
    assert_eq!(scene.as_slice(), "Übung 3.pov".as_bytes());

    for (channel, name) in ["R", "G", "B"].into_iter().enumerate() {
        let FlatSamples::F32(samples) = exr_channel(&bytes, name) else {
            panic!("{name} is no f32")
        };
        let bits = |x: f32| x.to_bits();
        assert!(
            samples
                .iter()
                .map(|&x| bits(x))
                .eq(rgb.iter().map(|pixel| bits(pixel[channel])))
        );
    }
    let FlatSamples::F32(normals) = exr_channel(&bytes, "N.Y") else {
        panic!("N.Y is no f32")
    };
    assert!(
        normals
            .iter()
            .copied()
            .eq((0..180).map(|i| (3 * i + 1) as f32))
    );
    let FlatSamples::U32(ids) = exr_channel(&bytes, "object.id") else {
        panic!("object.id is no u32")
    };
    assert!(ids.into_iter().eq((0..180).map(|i| u32::MAX - i)));
}

#[test]
fn exr_colours_may_be_halves() {
    use ::exr::image::FlatSamples;
    let rgb = colors(20, 9);
    let layers = layers(180);
    let picture = Picture {
        layers: &layers,
        ..Picture::new(20, 9, &rgb)
    };
    let half = WriteOptions {
        half: true,
        ..WriteOptions::default()
    };
    let bytes = encoded(ImageFormat::Exr, &picture, &half);
    let FlatSamples::F16(samples) = exr_channel(&bytes, "B") else {
        panic!("B is no f16")
    };
    for (half, pixel) in samples.iter().zip(&rgb).skip(3) {
        assert!((half.to_f32() - pixel[2]).abs() <= pixel[2] / 2048.0);
    }
    assert_eq!(samples[2].to_f32(), 65_504.0);
    assert!(matches!(
        exr_channel(&bytes, "depth.Z"),
        FlatSamples::F32(_)
    ));
}

#[test]
fn alpha_is_straight_in_png_and_associated_in_exr() {
    // Half covered red, empty, opaque green.
    let rgb = [[0.5, 0.0, 0.0], [0.0; 3], [0.0, 1.0, 0.0]];
    let alpha = [0.5, 0.0, 1.0];
    let picture = Picture {
        alpha: Some(&alpha),
        ..Picture::new(3, 1, &rgb)
    };
    let png = encoded(ImageFormat::Png, &picture, &WriteOptions::default());
    let read = ::image::load_from_memory(&png).unwrap().into_rgba8();
    assert_eq!(
        read.into_raw(),
        [255, 0, 0, 128, 0, 0, 0, 0, 0, 255, 0, 255]
    );
    let png = encoded(ImageFormat::Png, &picture, &with_bits(BitDepth::Sixteen));
    let read = ::image::load_from_memory(&png).unwrap().into_rgba16();
    assert_eq!(read.get_pixel(0, 0).0, [65535, 0, 0, 32768]);
    let exr = encoded(ImageFormat::Exr, &picture, &WriteOptions::default());
    for (name, values) in [("R", [0.5, 0.0, 0.0]), ("A", alpha)] {
        let ::exr::image::FlatSamples::F32(samples) = exr_channel(&exr, name) else {
            panic!("{name} is no f32")
        };
        assert_eq!(samples, values);
    }
    for info in formats().iter().filter(|info| !info.alpha) {
        let mut bytes = vec![];
        let result = encode_picture(&mut bytes, info.format, &picture, &WriteOptions::default());
        assert!(
            matches!(result, Err(ImageError::AlphaUnsupported { .. })),
            "{}",
            info.name
        );
    }
}

#[test]
fn the_same_picture_gives_the_same_bytes() {
    let rgb = colors(20, 9);
    let layers = layers(180);
    for info in formats() {
        let picture = Picture {
            layers: if info.layers { &layers } else { &[] },
            ..region(&rgb)
        };
        let first = encoded(info.format, &picture, &WriteOptions::default());
        for _ in 0..4 {
            let again = encoded(info.format, &picture, &WriteOptions::default());
            assert_eq!(first, again, "{}", info.name);
        }
    }
}

#[test]
fn files_hold_what_streams_do() {
    let folder = tempfile::tempdir().unwrap();
    let rgb = colors(20, 9);
    for info in formats() {
        let path = folder
            .path()
            .join("picture")
            .with_extension(info.extensions[0]);
        write_picture(&path, &region(&rgb), &WriteOptions::default()).unwrap();
        let stream = encoded(info.format, &region(&rgb), &WriteOptions::default());
        assert_eq!(fs::read(&path).unwrap(), stream, "{}", info.name);
    }
    assert_eq!(
        fs::read_dir(folder.path()).unwrap().count(),
        formats().len()
    );
}

/// Accepts some bytes, then fails.
struct Full(usize);

impl Write for Full {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let taken = bytes.len().min(self.0);
        self.0 -= taken;
        if taken == 0 && !bytes.is_empty() {
            return Err(io::ErrorKind::StorageFull.into());
        }
        Ok(taken)
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

#[test]
fn each_encoder_reports_a_full_disk_wherever_it_occurs() {
    let rgb = colors(20, 9);
    for info in formats() {
        let size = encoded(info.format, &region(&rgb), &WriteOptions::default()).len();
        for room in [0, 1, 10, size / 2, size - 1] {
            let result = encode_picture(
                &mut Full(room),
                info.format,
                &region(&rgb),
                &WriteOptions::default(),
            );
            match result {
                Err(ImageError::Write { source, .. }) => {
                    assert_eq!(source.kind(), io::ErrorKind::StorageFull, "{}", info.name);
                }
                other => panic!("{} at {room} of {size}: {other:?}", info.name),
            }
        }
    }
}

#[test]
fn contradictory_pictures_are_refused() {
    let rgb = colors(4, 3);
    let good = Picture::new(4, 3, &rgb);
    let refused = |picture: &Picture<'_>| {
        let mut bytes = Vec::new();
        let result = encode_picture(
            &mut bytes,
            ImageFormat::Exr,
            picture,
            &WriteOptions::default(),
        );
        assert!(bytes.is_empty());
        result.unwrap_err().to_string()
    };
    assert!(refused(&Picture::new(0, 3, &[])).contains("0 x 3 pixels"));
    assert!(
        refused(&Picture::new(5, 3, &rgb))
            .contains("a picture of 5 x 3 pixels was given 12 colours")
    );
    let shifted = Picture {
        window: Window {
            x: 1,
            ..good.window
        },
        ..good.clone()
    };
    assert!(refused(&shifted).contains("leaves the picture"));
    let far = Picture {
        window: Window {
            y: u32::MAX,
            ..good.window
        },
        ..good.clone()
    };
    assert!(refused(&far).contains("leaves the picture"));
    let huge = Picture {
        width: u32::MAX,
        ..good.clone()
    };
    assert!(refused(&huge).contains("ends at 2147483647"));

    let with_layer = |name: &str, channels: &[&str], count| {
        let layers = [Layer {
            name: name.to_owned(),
            channels: channels.iter().map(|&channel| channel.to_owned()).collect(),
            data: LayerData::F32(vec![0.0; count]),
        }];
        refused(&Picture {
            layers: &layers,
            ..good.clone()
        })
    };
    assert!(with_layer("N", &["X", "Y"], 12).contains("2 channels and 12 samples"));
    assert!(with_layer("N", &[], 0).contains("0 channels"));
    assert!(with_layer("", &["R"], 12).contains("two channels are called `R`"));
    assert!(with_layer("N", &[""], 12).contains("not a valid channel name"));
    assert!(with_layer("a b", &["X"], 12).contains("not a valid channel name"));
    assert!(with_layer(&"n".repeat(30), &["X"], 12).contains("not a valid channel name"));

    let with_metadata = |pairs: &[(&str, &str)]| {
        let owned = |&(key, value): &(&str, &str)| (key.to_owned(), value.to_owned());
        refused(&Picture {
            metadata: pairs.iter().map(owned).collect(),
            ..good.clone()
        })
    };
    for key in ["", " a", "a ", "a  b", "ä", "a\n", &"k".repeat(80)] {
        assert!(
            with_metadata(&[(key, "")]).contains("is not a valid metadata key"),
            "{key}"
        );
    }
    assert!(with_metadata(&[("a", ""), ("a", "")]).contains("given twice"));
    assert!(with_metadata(&[("region", "")]).contains("given twice, or is the writer's own"));
    assert!(with_metadata(&[("a", "\0")]).contains("NUL"));
}

#[test]
fn layers_are_refused_where_they_would_be_lost() {
    let rgb = colors(4, 3);
    let layers = layers(12);
    let picture = Picture {
        layers: &layers,
        ..Picture::new(4, 3, &rgb)
    };
    for info in formats().iter().filter(|info| !info.layers) {
        let error = encode_picture(
            &mut Vec::new(),
            info.format,
            &picture,
            &WriteOptions::default(),
        )
        .unwrap_err()
        .to_string();
        assert!(
            error.contains("`depth`") && error.contains("OpenEXR"),
            "{error}"
        );
    }
}

#[test]
fn textures_keep_the_precision_of_their_files() {
    let rgb = colors(20, 9);
    let picture = Picture::new(20, 9, &rgb);
    let decode = |format, bit_depth, texture_use| {
        let bytes = encoded(format, &picture, &with_bits(bit_depth));
        decode_texture(&bytes, "test", texture_use).unwrap()
    };

    let texture = decode(ImageFormat::Png, BitDepth::Eight, TextureUse::Color);
    assert!(matches!(texture.data(), TexelData::U8(_)));
    assert_eq!(texture.channels(), TexelChannels::Rgb);
    assert_eq!((texture.width(), texture.height()), (20, 9));
    // The pictures' first channel consists of exact codes.
    for i in 3..180_u32 {
        assert_eq!(texture.fetch(i % 20, i / 20)[0], rgb[i as usize][0]);
    }

    let texture = decode(ImageFormat::Ppm, BitDepth::Sixteen, TextureUse::Data);
    assert!(matches!(texture.data(), TexelData::U16(_)));
    assert_eq!(texture.color_space(), ColorSpace::Linear);
    assert_eq!(texture.fetch(1, 0), [0.0, 1.0, 0.0, 1.0]);

    for format in [ImageFormat::Exr, ImageFormat::Hdr] {
        let texture = decode(format, BitDepth::Eight, TextureUse::Color);
        assert!(matches!(texture.data(), TexelData::F32(_)));
        let tolerance = if format == ImageFormat::Exr {
            0.0
        } else {
            3.0 / 256.0
        };
        for i in 3..180_u32 {
            let texel = texture.fetch(i % 20, i / 20);
            for channel in 0..3 {
                assert!((texel[channel] - rgb[i as usize][channel]).abs() <= tolerance);
            }
            assert_eq!(texel[3], 1.0);
        }
    }
    let exr = decode(ImageFormat::Exr, BitDepth::Eight, TextureUse::Color);
    assert_eq!(exr.fetch(1, 0), [0.0, f32::MAX, f32::MIN, 1.0]);
}

#[test]
fn textures_of_the_other_formats() {
    let pixels = ::image::RgbaImage::from_fn(9, 5, |x, y| {
        ::image::Rgba([x as u8 * 20, y as u8 * 40, 7, 255 - x as u8])
    });
    for format in [
        ::image::ImageFormat::Png,
        ::image::ImageFormat::Tga,
        ::image::ImageFormat::Bmp,
        ::image::ImageFormat::Tiff,
    ] {
        let mut bytes = Cursor::new(Vec::new());
        pixels.write_to(&mut bytes, format).unwrap();
        // TGA is recognised only by its name.
        let name = format!("texture.{}", format.extensions_str()[0]);
        let texture = decode_texture(bytes.get_ref(), &name, TextureUse::Data).unwrap();
        assert_eq!(texture.channels(), TexelChannels::Rgba, "{format:?}");
        let expected = [60, 80, 7, 252].map(|code| f32::from(code as u8) / 255.0);
        assert_eq!(texture.fetch(3, 2), expected, "{format:?}");
    }
    let mut jpeg = Cursor::new(Vec::new());
    let gray = ::image::GrayImage::from_pixel(16, 8, ::image::Luma([200]));
    gray.write_to(&mut jpeg, ::image::ImageFormat::Jpeg)
        .unwrap();
    let texture = decode_texture(jpeg.get_ref(), "no extension", TextureUse::Color).unwrap();
    assert_eq!(texture.channels(), TexelChannels::Gray);
    assert!((texture.fetch(5, 5)[0] - srgb::decode_u8(200)).abs() < 0.01);
}

#[test]
fn tga_stores_straight_colours_with_alpha() {
    let (rgb, alpha) = ([[0.5, 0.25, 0.0], [0.0; 3]], [0.5, 0.0]);
    let mut picture = Picture::new(2, 1, &rgb);
    picture.alpha = Some(&alpha);
    let bytes = encoded(ImageFormat::Tga, &picture, &WriteOptions::default());
    let texture = decode_texture(&bytes, "a.tga", TextureUse::Data).unwrap();
    let codes = |x| texture.fetch(x, 0).map(|code| (code * 255.0).round() as u8);
    assert_eq!((codes(0), codes(1)), ([255, 188, 0, 128], [0, 0, 0, 0]));
}

#[test]
fn damaged_textures_are_errors() {
    let rgb = colors(20, 9);
    // A truncated JPEG is still a picture.
    let exact = |info: &&FormatInfo| info.format != ImageFormat::Jpeg;
    for info in formats().iter().filter(exact) {
        let bytes = encoded(info.format, &region(&rgb), &WriteOptions::default());
        for length in (0..bytes.len()).step_by(7) {
            let result = decode_texture(&bytes[..length], "cut", TextureUse::Color);
            // PNG's last chunk, of twelve bytes, only marks the end.
            let is_whole = info.format == ImageFormat::Png && bytes.len() - length <= 12;
            assert!(
                result.is_err() || is_whole,
                "{} cut at {length} of {}",
                info.name,
                bytes.len()
            );
        }
        // Changed bytes may still decode; they must not cause a panic.
        for position in (0..bytes.len()).step_by(3) {
            let mut changed = bytes.clone();
            changed[position] ^= 0xff;
            let _ = decode_texture(&changed, "changed", TextureUse::Color);
        }
    }
    for (bytes, name) in [
        (&b""[..], "empty"),
        (b"hello", "text.txt"),
        (b"hello", "text.png"),
    ] {
        let error = decode_texture(bytes, name, TextureUse::Color).unwrap_err();
        assert!(matches!(error, ImageError::Decode { .. }), "{error}");
        assert!(error.to_string().contains(name));
    }
    let zip = decode_texture(b"PK\x03\x04\x14\0", "a.png", TextureUse::Color).unwrap_err();
    let expected = "the texture `a.png` cannot be decoded: it is a ZIP archive; ";
    assert!(zip.to_string().starts_with(expected), "{zip}");
    let error = read_texture("absent/texture.png", TextureUse::Color).unwrap_err();
    assert!(matches!(error, ImageError::Read { .. }), "{error}");
}

#[test]
fn enormous_textures_are_refused_before_they_take_memory() {
    // A header that claims 65536 x 32768 texels.
    let bytes = b"P6\n65536 32768\n255\n".to_vec();
    let error = decode_texture(&bytes, "huge.ppm", TextureUse::Color).unwrap_err();
    assert!(
        matches!(error, ImageError::TextureTooLarge { .. }),
        "{error}"
    );
    assert!(error.to_string().contains("65536 x 32768"), "{error}");

    let rgb = colors(20, 9);
    let mut bytes = encoded(
        ImageFormat::Exr,
        &Picture::new(20, 9, &rgb),
        &WriteOptions::default(),
    );
    let name = b"dataWindow\0box2i\0";
    let start = bytes.windows(name.len()).position(|w| w == name).unwrap() + name.len() + 4;
    for value in [start + 8, start + 12] {
        bytes[value..value + 4].copy_from_slice(&100_000_i32.to_le_bytes());
    }
    let error = decode_texture(&bytes, "huge.exr", TextureUse::Color).unwrap_err();
    assert!(
        matches!(error, ImageError::TextureTooLarge { .. }),
        "{error}"
    );
}
