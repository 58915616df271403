//! Pictures in textures: palettes, and the meaning of their codes.

use super::color_at;
use crate::common::parse_with;
use strahl_math::DVec3;
use strahl_sdl::MemoryHost;
use strahl_shade::Color;
use strahl_shade::normal::NormalKind;
use strahl_shade::patterns::TexturePoint;
use strahl_shade::texture::Texture;

/// A BMP of 2 x 1 texels with a palette whose entries have the same colour.
fn picture_with_a_palette() -> Vec<u8> {
    let mut bytes = b"BM".to_vec();
    let (palette, row) = ([9u8, 9, 9, 0].repeat(2), [0u8, 1, 0, 0]);
    let header = 14 + 40;
    let offset = header + palette.len() as u32;
    for number in [offset + row.len() as u32, 0, offset, 40, 2, 1] {
        bytes.extend(number.to_le_bytes());
    }
    for number in [1u16, 8] {
        bytes.extend(number.to_le_bytes());
    }
    for number in [0u32, 4, 0, 0, 2, 2] {
        bytes.extend(number.to_le_bytes());
    }
    bytes.extend(palette);
    bytes.extend(row);
    bytes
}

#[test]
fn material_maps_choose_by_the_index_in_a_palette() {
    let mut host = MemoryHost::new().with_file("codes.bmp", picture_with_a_palette());
    let text = "sphere { 0, 1 texture { material_map { bmp \"codes.bmp\"
        texture { pigment { rgb x } } texture { pigment { rgb y } } } } }";
    let parsed = parse_with(&mut host, text);
    let scene = parsed.scene.expect("a scene");
    let texture = scene.objects.0[0]
        .material
        .as_ref()
        .unwrap()
        .texture
        .clone();
    let texture = texture.unwrap().0;
    let seen = |x: f64| {
        let point = TexturePoint::in_space(DVec3::new(x, 0.5, 0.0));
        let mut paint = strahl_shade::texture::TexturePaint::default();
        texture.layers_at(&point, 1.0, &mut paint);
        paint.layers[0].color.rgb
    };
    assert_eq!(seen(0.25), Color::new(1.0, 0.0, 0.0));
    assert_eq!(seen(0.75), Color::new(0.0, 1.0, 0.0));
}

/// As in POV-Ray (measured with a picture of 256 codes and 7 textures).
#[test]
fn codes_of_a_material_map_begin_again_behind_their_count() {
    let mut host = MemoryHost::new().with_file(
        "codes.ppm",
        b"P6 8 1 255\n\x00\0\0\x01\0\0\x02\0\0\x03\0\0\x04\0\0\x05\0\0\x06\0\0\x07\0\0".to_vec(),
    );
    let text = "sphere { 0, 1 texture { material_map { ppm \"codes.ppm\"
        texture { pigment { rgb 0 } } texture { pigment { rgb 1 } } texture { pigment { rgb 2 } } } } }";
    let scene = parse_with(&mut host, text).scene.expect("a scene");
    let material = scene.objects.0[0].material.as_ref().unwrap();
    let texture = material.texture.clone().unwrap().0;
    let seen = |code: f64| {
        let point = TexturePoint::in_space(DVec3::new((code + 0.5) / 8.0, 0.5, 0.0));
        let mut paint = strahl_shade::texture::TexturePaint::default();
        texture.layers_at(&point, 1.0, &mut paint);
        paint.layers[0].color.rgb.r
    };
    let textures: Vec<f64> = (0..8).map(|code| seen(f64::from(code))).collect();
    assert_eq!(textures, [0.0, 1.0, 2.0, 2.0, 1.0, 2.0, 0.0, 1.0]);
}

/// A picture of one grey texel with code 128 in three formats: BMP, whose codes are usually sRGB; PPM, which doesn't specify
/// them; and HDR, which is linear.
fn one_texel() -> MemoryHost {
    let mut bmp =
        b"BM\x3a\0\0\0\0\0\0\0\x36\0\0\0\x28\0\0\0\x01\0\0\0\x01\0\0\0\x01\0\x18\0".to_vec();
    bmp.resize(54, 0);
    bmp.extend([128, 128, 128, 0]);
    MemoryHost::new()
        .with_file("p.bmp", bmp)
        .with_file("p.ppm", b"P6\n1 1\n255\n\x80\x80\x80".to_vec())
        .with_file(
            "p.hdr",
            b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 1\n\x80\x80\x80\x80".to_vec(),
        )
}

