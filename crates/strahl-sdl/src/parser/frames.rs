use super::{Failed, Floor, PResult, Parser, Place, Scopes};
use crate::directives::{Files, Flow};
use crate::expr::Members;
use crate::grammar::{Foreseen, State, UNVERSIONED};
use crate::include;
use crate::options::Options;
use crate::source::{Chunk, Host, HostError, Source, SourceFile};
use crate::suggest::{Candidate, closest};
use crate::symbol::{Symbol, Symbols};
use crate::token::{Kind, Token};
use std::sync::Arc;
use strahl_scene::{Diagnostic, Scene};

/// How a frame was entered.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Entry {
    /// The scene file.
    Scene,
    /// `#include`.
    Include,
    /// A macro call.
    Macro(Symbol),
}

/// A file that does not contain scene text.
#[derive(Debug)]
pub(crate) struct Data {
    pub(crate) name: String,
    pub(crate) bytes: Vec<u8>,
}

/// A source of tokens.
#[derive(Debug)]
pub(super) struct Frame {
    pub(super) entry: Entry,
    /// The place from which it was entered.
    pub(super) from: Place,
    /// The file and position at which to continue when this frame ends.
    back: (Arc<Chunk>, usize),
    /// Index of the token that ends the frame.
    pub(super) end: usize,
    /// The number of open blocks when it was entered.
    pub(super) blocks: usize,
}

impl<'h> Parser<'h> {
    /// A parser at the beginning of a scene.
    pub(crate) fn new(source: Source, options: &'h Options, host: &'h mut dyn Host) -> Self {
        let mut symbols = Symbols::new();
        let mut scene = Scene::new();
        let id = scene.sources.add(&source.name);
        let text = Arc::new(SourceFile::new(id, source));
        let file = Arc::new(Chunk::first(text, Chunk::TOKENS, &mut symbols));
        let problems = file.lexed.problems.clone();
        let foreseen = Foreseen::of(&file.lexed.tokens);
        let read_bytes = file.source.length() as u64;
        let mut parser = Self {
            options,
            host,
            symbols,
            scopes: Scopes::default(),
            scene,
            state: State::default(),
            version: options.version.unwrap_or(UNVERSIONED),
            random: vec![],
            workspace: strahl_function::Workspace::new(),
            io: Files::default(),
            all_strings: 0,
            array_elements: 0,
            sources: vec![Arc::clone(&file)],
            position: 0,
            frames: vec![],
            blocks: vec![],
            floor: Floor::default(),
            open_braces: 0,
            arguments: vec![],
            brace_taken: false,
            value_nesting: None,
            stopping: false,
            place: Place { file: 0, start: 0 },
            mark: super::recover::Mark::default(),
            between: true,
            steps: 0,
            last_step: options.limits.steps.min(options.limits.idle_steps),
            next_check: 0,
            function_operations: 0,
            members: Members::default(),
            nesting: 0,
            read_bytes,
            message_bytes: 0,
            diagnostics: vec![],
            warned: std::collections::HashMap::new(),
            errors: 0,
            doubtful: std::collections::BTreeSet::new(),
            failures: 0,
            fatal: false,
            file: Arc::clone(&file),
        };
        parser.state.global.foreseen = foreseen;
        parser.frames.push(Frame {
            entry: Entry::Scene,
            from: parser.place,
            end: file.end(),
            back: (Arc::clone(&file), file.end()),
            blocks: 0,
        });
        if let Some(version) = options.version {
            parser.begin_version(version);
        }
        parser.report_lexing(0, problems);
        parser
    }

    /// Whether the position is in the scene's own file, not in an included one.
    pub(crate) fn in_scene_file(&self) -> bool {
        self.file.file.0 == 0
    }

    /// The end of the readable tokens, at the position.
    #[cold]
    fn end_here(&self) -> Token {
        Token {
            kind: Kind::End,
            ..self.raw()
        }
    }

    /// See [`Parser::peek`]: most names are not macros.
    pub(super) fn expand(&mut self) -> PResult<Token> {
        let token = self.raw();
        if token.kind == Kind::Name && self.scopes.find_macro(Symbol(token.bits as u32)).is_none() {
            return Ok(token);
        }
        self.run_on()
    }

