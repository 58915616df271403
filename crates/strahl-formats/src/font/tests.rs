use super::*;

/// A font of three glyphs made by hand: a triangle for missing characters, a diamond with one curved side for `A`, and a space.
pub(crate) fn tiny_font() -> Vec<u8> {
    font_with_kerning(&[[1, 1, -50]])
}

/// The same font with other pairs in its table `kern`, each of two glyphs and a distance.
fn font_with_kerning(pairs: &[[i32; 3]]) -> Vec<u8> {
    let be16 = |list: &[i32]| -> Vec<u8> {
        let bytes = list.iter().flat_map(|v| (*v as i16).to_be_bytes());
        bytes.collect()
    };
    let be32 = |list: &[u32]| -> Vec<u8> { list.iter().flat_map(|v| v.to_be_bytes()).collect() };

    // Contours, box, last point, no instructions; then flags (1: on the curve) and steps.
    let triangle = [
        be16(&[1, 0, 0, 500, 500, 2, 0]),
        vec![1, 1, 1],
        be16(&[0, 500, 0, 0, 0, 500]),
        vec![0],
    ]
    .concat();
    let diamond = [
        be16(&[1, 100, 0, 500, 800, 3, 0]),
        vec![1, 0, 1, 1],
        be16(&[300, 200, -200, -200, 0, 400, 400, -400]),
    ]
    .concat();
    let offsets = [0, triangle.len(), triangle.len() + diamond.len()];
    let loca: Vec<u32> = [offsets[0], offsets[1], offsets[2], offsets[2]]
        .map(|o| o as u32)
        .to_vec();
    let mut head = [be32(&[0x0001_0000, 0, 0, 0x5f0f_3cf5]), be16(&[0, 1000])].concat();
    head.extend(vec![0; 16]);
    head.extend(be16(&[0, 0, 500, 800, 0, 8, 2, 1, 0]));
    let mut hhea = be32(&[0x0001_0000]);
    hhea.extend(be16(&[
        800, -200, 0, 600, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 3,
    ]));
    let mut maxp = be32(&[0x0001_0000]);
    maxp.extend(be16(&[3, 8, 2, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0]));
    let groups = be32(&[40, 0, 2, 32, 32, 2, 65, 65, 1]);
    let cmap = [be16(&[0, 1, 3, 10]), be32(&[12]), be16(&[12, 0]), groups].concat();
    let count = pairs.len() as i32;
    let kern = [
        be16(&[0, 1, 0, 14 + 6 * count, 1, count, 6, 0, 0]),
        be16(&pairs.concat()),
    ]
    .concat();
    let tables: [(&[u8; 4], Vec<u8>); 8] = [
        (b"cmap", cmap),
        (b"glyf", [triangle, diamond].concat()),
        (b"head", head),
        (b"hhea", hhea),
        (b"hmtx", be16(&[500, 0, 600, 100, 250, 0])),
        (b"kern", kern),
        (b"loca", be32(&loca)),
        (b"maxp", maxp),
    ];
    let mut file = [be32(&[0x0001_0000]), be16(&[8, 128, 3, 0])].concat();
    let mut body = vec![];
    let start = 12 + 16 * tables.len();
    for (tag, table) in &tables {
        file.extend_from_slice(*tag);
        file.extend(be32(&[0, (start + body.len()) as u32, table.len() as u32]));
        body.extend_from_slice(table);
        body.resize(body.len().next_multiple_of(4), 0);
    }
    [file, body].concat()
}

#[test]
fn letters_stand_one_after_the_other() {
    let mut font = Font::parse(tiny_font()).unwrap();
    let letters = font.lay_out("AA A?").unwrap();
    let places: Vec<f64> = letters.iter().map(|letter| letter.x).collect();
    let expected = [0.0, 0.55, 1.15, 1.4, 2.0];
    assert!(
        places
            .iter()
            .zip(expected)
            .all(|(a, b)| (a - b).abs() < 1e-12),
        "{places:?}"
    );
    let sizes: Vec<_> = letters
        .iter()
        .map(|letter| letter.outline.as_ref().map(|o| o.piece_count()))
        .collect();
    assert_eq!(sizes, [Some(3), Some(3), None, Some(3), Some(3)]);
}

#[test]
fn all_pairs_of_an_unsorted_kerning_table_count() {
    let pairs = [
        [2, 1, -10],
        [1, 2, -20],
        [1, 1, -50],
        [0, 1, -40],
        [1, 1, 7],
    ];
    let mut font = Font::parse(font_with_kerning(&pairs)).unwrap();
    let letters = font.lay_out("AA A?A").unwrap();
    let places: Vec<f64> = letters.iter().map(|letter| letter.x).collect();
    let expected = [0.0, 0.55, 1.13, 1.37, 1.97, 2.43];
    assert!(
        places
            .iter()
            .zip(expected)
            .all(|(a, b)| (a - b).abs() < 1e-12),
        "{places:?}"
    );
}

#[test]
fn outlines_are_as_drawn_and_shared() {
    let mut font = Font::parse(tiny_font()).unwrap();
    let letters = font.lay_out("AA").unwrap();
    let [a, b] = &letters[..] else {
        panic!("two letters")
    };
    let (a, b) = (a.outline.as_ref().unwrap(), b.outline.as_ref().unwrap());
    assert!(Arc::ptr_eq(a, b));
    let [min, max] = a.bounds();
    assert_eq!((min, max), (DVec2::new(0.1, 0.0), DVec2::new(0.5, 0.8)));
    assert_eq!(a.gaps(), 1, "drawn without its last side");
    assert!(font.lay_out("").unwrap().is_empty());
}

#[test]
fn broken_fonts_are_errors() {
    assert!(matches!(
        Font::parse(b"no font at all".to_vec()),
        Err(FontError::Broken { .. })
    ));
    let whole = tiny_font();
    for length in 0..whole.len() {
        if let Ok(mut font) = Font::parse(whole[..length].to_vec()) {
            let _ = font.lay_out("A b");
        }
    }
    for place in 0..whole.len() {
        for byte in [0, 0x7f, 0xff] {
            let mut bytes = whole.clone();
            bytes[place] = byte;
            if let Ok(mut font) = Font::parse(bytes) {
                let _ = font.lay_out("A b");
            }
        }
    }
}
