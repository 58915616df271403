use super::{Document, document, file_name};
use crate::pictures::encoded;
use crate::texts::Text;
use base64::prelude::{BASE64_STANDARD, Engine as _};
use serde_json::{Value, json};
use std::collections::BTreeSet;
use strahl::formats::image::ImageFormat;
use strahl::prelude::*;

/// How many pixels of a picture have their trees in a page, if nobody says it.
pub const USUAL_TREES: usize = 150;
/// The most bytes of trees in a page, as JSON.
const MOST_BYTES: usize = 16 << 20;
/// The most bytes of a picture in a page, as PNG.
const LARGEST_PICTURE: usize = 24 << 20;

/// A picture as a page in HTML that has everything in it: every pixel has its object and the line of the scene, and some pixels have their ray
/// trees.
#[derive(Debug)]
pub struct PicturePage<'a> {
    /// The name of the scene.
    pub title: &'a str,
    /// `en` or `de`; any other is English.
    pub language: &'a str,
    /// The scene's texts with the names that places have.
    pub texts: &'a [(String, Text)],
    /// Pixels whose trees shall be in the page, in any case.
    pub chosen: &'a [[u32; 2]],
    /// The number of pixels that have their trees, besides the chosen ones: one in the middle of each object that is seen, those with the largest
    /// part of the picture first, and then a grid of points. Those whose trees don't fit into 16 MiB are left out.
    pub trees: usize,
}

impl PicturePage<'_> {
    /// Writes the page. The pixels are those of a finished picture of the view, row by row.
    ///
    /// # Errors
    /// The picture is too large for a page, or can't be rendered.
    pub fn write(
        &self,
        session: &Session,
        view: &View,
        pixels: &[[f32; 3]],
    ) -> Result<String, String> {
        let (width, height) = (view.width, view.height);
        let png = encoded(ImageFormat::Png, width, height, pixels).map_err(|e| e.to_string())?;
        if png.len() > LARGEST_PICTURE {
            return Err("the picture is too large for a page: choose a smaller --size".into());
        }
        let seen = objects_of(session, view)?;
        let middles = middles(&seen, width);
        let trees = trees(session, view, &self.places(&middles, width, height))?;
        let texts = self.texts.iter();
        let files = texts.map(|(name, text)| json!({ "name": name, "text": text }));
        let head = json!({
            "width": width,
            "height": height,
            "png": format!("data:image/png;base64,{}", BASE64_STANDARD.encode(&png)),
            "objects": objects(view.scene(), &middles),
            "runs": runs(&seen),
            "files": files.collect::<Vec<_>>(),
        });
        let mut data = head.to_string();
        // The trees are JSON already.
        data.pop();
        data.push_str(&format!(",\"trees\":[{}]}}", trees.join(",")));
        Ok(document(&Document {
            language: self.language,
            heading: file_name(self.title),
            title: file_name(self.title),
            class: "leaf picture",
            styles: &["base.css", "lines.css", "tree.css", "leaf.css"],
            modules: &[
                "words.js",
                "numbers.js",
                "formula.js",
                "tree.js",
                "lines.js",
                "leaf-picture.js",
            ],
            data: &data,
        }))
    }
    /// The pixels whose trees are in the page: the chosen ones, those in the middles of objects, and a grid.
    fn places(&self, middles: &[(u32, [u32; 2])], width: u32, height: u32) -> Vec<[u32; 2]> {
        let mut places = vec![];
        let mut known = BTreeSet::new();
        let inside = |[x, y]: &[u32; 2]| *x < width && *y < height;
        for at in self.chosen.iter().copied().filter(inside) {
            if known.insert(at) {
                places.push(at);
            }
        }
        let most = places.len() + self.trees;
        let of_objects = middles.iter().map(|(_, at)| *at);
        let some = of_objects.take(self.trees.div_ceil(2));
        for at in some.chain(grid(width, height, self.trees)) {
            if places.len() < most && known.insert(at) {
                places.push(at);
            }
        }
        places
    }
}

