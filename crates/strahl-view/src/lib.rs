//! The viewer of strahl: a local web server whose page shows a scene's picture while it is rendered, and explains its pixels.
//!
//! [`serve`] answers requests on the loopback interface only, and only those that know its token. The page is made of the files in
//! `assets/`, which are part of the program; it asks nothing of any other host.
//!
//! Without the feature `server` (on by default) there is only [`explanation_page`]: the page of one pixel, which needs no server.
//!
//! ```text
//! browser --WebSocket--> client (one per page) --> scenes   (loaded and compiled once for all pages)
//!                          ^                   --> pictures (rendered once for all pages with the same settings)
//!                          +---- tiles, replies --------+
//! ```

mod assets;
#[cfg(feature = "server")]
mod builtin;
#[cfg(feature = "server")]
mod camera;
#[cfg(feature = "server")]
mod camera_change;
#[cfg(feature = "server")]
mod client;
#[cfg(feature = "server")]
mod colors;
mod export;
#[cfg(feature = "server")]
mod guard;
#[cfg(feature = "server")]
mod hub;
#[cfg(feature = "server")]
mod lights;
#[cfg(feature = "server")]
mod pictures;
#[cfg(feature = "server")]
mod protocol;
#[cfg(feature = "server")]
mod scenes;
#[cfg(feature = "server")]
mod server;
#[cfg(test)]
mod testing;
#[cfg(feature = "server")]
mod texts;
#[cfg(feature = "server")]
mod walk;
#[cfg(feature = "server")]
mod watch;

pub use export::{explanation_page, page_of_json};

#[cfg(feature = "server")]
pub use camera::camera_sdl;
#[cfg(feature = "server")]
pub use export::{PicturePage, USUAL_TREES};
#[cfg(feature = "server")]
pub use hub::Defaults;
#[cfg(feature = "server")]
pub use lights::light_sdl;
#[cfg(feature = "server")]
pub use scenes::{LoadScene, Request};
#[cfg(feature = "server")]
pub use server::{ServeError, Served, ViewOptions, serve};
#[cfg(feature = "server")]
pub use texts::Text;
#[cfg(feature = "server")]
pub use walk::walk_events;
