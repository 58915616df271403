//! The viewer of strahl: a local web server whose page shows a scene's picture while it is rendered, and explains its pixels.
//!
//! [`serve`] answers requests on the loopback interface only, and only those that know its token. The page is made of the files in
//! `assets/`, which are part of the program; it asks nothing of any other host.
//!
//! ```text
//! browser --WebSocket--> client (one per page) --> scenes   (loaded and compiled once for all pages)
//!                          ^                   --> pictures (rendered once for all pages with the same settings)
//!                          +---- tiles, replies --------+
//! ```

mod assets;
mod builtin;
mod camera;
mod camera_change;
mod client;
mod colors;
mod export;
mod guard;
mod pictures;
mod protocol;
mod scenes;
mod server;
mod texts;
mod walk;
mod watch;

pub use builtin::Builtin;
pub use camera::camera_sdl;
pub use export::explanation_page;
pub use scenes::{LoadScene, Request};
pub use server::{Defaults, ServeError, Served, ViewOptions, serve};
pub use walk::walk_events;