    /// Runs directives and calls macros up to the next token that is neither.
    #[inline(never)]
    fn run_on(&mut self) -> PResult<Token> {
        loop {
            self.steps += 1;
            self.check_steps()?;
            let token = self.raw();
            match token.kind {
                Kind::Name => {
                    let symbol = Symbol(token.bits as u32);
                    match self.scopes.find_macro(symbol) {
                        Some(_) if self.stops_here() => return Ok(self.end_here()),
                        Some(found) => {
                            let found = Arc::clone(found);
                            self.call(token, found)?;
                        }
                        None => return Ok(token),
                    }
                }
                Kind::Directive if self.stops_here() => return Ok(self.end_here()),
                Kind::Directive => match self.run_directive(token)? {
                    Flow::On => {}
                    Flow::Stop => return Ok(self.end_here()),
                },
                Kind::End if self.next_chunk() => {}
                Kind::End => {
                    let innermost = self.frames.len() <= 1 || self.at_floor();
                    if innermost {
                        return Ok(token);
                    }
                    self.leave_frame();
                }
                _ => return Ok(token),
            }
        }
    }

    /// Whether the position is at the end of the frame and block that the running directive must not leave. It may leave them within
    /// braces: `#if (A) #declare B = union { #else #declare B = merge { #end ... }`.
    pub(crate) fn at_floor(&self) -> bool {
        self.frames.len() <= self.floor.frames
            && self.blocks.len() <= self.floor.blocks
            && self.open_braces <= self.floor.braces
    }

    /// Runs `f` such that the input ends for it at the end of the current frame or block: directives and arguments never read
    /// beyond the frame or block they are in, except within braces.
    pub(crate) fn enclosed<T>(&mut self, f: impl FnOnce(&mut Self) -> PResult<T>) -> PResult<T> {
        let before = self.floor;
        self.floor = Floor {
            frames: self.frames.len(),
            blocks: self.blocks.len(),
            braces: self.open_braces,
        };
        let stopping = std::mem::take(&mut self.stopping);
        let value_nesting = self.value_nesting.take();
        let result = f(self);
        self.floor = before;
        self.stopping = stopping;
        self.value_nesting = value_nesting;
        result
    }

    fn stops_here(&self) -> bool {
        self.stopping && self.at_floor()
    }

    /// Reads the value of a declaration with `f`. Because declarations need no semicolon, directives and macro calls after the
    /// value run only when the name has its value.
    pub(crate) fn declared_value<T>(
        &mut self,
        f: impl FnOnce(&mut Self) -> PResult<T>,
    ) -> PResult<T> {
        // Directives before the value belong to it.
        self.peek()?;
        let before = self.value_nesting.replace(self.nesting);
        let result = f(self);
        self.value_nesting = before;
        result
    }

    /// [`Parser::nested`] for the last part of a value.
    pub(crate) fn nested_end<T>(&mut self, f: impl FnOnce(&mut Self) -> PResult<T>) -> PResult<T> {
        let before = self.value_nesting;
        let ends = before == Some(self.nesting);
        let result = self.nested(|p| {
            if ends {
                p.value_nesting = Some(p.nesting);
            }
            f(p)
        });
        self.value_nesting = before;
        result
    }

    /// Leaves the macros that a value came from, if they end with it.
    pub(crate) fn value_ends(&mut self) -> PResult<()> {
        self.stopping = true;
        let ended = self.peek();
        self.stopping = false;
        ended.map(|_| ())
    }

    /// Like [`Parser::peek`] after a complete value: returns the end if a directive or a macro call follows a declared value.
    #[inline]
    pub(crate) fn peek_behind(&mut self) -> PResult<Token> {
        if self.value_nesting != Some(self.nesting) {
            return self.peek();
        }
        self.stopping = true;
        let token = self.peek();
        self.stopping = false;
        token
    }

