//! Sheets of plates: pictures with many names of the include library, one look per plate. `cargo xtask looks` compares them with
//! POV-Ray's, a test compares them with the numbers measured then.

/// All names of the library, with file and kind.
const NAMES: &str = include_str!("../../include/names.tsv");

/// The files that declare looks, in the order of the tables.
pub(crate) const FILES: [&str; 13] = [
    "colors.inc",
    "textures.inc",
    "stones1.inc",
    "stones2.inc",
    "woods.inc",
    "woodmaps.inc",
    "metals.inc",
    "golds.inc",
    "glass.inc",
    "glass_old.inc",
    "skies.inc",
    "stars.inc",
    "finish.inc",
];

/// Names that the manual documents but POV-Ray's own files don't declare, so that there is nothing to compare with.
const OURS_ONLY: [&str; 5] = [
    "NBglass_finish",
    "M_NBglass",
    "M_NBoldglass",
    "M_NBwinebottle",
    "M_NBbeerbottle",
];

/// Plates in a row of a sheet.
const COLUMNS: usize = 8;
/// The largest number of plates on a sheet.
const MOST: usize = 40;

/// A name that has a look.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Name {
    pub(crate) name: &'static str,
    pub(crate) file: &'static str,
    pub(crate) kind: &'static str,
}

/// A scene that shows several names of one kind, row by row from the upper left.
#[derive(Debug)]
pub(crate) struct Sheet {
    pub(crate) names: Vec<Name>,
    pub(crate) columns: usize,
    pub(crate) rows: usize,
    pub(crate) text: String,
}

/// All lines of the list: names with their files and kinds.
pub(crate) fn all() -> impl Iterator<Item = Name> {
    NAMES.lines().skip(1).filter_map(|line| {
        let mut words = line.split('\t');
        Some(Name {
            name: words.next()?,
            file: words.next()?,
            kind: words.next()?,
        })
    })
}

/// The names with a look.
pub(crate) fn names() -> Vec<Name> {
    let mut found: Vec<Name> = all()
        .filter(|n| FILES.contains(&n.file) && plate(n).is_some())
        .filter(|n| !OURS_ONLY.contains(&n.name))
        .collect();
    found.sort_by_key(|n| FILES.iter().position(|f| *f == n.file));
    found
}

/// Sheets for the names; the names of a sheet have the same file and kind.
pub(crate) fn sheets(names: &[Name]) -> Vec<Sheet> {
    let mut sheets: Vec<Sheet> = vec![];
    for name in names {
        let alone = is_sky(name);
        let fits = |s: &Sheet| {
            s.names.len() < MOST
                && s.names
                    .iter()
                    .all(|n| (n.file, n.kind) == (name.file, name.kind))
        };
        match sheets.last_mut() {
            Some(last) if !alone && fits(last) => last.names.push(*name),
            _ => sheets.push(Sheet {
                names: vec![*name],
                columns: 1,
                rows: 1,
                text: String::new(),
            }),
        }
    }
    for sheet in &mut sheets {
        sheet.columns = sheet.names.len().min(COLUMNS);
        sheet.rows = sheet.names.len().div_ceil(COLUMNS);
        sheet.text = scene(sheet);
    }
    sheets
}

/// Skies are seen from inside.
fn is_sky(name: &Name) -> bool {
    name.kind == "sky_sphere" || name.file == "skies.inc" && name.kind == "object"
}

fn scene(sheet: &Sheet) -> String {
    let file = sheet.names.first().map_or("colors.inc", |n| n.file);
    let head = format!(
        "#version 3.7;\nglobal_settings {{ assumed_gamma 1 }}\n#include \"colors.inc\"\n#include \"{file}\"\n"
    );
    if let [name] = sheet.names.as_slice()
        && is_sky(name)
    {
        let Name { name, kind, .. } = name;
        let sky = match *kind {
            "object" => format!("object {{ {name} }} background {{ rgb <0.2, 0.4, 0.8> }}"),
            _ => format!("sky_sphere {{ {name} }}"),
        };
        return format!(
            "{head}camera {{ location <0, 1, 0> right 4/3*x angle 90 look_at <0, 1.5, 1> }}\n{sky}\n"
        );
    }
    let (w, h) = (4 * sheet.columns, 3 * sheet.rows);
    let (x, y) = (w as f64 / 2.0, h as f64 / 2.0);
    let mut text = format!(
        "{head}camera {{ orthographic location <{x}, {y}, -50> look_at <{x}, {y}, 0> right {w}*x up {h}*y }}
light_source {{ <-300, 400, -600>, rgb 1 }}
sky_sphere {{ pigment {{ gradient y color_map {{ [0 rgb <0.8, 0.75, 0.7>] [1 rgb <0.2, 0.4, 0.8>] }} }} }}
plane {{ -z, -2 pigment {{ checker rgb 0.7 rgb 0.3 }} }}\n"
    );
    for (i, name) in sheet.names.iter().enumerate() {
        let (column, row) = (i % sheet.columns, i / sheet.columns);
        let (x, y) = (4 * column + 2, h as f64 - 3.0 * row as f64 - 1.5);
        let plate = plate(name).unwrap_or_default();
        text += &format!("{plate} no_reflection translate <{x}, {y}, 0> }}\n");
    }
    text
}

/// A ball in front of a tilted board, both with the same material.
fn ball_and_board(material: &str) -> String {
    format!(
        "union {{ box {{ <-1.9, -1.4, 0.3>, <1.9, 1.4, 0.5> rotate <-14, 10, 0> }} sphere {{ <-0.4, 0.2, -1.2>, 0.95 }} hollow {material}"
    )
}

/// The object that shows a name in an area from (-2, -1.5) to (2, 1.5), without its closing brace; `None` for names without a
/// look.
fn plate(name: &Name) -> Option<String> {
    let Name { name, file, kind } = name;
    let board = "box { <-1.9, -1.4, 0>, <1.9, 1.4, 0.1> hollow";
    Some(match *kind {
        "texture" => ball_and_board(&format!("texture {{ {name} }}")),
        "pigment" => ball_and_board(&format!("pigment {{ {name} }}")),
        "finish" => ball_and_board(&format!(
            "pigment {{ rgb <0.8, 0.5, 0.3> }} finish {{ {name} }}"
        )),
        "material" => format!("sphere {{ 0, 1.3 material {{ {name} }}"),
        "interior" => format!(
            "sphere {{ 0, 1.3 pigment {{ rgbf <0.9, 0.95, 1, 0.9> }} finish {{ ambient 0 diffuse 0 }} interior {{ {name} }}"
        ),
        "color" | "vector" => {
            format!("{board} pigment {{ color {name} }} finish {{ ambient 1 diffuse 0 }}")
        }
        "color_map" => format!(
            "{board} pigment {{ gradient x color_map {{ {name} }} scale 3.8 translate -1.9*x }} finish {{ ambient 1 diffuse 0 }}"
        ),
        "sky_sphere" => String::new(),
        "object" if *file == "skies.inc" => String::new(),
        _ => return None,
    })
}
