//! Parser for POV-Ray's scene description language, which produces strahl's scene description.
//!
//! ```
//! use strahl_sdl::{MemoryHost, Options, Source, parse};
//!
//! let text = "
//!     #version 3.7;
//!     #macro Ball(X) sphere { <X, 0, 5>, 0.4 pigment { rgb <1, X / 4, 0> } } #end
//!     #for (I, -2, 2) Ball(I) #end
//! ";
//! let parsed = parse(Source::new("balls.pov", text), &Options::default(), &mut MemoryHost::new());
//! let scene = parsed.scene.expect("no errors");
//! assert_eq!(scene.objects.0.len(), 5);
//! ```
//!
//! # Design
//!
//! **Tokens once, replayed as slices.** `lexer` splits each file into tokens of 16 bytes and links the directives of every block,
//! so that a branch not taken is skipped in one step. A macro is a slice of those tokens. A loop is a position to jump back to.
//! `parser` keeps a stack of frames (scene, includes, macro calls), each a position in a file; none of this uses recursion, and
//! no token is copied.
//!
//! **One stream.** The grammar pulls tokens with [`Parser::peek`], [`Parser::next`], [`Parser::expect`] and doesn't know where
//! they come from: directives (`directives/`) and macro calls are run in between. What a directive or an argument reads ends
//! where its block or frame ends, so `#declare A = 1 #end` means what it looks like.
//!
//! **Names** are numbers; each has a stack of bindings (`parser/scope.rs`), because the language's scopes are dynamic: a
//! macro sees the local names of its caller. A macro's argument that is a lone variable stands for the variable itself.
//!
//! **Expressions** (`expr/`) are evaluated directly from the tokens, with numbers and vectors on the stack.
//!
//! **The grammar** (`grammar/`) is tables from words to functions, one file per object; [`Thing`] lists what can be declared.
//!
//! **Errors** are reported where they happen, with the source line and the macros and includes around it; the statement is
//! abandoned ([`Failed`]) and parsing continues after it. [`Limits`] bound every resource a scene may use. Files are read and
//! written only through a [`Host`].

mod directives;
mod expr;
mod grammar;
mod highlight;
mod include;
mod keywords;
mod lexer;
mod options;
mod parser;
mod source;
mod suggest;
mod symbol;
mod token;
mod value;

pub use expr::{Array, Dictionary, PigmentFunction, Spline, SplineKind};
pub use grammar::{
    Declared, Entity, GlobalSettings, State, Texture, Thing, inside, object_words, pattern_words,
};
pub use highlight::{Piece, highlight};
pub use include::built_in;
pub use keywords::{Word, WordKind};
pub use options::{Frame, Limits, Options};
pub use parser::{Failed, Macro, PResult, Parser, Place};
pub use source::{
    FolderHost, Host, HostError, Lookup, MemoryHost, Pinned, Read, Record, Recorder, Source,
    Stream, Texts, Writing, present,
};
pub use symbol::Symbol;
pub use token::{Kind, Token};
pub use value::{Value, Vector};

use strahl_scene::{Diagnostic, Scene};

/// The result of parsing a text.
#[derive(Debug)]
pub struct Parsed {
    /// The scene; `None` if there was an error.
    pub scene: Option<Scene>,
    /// All diagnostics, in the order found.
    pub diagnostics: Vec<Diagnostic>,
}

/// Parses a scene.
///
/// Never panics and always ends, whatever the text: [`Options::limits`](Options) bound the resources it may use.
pub fn parse(source: Source, options: &Options, host: &mut dyn Host) -> Parsed {
    let name = source.name.clone();
    let source = match source.narrowed() {
        Ok(source) => source,
        Err(error) => {
            return Parsed {
                scene: None,
                diagnostics: vec![Diagnostic::error(format!("`{name}`: {error}"))],
            };
        }
    };
    if source.length() >= u32::MAX as usize {
        let message = format!(
            "`{}` is too large: a file may have at most 4 GiB",
            source.name
        );
        return Parsed {
            scene: None,
            diagnostics: vec![Diagnostic::error(message).hint("split the file by `#include`")],
        };
    }
    let mut parser = Parser::new(source, options, host);
    parser.declare_given();
    parser.include_header();
    parser.run();
    parser.into_parsed()
}
