//! The token stream: files, includes, macros and loops look like one sequence of tokens.
//!
//! [`Parser::peek`] and [`Parser::next`] return the tokens that are left after running all directives. A frame is a position in
//! the tokens of a file; including a file or calling a macro pushes one, a loop moves the position back. None of this uses
//! recursion.

mod blocks;
mod call;
mod expect;
mod finish;
mod frames;
mod messages;
mod recover;
mod report;
mod scope;

pub(crate) use blocks::{Block, BlockKind, Loop};
use call::Argument;
pub use call::Macro;
pub(crate) use call::Parameter;
pub(crate) use frames::{Data, Entry, has_ending};
pub use report::{Failed, PResult};
pub(crate) use scope::{Notice, Scopes, Step, Target};

use crate::directives::Files;
use crate::expr::Members;
use crate::grammar::State;
use crate::options::Options;
use crate::source::{Chunk, Host};
use crate::symbol::{Symbol, Symbols};
use crate::token::{Kind, Token};
use frames::Frame;
use std::collections::BTreeSet;
use std::sync::Arc;
use strahl_function::Workspace;
use strahl_scene::{Diagnostic, Scene, Span};

/// A place in the text that takes little memory; [`Parser::span_at`] makes a span of it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Place {
    file: u32,
    start: u32,
}

/// Where directives must stop reading: the end of the current frame and block, unless a brace is open that they opened.
#[derive(Clone, Copy, Debug, Default)]
struct Floor {
    frames: usize,
    blocks: usize,
    braces: usize,
}

/// The state of parsing one scene.
pub struct Parser<'h> {
    /// The inputs besides the text.
    pub(crate) options: &'h Options,
    /// Access to files, time and output.
    pub(crate) host: &'h mut dyn Host,
    pub(crate) symbols: Symbols,
    pub(crate) scopes: Scopes,
    /// The scene so far.
    pub scene: Scene,
    /// State that the grammar keeps between statements: defaults, global settings, ...
    pub state: State,
    /// The language version in force, such as 3.7.
    pub version: f64,
    /// Random streams: the state of each.
    pub(crate) random: Vec<u32>,
    /// Files opened by the scene.
    pub(crate) io: Files,
    /// Memory for evaluating functions.
    pub(crate) workspace: Workspace,
    /// Bytes of all strings so far.
    pub(crate) all_strings: u64,
    /// Elements of all arrays so far.
    pub(crate) array_elements: u64,
    /// The first chunk of each file.
    sources: Vec<Arc<Chunk>>,
    /// The chunk being read.
    file: Arc<Chunk>,
    position: usize,
    frames: Vec<Frame>,
    blocks: Vec<Block>,
    floor: Floor,
    /// The number of open braces.
    open_braces: usize,
    /// Memory for the arguments of the next call.
    arguments: Vec<Argument>,
    /// Whether the next `{` is already taken, because a function looked at the token after it.
    brace_taken: bool,
    /// The nesting depth of braces and parentheses at the value of the current declaration: at that depth, directives and macro
    /// calls after a complete value belong to what follows.
    value_nesting: Option<usize>,
    /// Whether the next directive or macro call at that depth ends the value.
    stopping: bool,
    place: Place,
    /// Where to begin skipping if the current statement fails.
    mark: recover::Mark,
    /// Whether the parser is between statements, where a failing directive is abandoned alone.
    between: bool,
    steps: u64,
    /// The step at which an idle loop is stopped.
    last_step: u64,
    /// The step at which the budget is looked at again; not later than `last_step`.
    next_check: u64,
    /// Operations of all functions so far.
    function_operations: u64,
    /// The components that the current expression takes of vectors.
    pub(crate) members: Members,
    nesting: usize,
    read_bytes: u64,
    message_bytes: u64,
    diagnostics: Vec<Diagnostic>,
    /// The places of each warning, as file and offset.
    warned: std::collections::HashMap<String, std::collections::HashSet<(u32, u32)>>,
    errors: usize,
    /// Names with a reported error: not declared, or with an invalid value.
    pub(crate) doubtful: BTreeSet<Symbol>,
    /// The number of errors, including repeated ones.
    failures: usize,
    fatal: bool,
}

