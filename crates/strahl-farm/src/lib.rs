//! Pictures in tiles and films in frames, for clusters and render farms.
//!
//! A tile is an ordinary OpenEXR file of a part of a picture ([`TileFile`]) that knows what it is a tile of ([`TileInfo`]). [`split`] cuts a
//! picture into tiles of about equal cost, [`merge`] puts tiles together and says what is wrong with them.

mod merge;
mod split;
mod tile;

pub use merge::{Merged, TilesError, merge};
pub use split::{TooManyTiles, split};
pub use tile::{Settings, TileError, TileFile, TileInfo, TilePlace, UnknownTile};