    /// Continues in a part of a file: an include or the body of a macro.
    pub(crate) fn enter_frame(
        &mut self,
        entry: Entry,
        from: Place,
        file: Arc<Chunk>,
        begin: usize,
        end: usize,
    ) -> PResult<()> {
        let limit = self.options.limits.depth;
        if self.frames.len() >= limit {
            let message = format!("macros and includes are nested deeper than {limit} levels");
            return Err(self.fail_fatally(
                from,
                message,
                "a macro that calls itself needs an `#if` that ends the recursion; `--limit depth=N` raises the limit",
            ));
        }
        let back = (std::mem::replace(&mut self.file, file), self.position);
        self.position = begin;
        self.frames.push(Frame {
            entry,
            from,
            back,
            end,
            blocks: self.blocks.len(),
        });
        self.scopes.enter();
        Ok(())
    }

    /// Leaves the innermost frame, which is not that of the scene.
    pub(crate) fn leave_frame(&mut self) {
        if self.frames.len() > 1
            && let Some(frame) = self.frames.pop()
        {
            (self.file, self.position) = frame.back;
            self.blocks.truncate(frame.blocks);
            self.scopes.leave();
        }
    }

    /// Whether the position is at the end of the current macro.
    pub(crate) fn at_macro_end(&self) -> bool {
        self.frames
            .last()
            .is_some_and(|f| matches!(f.entry, Entry::Macro(_)) && f.end == self.position)
    }

    /// The chunk of a file being read.
    #[inline]
    pub(crate) fn current_file(&self) -> &Arc<Chunk> {
        &self.file
    }

    /// Index of the token at the position.
    pub(crate) fn position(&self) -> usize {
        self.position
    }

    /// Skips tokens of the file that were read separately.
    #[inline]
    pub(crate) fn pass(&mut self, count: usize) {
        self.position += count;
        self.steps += count as u64;
    }

    /// Moves the position within the file.
    pub(crate) fn jump(&mut self, position: usize) {
        self.position = position;
    }

    /// The nesting depth of frames; 1 in the scene itself.
    pub(crate) fn frame_depth(&self) -> usize {
        self.frames.len()
    }

    /// Continues in an included file.
    pub(crate) fn include(&mut self, name: &str, from: Place) -> PResult<()> {
        let file = self.load(name, from, Chunk::TOKENS)?;
        // A file may include itself under an `#ifndef`, but not infinitely often.
        const SELF_INCLUDES: usize = 32;
        let includes = self.frames.iter().filter(|f| f.entry == Entry::Include);
        let same = includes.filter(|f| f.back.0.source.name == file.source.name);
        if same.count() > SELF_INCLUDES {
            let name = &file.source.name;
            let message = format!("`{name}` includes itself repeatedly");
            return Err(self.fail_fatally(
                from,
                message,
                "guard the file with `#ifndef(NAME)`, `#declare NAME = 1;` ... `#end`",
            ));
        }
        let end = file.end();
        self.enter_frame(Entry::Include, from, file, 0, end)
    }

    /// A file of this name: the user's; or else, if it is a text, a built-in one; or else one of an installed POV-Ray.
    pub(crate) fn find_file(
        &mut self,
        name: &str,
        from: Place,
        text: bool,
    ) -> Result<Source, HostError> {
        let asking = self.sources.get(from.file as usize);
        let asking = asking.map_or(String::new(), |f| f.source.name.clone());
        let not_found = match self.host.load(name, &asking) {
            Err(error @ HostError::NotFound { .. }) => error,
            other => return other,
        };
        if text && let Some((name, text)) = include::find(name) {
            return Ok(Source::new(format!("<built in>/{name}"), text));
        }
        match self.host.load_installed(name) {
            Err(HostError::NotFound { .. }) if text && !has_ending(name) => self
                .find_file(&format!("{name}.inc"), from, true)
                .map_err(|_| not_found),
            Err(HostError::NotFound { searched, .. }) => Err(not_found.also(searched)),
            other => other,
        }
    }

