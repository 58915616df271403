//! What readers of all formats work with: bytes, texts, other files, and the report on what is wrong.

pub(crate) mod ahead;
pub(crate) mod bytes;
pub(crate) mod kind;
pub(crate) mod report;
pub(crate) mod text;
pub(crate) mod textures;

pub(crate) use bytes::Folder;
pub(crate) use report::{Fallible, Report};

/// What every reader is given.
pub(crate) struct Input<'a> {
    /// The file, decompressed; never empty.
    pub(crate) bytes: &'a [u8],
    /// Its name as shown to the user.
    pub(crate) name: &'a str,
    /// Where other files may be read from.
    pub(crate) folder: Option<&'a Folder>,
}
