//! Errors of picture files, with advice.

use std::io;
use std::path::{Path, PathBuf};

/// Why a picture was not written or a texture not read.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ImageError {
    /// The extension of the file name is not that of a known format.
    #[error("`{}` does not name a picture format: {found}; end it in one of {known}", path.display())]
    UnknownFormat {
        /// The file.
        path: PathBuf,
        /// What its name ends in, in words.
        found: String,
        /// The known extensions.
        known: String,
    },
    /// The picture is empty.
    #[error(
        "a picture of {width} x {height} pixels cannot be written: it needs at least one pixel in each direction"
    )]
    Empty {
        /// Columns of the window.
        width: u32,
        /// Rows of the window.
        height: u32,
    },
    /// The parts of the picture don't fit together.
    #[error("the picture cannot be written: {0}")]
    Invalid(String),
    /// The picture is larger than the format's numbers reach.
    #[error(
        "a picture of {width} x {height} pixels is too large for {format}, which ends at {limit} in each direction; \
         render regions, or write another format"
    )]
    TooLarge {
        /// The format's name.
        format: &'static str,
        /// Columns of the full picture.
        width: u32,
        /// Rows of the full picture.
        height: u32,
        /// The most pixels per direction.
        limit: u32,
    },
    /// The format stores colours only.
    #[error(
        "{format} pictures have no layers (`{layer}` was asked for): write {able}, or no layers"
    )]
    LayersUnsupported {
        /// The format's name.
        format: &'static str,
        /// The first layer.
        layer: String,
        /// Names of the formats that have layers.
        able: String,
    },
    /// The format has no alpha channel.
    #[error("{format} pictures have no alpha channel: write {able}, or no alpha channel")]
    AlphaUnsupported {
        /// The format's name.
        format: &'static str,
        /// Names of the formats that have one.
        able: String,
    },
    /// The folder of the file does not exist.
    #[error("cannot write `{}`: the folder `{}` does not exist; create it first", path.display(), folder.display())]
    FolderMissing {
        /// The file.
        path: PathBuf,
        /// Its folder.
        folder: PathBuf,
    },
    /// The file name belongs to a folder.
    #[error("cannot write `{}`: it is a folder; append a file name", path.display())]
    IsFolder {
        /// The folder.
        path: PathBuf,
    },
    /// File or folder may not be written.
    #[error("cannot write `{}`: {source}; change the permissions or write to another folder", path.display())]
    NotWritable {
        /// The file.
        path: PathBuf,
        /// The system's reason.
        source: io::Error,
    },
    /// No space is left.
    #[error("cannot write `{}`: {source}; free some space or write to another disk (nothing was left behind)", path.display())]
    DiskFull {
        /// The file.
        path: PathBuf,
        /// The system's reason.
        source: io::Error,
    },
    /// Writing failed for another reason.
    #[error("cannot write {target}: {source}")]
    Write {
        /// The file in quotes, or `the picture` for a stream.
        target: String,
        /// The system's or the encoder's reason.
        source: io::Error,
    },
    /// A texture's file can't be read.
    #[error("cannot read the texture `{}`: {source}; check its name and permissions", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// The system's reason.
        source: io::Error,
    },
    /// A texture's bytes are no picture, a damaged one, or one too large to decode.
    #[error(
        "the texture `{name}` cannot be decoded: {reason}; PNG, JPEG, EXR, HDR, TIFF, TGA, BMP, GIF and PNM are read"
    )]
    Decode {
        /// The texture's name.
        name: String,
        /// The decoder's reason.
        reason: String,
    },
    /// A file is no OpenEXR picture that can be read in full.
    #[error("`{}` is not a complete OpenEXR picture: {reason}; write it again", path.display())]
    Exr {
        /// The file.
        path: PathBuf,
        /// The reason.
        reason: String,
    },
    /// There is no memory for a texture.
    #[error(
        "the texture `{name}` has {width} x {height} texels; the {mib} MiB of memory for them are not available; \
         scale it down, or raise the memory limit"
    )]
    TextureMemory {
        /// The texture's name.
        name: String,
        /// Columns.
        width: u64,
        /// Rows.
        height: u64,
        /// Memory needed.
        mib: u64,
    },
    /// A texture has too many texels.
    #[error(
        "the texture `{name}` has {width} x {height} texels, more than the {limit} that are allowed; scale it down"
    )]
    TextureTooLarge {
        /// The texture's name.
        name: String,
        /// Columns.
        width: u64,
        /// Rows.
        height: u64,
        /// The most texels.
        limit: u64,
    },
}

impl ImageError {
    pub(super) fn invalid(reason: String) -> Self {
        Self::Invalid(reason)
    }

    /// Sorts the system's reasons not to write a file by what one can do about them.
    pub(super) fn writing(path: &Path, source: io::Error) -> Self {
        use io::ErrorKind as Kind;
        let path = path.to_owned();
        match source.kind() {
            Kind::PermissionDenied | Kind::ReadOnlyFilesystem | Kind::NotADirectory => {
                Self::NotWritable { path, source }
            }
            Kind::StorageFull | Kind::QuotaExceeded | Kind::FileTooLarge => {
                Self::DiskFull { path, source }
            }
            Kind::IsADirectory => Self::IsFolder { path },
            _ => Self::Write {
                target: format!("`{}`", path.display()),
                source,
            },
        }
    }
}