/// The trees of pixels as JSON, without those that don't fit any more.
fn trees(session: &Session, view: &View, places: &[[u32; 2]]) -> Result<Vec<String>, String> {
    let mut left = MOST_BYTES;
    let mut trees = vec![];
    for &[x, y] in places {
        let tree = session.explain(view, x, y).map_err(|e| e.to_string())?;
        let tree = serde_json::to_string(&tree).map_err(|e| e.to_string())?;
        if tree.len() <= left {
            left -= tree.len();
            trees.push(tree);
        }
    }
    Ok(trees)
}

/// The names and places of the objects that are seen, by their numbers.
fn objects(scene: &RenderScene, middles: &[(u32, [u32; 2])]) -> serde_json::Map<String, Value> {
    let told = middles.iter().map(|&(object, _)| {
        let info = scene.objects().get(object);
        let place = info.and_then(|info| scene.sources().locate(info.span));
        let told = json!({
            "name": scene.object_name(object),
            "file": place.as_ref().map(|place| place.file),
            "line": place.as_ref().map(|place| place.span.line),
        });
        (object.to_string(), told)
    });
    told.collect()
}

/// What the pixels of a view show: the number of the object plus one, 0 for the background.
pub(crate) fn objects_of(session: &Session, view: &View) -> Result<Vec<u32>, String> {
    let view = view.clone().with_sampling(Sampling::Center).with_depth(1);
    let output = Output {
        info: true,
        ..Output::default()
    };
    let picture = session.picture(&view, &output).map_err(|e| e.to_string())?;
    let info = picture.film.info.unwrap_or_default();
    Ok(info.iter().map(|info| info.object).collect())
}

/// For each object that is seen, the pixel of it that is nearest to the middle of all its pixels; the objects with most pixels first.
fn middles(seen: &[u32], width: u32) -> Vec<(u32, [u32; 2])> {
    let place = |index: usize| {
        let index = index as u64;
        let width = u64::from(width.max(1));
        [(index % width) as u32, (index / width) as u32]
    };
    // By object: the number of pixels, and the sums of their columns and rows.
    let mut sums = std::collections::BTreeMap::<u32, (u64, [u64; 2])>::new();
    for (index, &object) in seen.iter().enumerate().filter(|(_, object)| **object > 0) {
        let [x, y] = place(index);
        let sum = sums.entry(object).or_default();
        sum.0 += 1;
        sum.1 = [sum.1[0] + u64::from(x), sum.1[1] + u64::from(y)];
    }
    let mut best = std::collections::BTreeMap::<u32, (u64, [u32; 2])>::new();
    for (index, object) in seen.iter().enumerate() {
        let Some((count, sum)) = sums.get(object) else {
            continue;
        };
        let at = place(index);
        let away = |axis: usize| (sum[axis] / count).abs_diff(u64::from(at[axis]));
        let distance = away(0) * away(0) + away(1) * away(1);
        let known = best.entry(*object).or_insert((u64::MAX, at));
        if distance < known.0 {
            *known = (distance, at);
        }
    }
    let mut all: Vec<(u32, [u32; 2])> = best
        .into_iter()
        .map(|(object, (_, at))| (object, at))
        .collect();
    all.sort_by_key(|(object, _)| (std::cmp::Reverse(sums.get(object).map(|s| s.0)), *object));
    // Numbers of objects from now on.
    all.into_iter()
        .map(|(object, at)| (object - 1, at))
        .collect()
}

/// About so many pixels in a regular grid.
fn grid(width: u32, height: u32, count: usize) -> impl Iterator<Item = [u32; 2]> {
    let count = count.max(1) as f64;
    let step = (f64::from(width) * f64::from(height) / count).sqrt();
    // The shorter side first: of a strip it has a single row.
    let short = f64::from(width.min(height));
    let few = (short / step).round().clamp(1.0, short.max(1.0));
    let many = (count / few).round().max(1.0);
    let (columns, rows) = match width < height {
        true => (few, many),
        false => (many, few),
    };
    let columns = (columns as u32).clamp(1, width.max(1));
    let rows = (rows as u32).clamp(1, height.max(1));
    let middle = |index: u32, of: u32, length: u32| {
        ((2 * u64::from(index) + 1) * u64::from(length) / (2 * u64::from(of))) as u32
    };
    let all = (0..rows).flat_map(move |row| (0..columns).map(move |column| (column, row)));
    all.map(move |(column, row)| [middle(column, columns, width), middle(row, rows, height)])
}

