//! A page with a pixel's ray trees that needs no server.

use crate::assets;
use strahl::Explanation;

/// A page in HTML with the ray trees of a pixel. It has everything in it, and opens from disk. `title` is the name of the scene,
/// `language` is `en` or `de`; any other is English.
pub fn explanation_page(explanation: &Explanation, title: &str, language: &str) -> String {
    let language = if language == "de" { "de" } else { "en" };
    let data = serde_json::to_string(explanation).unwrap_or_default();
    let modules = ["words.js", "numbers.js", "formula.js", "tree.js", "leaf.js"];
    let script: String = modules
        .iter()
        .map(|name| plain(&assets::text(name)))
        .collect();
    let [x, y] = explanation.pixel;
    format!(
        "<!doctype html>\n<html lang=\"{language}\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
         <title>{} {x},{y} · strahl</title>\n<style>\n{}{}</style>\n</head>\n\
         <body class=\"leaf\">\n<main id=\"leaf\" data-title=\"{}\"></main>\n\
         <script type=\"application/json\" id=\"explanation\">{}</script>\n<script>\n\"use strict\";\n(() => {{\n{script}\n}})();\n</script>\n</body>\n</html>\n",
        escaped(title),
        assets::text("base.css"),
        assets::text("tree.css"),
        escaped(title),
        data.replace('<', "\\u003c"),
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
        let scene = Scene::new()
            .add(Sphere::new(DVec3::ZERO, 1.0).named("</script><b>"))
            .light(Light::point(DVec3::new(4.0, 8.0, 6.0), Color::WHITE))
            .camera(Camera::perspective(
                DVec3::Z * 7.0,
                DVec3::ZERO,
                DVec3::Y,
                0.7,
            ));
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
