//! Pictures in tiles and films in frames, for clusters and render farms.
//!
//! A tile is an ordinary OpenEXR file of a part of a picture ([`TileFile`]) that knows what it is a tile of ([`TileInfo`]). [`split`] cuts a
//! picture into tiles of about equal cost, [`merge`] puts tiles together and says what is wrong with them.
//!
//! A [`Job`] is a folder with a scene ([`Bundle`]), a manifest and the tiles so far. The work is done by the scheduler that is there: [`slurm`]
//! and [`openjd`] write what it reads.

mod bundle;
mod job;
mod merge;
pub mod openjd;
pub mod slurm;
mod split;
mod state;
mod tile;

pub use bundle::Bundle;
pub use job::{Care, Job, JobError, JobFrame, Movie, Unit};
pub use merge::{Merged, TilesError, merge, ranges};
pub use split::{TooManyTiles, split};
pub use state::{Progress, SILENCE, State, progress, time_of};
pub use tile::{Settings, TileError, TileFile, TileHead, TileInfo, TilePlace, UnknownTile};

/// Bytes as hexadecimal digits.
fn hex(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
}