impl Parser<'_> {
    /// The next token after running all directives and macro calls before it. The token is not taken.
    ///
    /// # Errors
    /// If a directive before it fails.
    #[inline]
    pub fn peek(&mut self) -> PResult<Token> {
        match self.file.token(self.position) {
            Some(token) if token.kind < Kind::Name => Ok(token),
            _ => self.expand(),
        }
    }

    /// Takes the next token.
    ///
    /// # Errors
    /// If a directive before it fails, or the budget of steps is used up.
    #[inline]
    #[expect(
        clippy::should_implement_trait,
        reason = "the word every parser uses; the stream has no end that an iterator could tell"
    )]
    pub fn next(&mut self) -> PResult<Token> {
        let token = self.peek()?;
        self.take(token)?;
        Ok(token)
    }

    /// Takes the token just peeked.
    #[inline]
    pub(crate) fn take(&mut self, token: Token) -> PResult<()> {
        self.mark(token);
        if token.kind == Kind::Name && self.scopes.has_notices() {
            self.note_use(token);
        }
        match token.kind {
            Kind::LeftBrace => self.open_braces += 1,
            Kind::RightBrace => self.open_braces = self.open_braces.saturating_sub(1),
            _ => {}
        }
        if token.kind != Kind::End {
            self.position += 1;
        }
        self.steps += 1;
        self.check_steps()
    }

    /// Takes a name or key that is not used: one that is only asked for, or that names an entry of a dictionary.
    pub(crate) fn take_unused(&mut self, token: Token) {
        self.mark(token);
        self.pass(1);
    }

    /// Warns of the use of a deprecated name, which was just taken.
    #[inline(never)]
    fn note_use(&mut self, token: Token) {
        let Some(symbol) = token.symbol() else {
            return;
        };
        if let Some(text) = self.scopes.notice(symbol) {
            let name = report::shortened(self.symbols.text(symbol));
            let message = match text.trim() {
                "" => format!("`{name}` is deprecated: its author advises against using it"),
                text => format!("`{name}` is deprecated: {text}"),
            };
            self.warn(self.place, message);
        }
    }

    /// Counts operations of functions as steps.
    ///
    /// # Errors
    /// If the budget of steps is used up.
    pub(crate) fn spend(&mut self, operations: u64) -> PResult<()> {
        /// This many operations take as long as a token.
        const OPERATIONS: u64 = 4;
        self.steps = self.steps.saturating_add(operations / OPERATIONS);
        self.check_steps()
    }

    /// Sees to it now and then that the budget of steps is not used up, and that the scene is still wanted.
    ///
    /// # Errors
    /// If one of the two is not so.
    #[inline]
    pub(crate) fn check_steps(&mut self) -> PResult<()> {
        match self.steps > self.next_check {
            true => self.check_budget(),
            false => Ok(()),
        }
    }

    #[cold]
    fn check_budget(&mut self) -> PResult<()> {
        /// So many steps take some milliseconds.
        const PAUSE: u64 = 1 << 20;
        if self.steps > self.last_step {
            return Err(self.out_of_steps());
        }
        if self.host.stops() {
            let stopped = self.fail(self.place, "the reading of the scene was stopped");
            self.fatal = true;
            return Err(stopped);
        }
        self.next_check = self.last_step.min(self.steps.saturating_add(PAUSE));
        Ok(())
    }

    /// Counts the operations of a new function toward the limit.
    ///
    /// # Errors
    /// If all functions together are too large.
    pub(crate) fn count_function(&mut self, place: Place, operations: u64) -> PResult<()> {
        self.function_operations = self.function_operations.saturating_add(operations);
        let limit = self.options.limits.function_operations;
        if self.function_operations <= limit {
            return Ok(());
        }
        Err(self.fail_fatally(
            place,
            format!("all functions together have more than {limit} operations"),
            "a function includes the operations of the functions it calls, unless those are large; shorten chains of function calls, or raise the limit: `--limit function_operations=N`",
        ))
    }

    /// Records that something was created, which restarts the budget for idle loops.
    #[inline]
    pub(crate) fn made_progress(&mut self) {
        let limits = &self.options.limits;
        self.last_step = limits
            .steps
            .min(self.steps.saturating_add(limits.idle_steps));
    }

    /// The token at the position as written in the file: no directive is run and no macro called.
    #[inline]
    pub(crate) fn raw(&self) -> Token {
        self.raw_ahead(0)
    }

    /// The token `offset` positions further in the file.
    #[inline]
    pub(crate) fn raw_ahead(&self, offset: usize) -> Token {
        let token = self.file.token(self.position + offset);
        token.unwrap_or(Token::END)
    }

    /// Makes a token the last one taken, for error messages.
    #[inline]
    pub(crate) fn mark(&mut self, token: Token) {
        self.place = Place {
            file: self.file.file.0,
            start: token.start,
        };
    }

    /// The place of the last token taken.
    #[inline]
    pub fn place(&self) -> Place {
        self.place
    }

    /// The place of the token that was just peeked.
    pub(crate) fn place_of(&self, token: Token) -> Place {
        Place {
            file: self.file.file.0,
            start: token.start,
        }
    }

    /// A place as line and column.
    pub fn span_at(&self, place: Place) -> Span {
        let file = self.sources.get(place.file as usize);
        file.map_or(Span::NONE, |chunk| chunk.source.span(place.start))
    }

    /// The text of a string token of the current file.
    pub(crate) fn string_of(&self, token: Token) -> Arc<str> {
        let text = self.file.lexed.strings.get(token.bits as usize);
        text.cloned().unwrap_or_default()
    }

    /// The string as written, without resolving escapes.
    pub(crate) fn raw_string_of(&self, token: Token) -> String {
        self.file.source.raw_string(token)
    }

    /// Runs `f` one nesting level deeper.
    ///
    /// # Errors
    /// If that exceeds the limit, or `f` fails.
    #[inline]
    pub fn nested<T>(&mut self, f: impl FnOnce(&mut Self) -> PResult<T>) -> PResult<T> {
        if self.nesting >= self.options.limits.nesting {
            return Err(self.too_deep());
        }
        /// No level takes more stack than this; expression, object and texture together.
        const LEVEL: usize = 128 << 10;
        /// The remaining stack is checked once for this many levels.
        const LEVELS: usize = 4;
        const MORE: usize = 4 << 20;
        self.nesting += 1;
        let result = if self.nesting % LEVELS == 1 {
            stacker::maybe_grow(LEVELS * LEVEL, MORE, || f(self))
        } else {
            f(self)
        };
        self.nesting -= 1;
        result
    }

    fn too_deep(&mut self) -> Failed {
        let limit = self.options.limits.nesting;
        let message = format!("braces and parentheses are nested deeper than {limit} levels");
        self.fail_fatally(
            self.place,
            message,
            "build the object in steps with `#declare`, or raise the limit: `--limit nesting=N`",
        )
    }

    fn out_of_steps(&mut self) -> Failed {
        let limits = &self.options.limits;
        let (name, count, since) = if self.last_step < limits.steps {
            ("idle_steps", limits.idle_steps, " since the last object")
        } else {
            ("steps", limits.steps, "")
        };
        let message = format!(
            "the scene has taken {count} steps{since} (tokens and function calls): a loop or recursion seems not to end"
        );
        self.fail_fatally(
            self.place,
            message,
            format!(
                "check that the condition of the loop becomes false, or raise the limit: `--limit {name}=N`"
            ),
        )
    }
}
