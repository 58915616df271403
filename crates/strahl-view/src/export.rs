//! Pages that need no server: the ray trees of a pixel, and a whole picture that explains itself.

#[cfg(feature = "server")]
mod picture;

#[cfg(feature = "server")]
pub(crate) use picture::objects_of;
#[cfg(feature = "server")]
pub use picture::{PicturePage, USUAL_TREES};

use crate::assets;
use strahl::Explanation;

/// A page in HTML with the ray trees of a pixel. It has everything in it, and opens from disk. `title` is the name of the scene,
/// `language` is `en` or `de`; any other is English.
pub fn explanation_page(explanation: &Explanation, title: &str, language: &str) -> String {
    let data = serde_json::to_string(explanation).unwrap_or_default();
    page_of_json(&data, explanation.pixel, title, language)
}

/// The same from the JSON of an explanation, and its pixel. Without a title the page has no heading.
pub fn page_of_json(data: &str, pixel: [u32; 2], title: &str, language: &str) -> String {
    let [x, y] = pixel;
    let file = file_name(title);
    document(&Document {
        language,
        heading: file,
        title: format!("{file} {x},{y}").trim_start(),
        class: "leaf",
        styles: &["base.css", "tree.css"],
        modules: &["words.js", "numbers.js", "formula.js", "tree.js", "leaf.js"],
        data,
    })
}

/// The last part of a path: those who get a page need not know where the scene is.
fn file_name(path: &str) -> &str {
    path.rsplit(['/', '\\']).next().unwrap_or(path)
}

/// What a page is made of.
struct Document<'a> {
    language: &'a str,
    heading: &'a str,
    title: &'a str,
    /// The class of its body.
    class: &'a str,
    /// The names of its style sheets and modules, each one after those that it needs.
    styles: &'a [&'a str],
    modules: &'a [&'a str],
    /// JSON for its last module.
    data: &'a str,
}

fn document(of: &Document<'_>) -> String {
    let language = if of.language == "de" { "de" } else { "en" };
    let styles: String = of.styles.iter().map(|name| assets::text(name)).collect();
    let modules = of.modules.iter().map(|name| plain(&assets::text(name)));
    let script: String = modules.collect();
    format!(
        "<!doctype html>\n<html lang=\"{language}\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
         <title>{} · strahl</title>\n<style>\n{styles}</style>\n</head>\n\
         <body class=\"{}\">\n<main id=\"leaf\" data-title=\"{}\"></main>\n\
         <script type=\"application/json\" id=\"data\">{}</script>\n<script>\n\"use strict\";\n(() => {{\n{script}\n}})();\n</script>\n</body>\n</html>\n",
        escaped(of.title),
        of.class,
        escaped(of.heading),
        of.data.replace('<', "\\u003c"),
    )
}

/// A module without what makes it one, so that several can follow each other in a script.
fn plain(module: &str) -> String {
    let mut out = String::new();
    for line in module.lines().filter(|line| !line.starts_with("import ")) {
        out.push_str(line.strip_prefix("export ").unwrap_or(line));
        out.push('\n');
    }
    out
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;")
        .replace('<', "&lt;")
        .replace('"', "&quot;")
}

#[cfg(test)]
mod tests {
    use super::*;
    use strahl::prelude::*;

    #[test]
    fn a_page_has_all_in_it_and_names_cannot_break_it() {
        let scene = crate::testing::ball("</script><b>");
        let session = Session::new(Threads::Count(1)).unwrap();
        let (scene, _) = session.compile(&scene, &CompileOptions::default()).unwrap();
        let pixel = session.explain(&scene.view(9, 9), 4, 4).unwrap();
        let page = explanation_page(&pixel, "a\"<b>.pov", "de");
        assert!(page.contains("lang=\"de\"") && page.contains("a&quot;&lt;b>.pov"));
        assert!(!page.contains("</script><b>") && page.contains("\\u003c/script>"));
        assert_eq!(page.matches("</script>").count(), 2);
        assert!(!page.contains("\nimport ") && !page.contains("\nexport "));
        assert!(!page.contains("src=") && !page.contains("href="));
    }
}
