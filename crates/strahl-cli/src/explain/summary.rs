//! The summary of a pixel: its value, its samples, and an outline of the trees.

use super::names::without_folders;
use super::page::Page;
use super::tally::{Counts, Tally, plural};
use super::{Digits, Pixel, Shown};
use strahl::shade::{Color, srgb};
use strahl::tracing::{PixelSample, RayNode, RayTree, RenderScene, Sampling};

/// The largest number of samples listed.
const MOST_SAMPLES: usize = 64;
/// The largest number of levels that the outline draws.
const MOST_LEVELS: usize = 12;

/// Writes the value of the pixel and the number of rays.
pub(super) fn write_pixel(page: &mut Page, pixel: &Pixel<'_>, digits: Digits) {
    let (x, y) = pixel.at;
    let (width, height) = pixel.size;
    let [r, g, b] = pixel.codes();
    let tree = pixel.tree;
    page.line(
        0,
        &format!(
            "pixel {x},{y} of {width}x{height}: ({r}, {g}, {b}) in 8 bits, linear colour {}",
            digits.color(tree.color)
        ),
    );
    let counts = tree
        .samples
        .iter()
        .map(|s| Counts::of(&s.tree))
        .fold(Counts::default(), Counts::plus);
    let places = tree.places;
    let (number, rays) = match tree.samples.first().and_then(|sample| sample.ray) {
        None => (places, String::new()),
        Some(_) => {
            let rays = u32::try_from(tree.samples.len()).unwrap_or(u32::MAX);
            let words = format!(
                ", {rays} {} through the lens for {places} {}",
                plural(rays, "ray", "rays"),
                plural(places, "place", "places")
            );
            (rays, words)
        }
    };
    page.line(
        0,
        &format!(
            "{number} {} ({}{rays}): {}",
            plural(number, "sample", "samples"),
            pixel.sampling,
            counts.words()
        ),
    );
}

impl Pixel<'_> {
    /// The 8-bit codes of the value.
    pub(crate) fn codes(&self) -> [u8; 3] {
        self.tree.film.map(srgb::encode_u8)
    }
}

/// How much a sample counts in the mean of the pixel, if not all count alike.
pub(super) fn counted(sample: &PixelSample, pixel: &Pixel<'_>) -> String {
    const CORNERS: u32 = 4;
    match (pixel.sampling, sample.times) {
        (Sampling::Recursive(_), _) if pixel.tree.places > CORNERS => {
            format!(", counts {}", fraction(sample.share))
        }
        (_, 1) => String::new(),
        (_, times) => format!(", counts {times} times"),
    }
}

/// A number as a fraction with a power of two below the line, which shares of squares are.
fn fraction(share: f64) -> String {
    let (mut above, mut below) = (share, 1.0);
    while above.fract() != 0.0 && below < 2f64.powi(60) {
        above *= 2.0;
        below *= 2.0;
    }
    format!("{above}/{below}")
}

/// Writes a line for each sample.
pub(super) fn write_samples(
    page: &mut Page,
    scene: &RenderScene,
    pixel: &Pixel<'_>,
    shown: &Shown,
) {
    let (samples, digits) = (&pixel.tree.samples, shown.digits);
    page.gap();
    page.row(&format!(
        "{:>6}  {:<18}  {:>4}  {:<32}  first hit",
        "sample", "at", "rays", "linear colour"
    ));
    for (number, sample) in samples.iter().enumerate().take(MOST_SAMPLES) {
        let (x, y) = sample.place;
        let at = format!("({}, {})", digits.number(x), digits.number(y));
        let first = sample.tree.nodes.first();
        let line = format!(
            "{:>6}  {at:<18}  {:>4}  {:<32}  {}{}",
            number + 1,
            Counts::of(&sample.tree).rays(),
            digits.color(sample.color),
            first.map_or_else(String::new, |node| seen(scene, node)),
            counted(sample, pixel)
        );
        page.row(&line);
    }
    if samples.len() > MOST_SAMPLES {
        page.line(0, &format!("   and {} more", samples.len() - MOST_SAMPLES));
    }
    if shown.sample.is_some() {
        // The trees follow.
        return;
    }
    page.gap();
    let one = match pixel.sampling {
        // There are several because of the camera.
        Sampling::Center => "",
        _ => ", `--sampling center` looks at one place only",
    };
    page.line(
        0,
        &format!(
            "`--sample N` shows the ray tree of one of them, `--sample all` those of all{one}."
        ),
    );
}

/// Writes the outline of the tree, with a line for each ray that is shown.
pub(super) fn write_outline(
    page: &mut Page,
    scene: &RenderScene,
    tree: &RayTree,
    tally: &Tally,
    shown: &[bool],
) {
    let mut rows = Vec::new();
    // Depth first with a stack of rays and the lines drawn in front of them.
    let mut waiting: Vec<(u32, String, String)> = match tree.nodes.is_empty() {
        true => vec![],
        false => vec![(0, String::new(), String::new())],
    };
    while let Some((index, before, below)) = waiting.pop() {
        let Some(node) = tree.nodes.get(index as usize) else {
            continue;
        };
        let ray = format!("{before}#{index} {}", node.report.kind);
        let adds = tally.adds.get(index as usize).copied().flatten();
        rows.push((ray, seen(scene, node), adds));
        let is_shown = |child: &u32| shown.get(*child as usize) == Some(&true);
        let children: Vec<u32> = node.children.iter().copied().filter(is_shown).collect();
        let deep = node.report.depth as usize > MOST_LEVELS;
        for (place, child) in children.iter().enumerate().rev() {
            let last = place + 1 == children.len();
            let (branch, stem) = match (deep, last) {
                (true, _) => ("", ""),
                (false, true) => ("└ ", "  "),
                (false, false) => ("├ ", "│ "),
            };
            waiting.push((*child, format!("{below}{branch}"), format!("{below}{stem}")));
        }
    }
    let width = |text: &String| text.chars().count();
    let widest_ray = rows.iter().map(|(ray, ..)| width(ray)).max().unwrap_or(0);
    let widest_ray = widest_ray.max(3);
    let widest_hit = rows.iter().map(|(_, hit, _)| width(hit)).max().unwrap_or(0);
    let widest_hit = widest_hit.clamp(4, 44);
    page.row(&format!(
        "{:<widest_ray$}  {:<widest_hit$}  adds to the sample",
        "ray", "sees"
    ));
    for (ray, hit, adds) in rows {
        let adds = adds.map_or_else(|| "(with the ray above)".to_owned(), fixed);
        page.row(&format!("{ray:<widest_ray$}  {hit:<widest_hit$}  {adds}"));
    }
    let hidden = shown.iter().filter(|s| !**s).count();
    if hidden > 0 {
        let mut rest = Color::BLACK;
        for (adds, shown) in tally.adds.iter().zip(shown) {
            if let (Some(adds), false) = (adds, shown) {
                rest += *adds;
            }
        }
        page.line(
            0,
            &format!(
                "and {hidden} more rays that add {} together; `--rays all` shows them",
                fixed(rest)
            ),
        );
    }
}

/// The object a ray hits, in short.
fn seen(scene: &RenderScene, node: &RayNode) -> String {
    match &node.report.hit {
        None => "background".to_owned(),
        Some(hit) => {
            let name = scene.object_name(hit.object);
            match scene.object_place(hit.object, hit.line) {
                Some(place) => format!("{name} {}", without_folders(&place)),
                None => name,
            }
        }
    }
}

/// A colour with fixed columns.
fn fixed(c: Color) -> String {
    format!("({:.5}, {:.5}, {:.5})", c.r, c.g, c.b)
}