    /// A file of this name, with at least its first `tokens` tokens.
    pub(crate) fn load(&mut self, name: &str, from: Place, tokens: usize) -> PResult<Arc<Chunk>> {
        let found = self.find_file(name, from, true);
        let narrowed = found.and_then(|source| {
            let name = source.name.clone();
            source.narrowed().map_err(|error| HostError::Io {
                name,
                message: error.to_string(),
            })
        });
        let mut source = match narrowed {
            Ok(source) => source,
            Err(error) => return Err(self.unreadable(error, from)),
        };
        let known = self.sources.iter().find(|f| f.source.is(&source));
        if let Some(known) = known {
            if known.lexed.rest.is_none() || tokens == Chunk::TOKENS {
                return Ok(Arc::clone(known));
            }
            let text = Arc::clone(&known.source);
            return Ok(Arc::new(Chunk::first(text, tokens, &mut self.symbols)));
        }
        self.read_bytes = self.read_bytes.saturating_add(source.length() as u64);
        let limit = self.options.limits.read_bytes;
        if source.length() >= u32::MAX as usize || self.read_bytes > limit {
            let message = format!(
                "`{}` is too large: all files of a scene may have at most {limit} bytes, one file 4 GiB",
                source.name
            );
            return Err(self.fail_fatally(
                from,
                message,
                "split the file, or raise the limit: `--limit read_bytes=N`",
            ));
        }
        // A text that has changed since it was first read gets another entry.
        while self.sources.iter().any(|f| f.source.name == source.name) {
            source.name.push_str(" (changed)");
        }
        let id = self.scene.sources.add(&source.name);
        let text = Arc::new(SourceFile::new(id, source));
        let file = Arc::new(Chunk::first(text, tokens, &mut self.symbols));
        self.sources.push(Arc::clone(&file));
        self.report_lexing(id.0, file.lexed.problems.clone());
        Ok(file)
    }

    /// The bytes of a file that is not scene text, such as a picture.
    pub(crate) fn read_file(&mut self, name: &str, from: Place) -> PResult<Data> {
        match self.look_for_file(name, from)? {
            Ok(data) => Ok(data),
            Err(error) => Err(self.unreadable(error, from)),
        }
    }

    /// The bytes of a file, or the host's error, which is not reported yet.
    pub(crate) fn look_for_file(
        &mut self,
        name: &str,
        from: Place,
    ) -> PResult<Result<Data, HostError>> {
        match self.find_file(name, from, false) {
            Ok(source) => self.counted(source, from).map(Ok),
            Err(error) => Ok(Err(error)),
        }
    }

    /// The bytes of a system font, by the name of its file.
    pub(crate) fn system_font(&mut self, file: &str, from: Place) -> PResult<Option<Data>> {
        match self.host.load_font(file) {
            Ok(Some(source)) => self.counted(source, from).map(Some),
            Ok(None) => Ok(None),
            Err(error) => Err(self.unreadable(error, from)),
        }
    }

    /// The bytes of a file, counted toward the limit.
    fn counted(&mut self, source: Source, from: Place) -> PResult<Data> {
        let name = source.name.clone();
        self.read_bytes = self.read_bytes.saturating_add(source.length() as u64);
        let limit = self.options.limits.read_bytes;
        if self.read_bytes > limit {
            let message =
                format!("`{name}` is too large: all files may have at most {limit} bytes");
            return Err(self.fail_fatally(
                from,
                message,
                "raise the limit: `--limit read_bytes=N`",
            ));
        }
        match source.into_bytes() {
            Ok(bytes) => Ok(Data { name, bytes }),
            Err(error) => {
                let message = error.to_string();
                Err(self.unreadable(HostError::Io { name, message }, from))
            }
        }
    }

    fn unreadable(&mut self, error: HostError, from: Place) -> Failed {
        let mut diagnostic = Diagnostic::error(error.to_string());
        if let HostError::NotFound { name, searched } = &error {
            let folders = searched.join(", ");
            diagnostic = diagnostic.hint(format!("it was searched in: {folders}"));
            let built_in = include::FILES
                .iter()
                .map(|(file, _)| (Candidate::new(file), ()));
            if let Some((close, ())) = closest(name, built_in) {
                diagnostic = diagnostic.hint(format!("did you mean `{close}`, which is built in?"));
            }
        }
        self.fail_with(from, diagnostic)
    }
}

/// Whether the name of a file has an ending, as in `name.png`.
pub(crate) fn has_ending(name: &str) -> bool {
    let last = name.rsplit(['/', '\\']).next().unwrap_or(name);
    last.contains('.')
}