fn red_of(pigment: &str, header: &str) -> f64 {
    let text = format!("{header} sphere {{ 0, 1 pigment {{ {pigment} }} }}");
    let parsed = parse_with(&mut one_texel(), &text);
    let messages: Vec<_> = parsed.diagnostics.iter().map(ToString::to_string).collect();
    let scene = parsed
        .scene
        .unwrap_or_else(|| panic!("{text}\n{}", messages.join("\n")));
    let material = scene.objects.0[0].material.as_ref().expect("a material");
    let texture = &material.texture.as_ref().expect("a texture").0;
    color_at(texture, DVec3::splat(0.5)).rgb.r
}

/// How POV-Ray 3.7 converts the codes of pictures: by version, `assumed_gamma` and the format's own specification.
#[test]
fn image_maps_of_scenes_that_are_not_linear_have_povrays_colours() {
    let code = 128.0 / 255.0;
    let linear = strahl_shade::srgb::decode(code);
    let float = 0.5;
    let in_2_2 = |x: f64| x.powf(1.0 / 2.2);
    let raised = code.powf(2.2);
    let set = |version: &str, gamma: &str| {
        format!("#version {version}; global_settings {{ assumed_gamma {gamma} }}")
    };
    // The values of BMP, PPM, HDR, and of the BMP with `gamma 2.2`.
    let table = [
        (String::new(), [code, code, float, raised]),
        ("#version 3.6;".to_owned(), [code, code, float, raised]),
        (set("3.6", "1"), [code, code, float, raised]),
        (set("3.6", "2.2"), [code, code, in_2_2(float), code]),
        ("#version 3.7;".to_owned(), [linear, code, float, raised]),
        (set("3.7", "1"), [linear, code, float, raised]),
        (
            set("3.7", "2.2"),
            [in_2_2(linear), code, in_2_2(float), code],
        ),
        (
            set("3.7", "srgb"),
            [
                code,
                code,
                strahl_shade::srgb::encode(float),
                strahl_shade::srgb::encode(raised),
            ],
        ),
    ];
    for (header, expected) in table {
        let pictures = [
            "image_map { bmp \"p.bmp\" }",
            "image_map { ppm \"p.ppm\" }",
            "image_map { hdr \"p.hdr\" }",
            "image_map { bmp \"p.bmp\" gamma 2.2 }",
        ];
        for (picture, expected) in pictures.iter().zip(expected) {
            let got = red_of(picture, &header);
            assert!(
                (got - expected).abs() < 0.003,
                "{header} {picture}: {got} is not {expected}"
            );
        }
        // Data always use the codes.
        let pattern = "image_pattern { bmp \"p.bmp\" } color_map { [0 rgb 0] [1 rgb 1] }";
        assert!((red_of(pattern, &header) - code).abs() < 1e-6, "{header}");
    }
    // A setting after the picture has no effect on it.
    let late = "#version 3.7; #declare P = pigment { image_map { bmp \"p.bmp\" } } global_settings { assumed_gamma 2.2 }";
    assert!((red_of("P", late) - linear).abs() < 1e-6);
}

#[test]
fn srgb_colours_are_numbers_of_the_scene() {
    for (header, expected) in [
        (
            "#version 3.7; global_settings { assumed_gamma 1 }",
            strahl_shade::srgb::decode(0.5),
        ),
        ("#version 3.7; global_settings { assumed_gamma srgb }", 0.5),
        ("", 0.5),
    ] {
        let got = red_of("srgb 0.5", header);
        assert!((got - expected).abs() < 1e-9, "{header}: {got}");
    }
}

