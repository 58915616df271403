//! The files of the page, which are part of the program.

use rust_embed::Embed;
#[cfg(feature = "server")]
use rust_embed::EmbeddedFile;

#[derive(Embed)]
#[folder = "assets/"]
struct Assets;

/// A file of the page with its media type.
#[cfg(feature = "server")]
pub(crate) fn file(name: &str) -> Option<(&'static str, EmbeddedFile)> {
    let media_type = match name.rsplit_once('.')?.1 {
        "html" => "text/html; charset=utf-8",
        "js" => "text/javascript; charset=utf-8",
        "css" => "text/css; charset=utf-8",
        "svg" => "image/svg+xml",
        _ => return None,
    };
    Some((media_type, Assets::get(name)?))
}

/// The text of a file of the page; empty if there is none.
pub(crate) fn text(name: &str) -> String {
    let file = Assets::get(name).map(|file| file.data.into_owned());
    String::from_utf8(file.unwrap_or_default()).unwrap_or_default()
}

#[cfg(all(test, feature = "server"))]
mod tests {
    use super::*;

    #[test]
    fn the_page_is_there_and_asks_nothing_of_other_hosts() {
        assert!(file("index.html").is_some() && file("../Cargo.toml").is_none());
        for name in Assets::iter() {
            assert!(file(&name).is_some(), "{name} has no media type");
            let text = text(&name).replace("http://www.w3.org/", "");
            assert!(
                !text.contains("http://") && !text.contains("https://"),
                "{name}"
            );
        }
    }
}
