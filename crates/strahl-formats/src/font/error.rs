use skrifa::raw::ReadError;

/// Why a font can't be used.
#[derive(Clone, Debug, thiserror::Error)]
#[non_exhaustive]
pub enum FontError {
    /// The file, or a table in it, is not what it should be.
    #[error("{what} is not valid: a TrueType or OpenType font is needed ({error})")]
    Broken {
        /// What is broken.
        what: &'static str,
        /// What the reader says about it.
        error: ReadError,
    },
    /// There are no outlines, or they have no size.
    #[error(
        "the font has no outlines (perhaps its letters are pictures); use a TrueType or OpenType font"
    )]
    NoOutlines,
    /// The outline of a letter is broken.
    #[error("glyph {id} of the font is broken: {message}")]
    Glyph {
        /// Number of the glyph.
        id: u32,
        /// What the reader says about it.
        message: String,
    },
}