/// In pictures with a palette `filter` and `transmit` set entries, and the last item counts, as POV-Ray 3.7 shows it.
#[test]
fn entries_of_a_palette_filter_and_transmit() {
    for (items, left, right) in [
        ("", [0.0, 0.0], [0.0, 0.0]),
        ("transmit 1, 0.8", [0.0, 0.0], [0.0, 0.8]),
        ("filter 0 0.5 filter 1, 0.25", [0.5, 0.0], [0.25, 0.0]),
        ("transmit 1, 0.8 transmit all 0.1", [0.0, 0.1], [0.0, 0.1]),
        ("transmit all 0.1 transmit 1, 0.8", [0.0, 0.1], [0.0, 0.8]),
        ("filter all 0.1 transmit 1, 0.5", [0.1, 0.0], [0.1, 0.5]),
        ("transmit 1, 0.8 transmit 1, 0.3", [0.0, 0.0], [0.0, 0.3]),
    ] {
        let mut host = MemoryHost::new().with_file("codes.bmp", picture_with_a_palette());
        let map = format!("image_map {{ bmp \"codes.bmp\" {items} }}");
        let text = format!("sphere {{ 0, 1 pigment {{ {map} }} }}");
        let parsed = parse_with(&mut host, &text);
        assert!(parsed.scene.is_some(), "{:?}", parsed.diagnostics);
        let scene = parsed.scene.expect("a scene");
        let material = scene.objects.0[0].material.as_ref().unwrap();
        let texture = material.texture.clone().unwrap().0;
        for (x, expected) in [(0.25, left), (0.75, right)] {
            let point = TexturePoint::in_space(DVec3::new(x, 0.5, 0.0));
            let mut paint = strahl_shade::texture::TexturePaint::default();
            texture.layers_at(&point, 1.0, &mut paint);
            let color = paint.layers[0].color;
            let seen = [color.filter, color.transmit];
            let near = (0..2).all(|i| (seen[i] - expected[i]).abs() < 1e-15);
            assert!(near, "{items} at {x}: {seen:?}, not {expected:?}");
        }
    }
}

/// Heights by index are the numbers of entries in the palette, as in POV-Ray 3.7, and the last of `use_index` and `use_color`
/// counts. Pictures without a palette have the heights of their colours.
#[test]
fn bump_maps_use_the_index_in_a_palette() {
    let gray = [9.0 / 255.0; 2];
    for (file, items, expected) in [
        ("codes.bmp", "", gray),
        ("codes.bmp", "use_index", [0.0, 1.0]),
        ("codes.bmp", "use_color use_index bump_size 2", [0.0, 1.0]),
        ("codes.bmp", "use_index use_colour", gray),
        ("grays.pgm", "use_index", [0.2, 0.6]),
    ] {
        let mut host = MemoryHost::new()
            .with_file("codes.bmp", picture_with_a_palette())
            .with_file("grays.pgm", b"P5\n2 1\n255\n\x33\x99".to_vec());
        let kind = &file[file.len() - 3..];
        let map = format!("bump_map {{ {kind} \"{file}\" {items} }}");
        let parsed = parse_with(&mut host, &format!("sphere {{ 0, 1 normal {{ {map} }} }}"));
        assert!(parsed.diagnostics.is_empty(), "{:?}", parsed.diagnostics);
        let scene = parsed.scene.expect("a scene");
        let material = scene.objects.0[0].material.as_ref().unwrap();
        let texture = material.texture.clone().unwrap().0;
        let Texture::Plain(plain) = &*texture else {
            panic!("{texture:?}")
        };
        let Some(NormalKind::BumpMap(image)) = plain.normal.as_ref().map(|normal| &normal.kind)
        else {
            panic!("{plain:?}")
        };
        let heights = [0.25, 0.75].map(|x| image.gray(DVec3::new(x, 0.5, 0.0)));
        let near = (0..2).all(|i| (heights[i] - expected[i]).abs() < 1e-6);
        assert!(near, "{file} {items}: {heights:?}, not {expected:?}");
    }
}

#[test]
fn entries_beyond_the_palette_are_an_error() {
    let mut host = MemoryHost::new().with_file("codes.bmp", picture_with_a_palette());
    let text = "sphere { 0, 1 pigment { image_map { bmp \"codes.bmp\" transmit 2, 0.5 } } }";
    let parsed = parse_with(&mut host, text);
    let error = parsed.diagnostics.iter().find(|d| d.is_error());
    let message = error.expect("an error").to_string();
    assert!(message.contains("2 entries"), "{message}");
}