/// Equal neighbours together: how many, and which object, one after the other.
fn runs(seen: &[u32]) -> Vec<u32> {
    let parts = seen.chunk_by(|a, b| a == b);
    parts
        .flat_map(|part| [part.len() as u32, part[0]])
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_object_that_is_seen_has_a_pixel_of_its_own() {
        // Object 1 is around object 0.
        #[rustfmt::skip]
        let seen = [
            2, 2, 2, 0,
            2, 1, 2, 0,
            2, 2, 2, 3,
        ];
        let middles = middles(&seen, 4);
        assert_eq!(middles.len(), 3);
        assert_eq!(middles[0].0, 1, "the largest comes first");
        assert!(middles.contains(&(0, [1, 1])) && middles.contains(&(2, [3, 2])));
        for (object, [x, y]) in middles {
            assert_eq!(seen[(4 * y + x) as usize], object + 1);
        }
        assert_eq!(runs(&seen[..8]), [3, 2, 1, 0, 1, 2, 1, 1, 1, 2, 1, 0]);
    }

    #[test]
    fn a_grid_has_about_as_many_points_as_asked_for() {
        for (width, height, count) in [
            (800, 600, 100),
            (64, 48, 10),
            (1, 1, 50),
            (3000, 2, 20),
            (2, 3000, 20),
        ] {
            let all: BTreeSet<[u32; 2]> = grid(width, height, count).collect();
            assert!(all.iter().all(|[x, y]| *x < width && *y < height));
            let least = count.min((width * height) as usize) / 2;
            assert!((least..=2 * count).contains(&all.len()), "{}", all.len());
        }
    }

    #[test]
    fn a_page_has_the_picture_its_objects_and_the_trees_of_the_chosen_pixels() {
        let scene = crate::testing::ball("</script><b>");
        let session = Session::new(Threads::Count(1)).unwrap();
        let (scene, _) = session.compile(&scene, &CompileOptions::default()).unwrap();
        let view = scene.view(40, 30);
        let film = session.picture(&view, &Output::default()).unwrap().film;
        let texts = [("a.pov".to_owned(), Text::new("sphere".into(), true))];
        let page = |trees| PicturePage {
            title: "a.pov",
            language: "en",
            texts: &texts,
            chosen: &[[3, 4], [3, 4], [90, 90]],
            trees,
        };
        let html = page(10).write(&session, &view, &film.pixels).unwrap();
        let start = html.find("id=\"data\">").unwrap() + 10;
        let data = &html[start..start + html[start..].find("</script>").unwrap()];
        let data: Value = serde_json::from_str(data).unwrap();
        let trees = data["trees"].as_array().unwrap();
        assert_eq!(trees[0]["pixel"], json!([3, 4]));
        assert!((8..=11).contains(&trees.len()), "{}", trees.len());
        assert!(
            trees
                .iter()
                .any(|t| !t["samples"][0]["rays"][0]["hit"].is_null())
        );
        let runs = data["runs"].as_array().unwrap();
        let counts = runs.iter().step_by(2).map(|n| n.as_u64().unwrap());
        assert_eq!(counts.sum::<u64>(), 40 * 30);
        assert!(
            data["objects"]["0"]["name"]
                .as_str()
                .unwrap()
                .contains("</script>")
        );
        assert!(!html.contains("</script><b>") && !html.contains("\nimport "));
        assert!(!html.contains("src=") && !html.contains("href="));
        let none = page(0).write(&session, &view, &film.pixels).unwrap();
        assert!(none.len() < html.len() && none.contains("\"pixel\":[3,4]"));
    }
}
