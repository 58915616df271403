use crate::keywords::Word;
use crate::parser::{PResult, Parser, Place};
use crate::source::Chunk;
use crate::symbol::Symbol;
use crate::token::{Kind, Token};
use crate::value::{Value, Vector};
use std::collections::BTreeMap;
use std::io::Write;
use std::sync::Arc;

/// Files that the scene has opened, by the names it gave them.
#[derive(Default)]
pub(crate) struct Files {
    open: BTreeMap<Symbol, OpenFile>,
    opened: usize,
    written: u64,
}

/// The mode of an open file.
enum OpenFile {
    /// The tokens of the file and the index of the next one to read.
    Read(Arc<Chunk>, usize),
    Write(Box<dyn Write + Send>),
}

impl Parser<'_> {
    /// Runs `#fopen Handle "name" read|write|append`, whose keyword is taken.
    pub(super) fn fopen(&mut self) -> PResult<()> {
        let handle = self.raw_name("the name of a file handle")?;
        let name = self.file_name()?;
        let place = self.place();
        let mode = self.next()?;
        let file = match mode.word() {
            Some(Word::Read) => OpenFile::Read(self.load(&name, place, usize::MAX)?, 0),
            Some(Word::Write) => OpenFile::Write(self.create(&name, false, place)?),
            Some(Word::Append) => OpenFile::Write(self.create(&name, true, place)?),
            _ => return Err(self.unexpected(mode, "`read`, `write` or `append`")),
        };
        let reads = matches!(file, OpenFile::Read(..));
        self.io.open.insert(handle, file);
        // `#ifdef (Handle)` tests whether there is more to read.
        let target = self.global_target(handle);
        let value = Value::Float(1.0);
        if !reads || self.more_to_read(handle) {
            self.scopes.store(&target, value);
        }
        Ok(())
    }

    fn create(&mut self, name: &str, append: bool, place: Place) -> PResult<Box<dyn Write + Send>> {
        let limit = self.options.limits.written_files;
        self.io.opened += 1;
        if self.io.opened > limit {
            let message = format!("the scene opens more than {limit} files for writing");
            return Err(self.fail_fatally(
                place,
                message,
                "raise the limit: `--limit written_files=N`",
            ));
        }
        match self.host.create(name, append) {
            Ok(file) => Ok(file),
            Err(error) => Err(self.fail_hint(
                place,
                error.to_string(),
                "`strahl render` lets a scene write into the folder SCENE.out, or within that of `--allow-write`",
            )),
        }
    }

    /// Runs `#fclose Handle`, whose keyword is taken.
    pub(super) fn fclose(&mut self) -> PResult<()> {
        let handle = self.raw_name("the name of a file handle")?;
        let place = self.place();
        match self.io.open.remove(&handle) {
            Some(OpenFile::Write(mut file)) => {
                if let Err(error) = file.flush() {
                    return Err(self.fail(place, format!("the file cannot be written: {error}")));
                }
            }
            Some(OpenFile::Read(..)) => {}
            None => self.warn(place, "this file is not open"),
        }
        let target = self.global_target(handle);
        self.scopes.remove(&target);
        Ok(())
    }

    /// Closes files that the scene has not closed.
    pub(crate) fn close_files(&mut self) {
        for file in std::mem::take(&mut self.io.open).into_values() {
            if let OpenFile::Write(mut file) = file
                && let Err(error) = file.flush()
            {
                let place = self.place();
                // `fail` reports the error.
                let _ = self.fail(place, format!("a file cannot be written: {error}"));
            }
        }
    }

    /// Runs `#write (Handle, values ...)`, whose keyword is taken.
    pub(super) fn write(&mut self) -> PResult<()> {
        self.expect(Kind::LeftParen)?;
        let handle = self.raw_name("the name of a file handle")?;
        let place = self.place();
        self.comma()?;
        let mut text = String::new();
        while !self.accept(Kind::RightParen)? {
            let token = self.peek()?;
            match token.word() {
                Some(
                    word @ (Word::Sint8
                    | Word::Uint8
                    | Word::Sint16be
                    | Word::Sint16le
                    | Word::Uint16be
                    | Word::Uint16le
                    | Word::Sint32be
                    | Word::Sint32le),
                ) => {
                    let word = word.text();
                    return Err(self.fail(
                        place,
                        format!("writing binary numbers (`{word}`) is not supported"),
                    ));
                }
                _ => match self.value()? {
                    Value::String(s) => text.push_str(&s),
                    Value::Float(x) => text.push_str(&six_digits(x)),
                    Value::Vector(v) => {
                        let numbers = v.as_slice().iter().map(|x| six_digits(*x));
                        // POV-Ray writes a space after each vector (measured).
                        text.push_str(&format!("<{}> ", numbers.collect::<Vec<_>>().join(",")));
                    }
                    other => {
                        let message = format!("{} cannot be written to a file", other.describe());
                        return Err(self.fail(place, message));
                    }
                },
            }
            self.comma()?;
        }
        self.io.written = self.io.written.saturating_add(text.len() as u64);
        let limit = self.options.limits.written_bytes;
        if self.io.written > limit {
            let message = format!("the scene writes more than {limit} bytes");
            return Err(self.fail_fatally(
                place,
                message,
                "raise the limit: `--limit written_bytes=N`",
            ));
        }
        match self.io.open.get_mut(&handle) {
            Some(OpenFile::Write(file)) => match file.write_all(text.as_bytes()) {
                Ok(()) => Ok(()),
                Err(error) => Err(self.fail(place, format!("the file cannot be written: {error}"))),
            },
            _ => Err(self.fail_hint(
                place,
                "this file is not open for writing",
                "open it by `#fopen Handle \"name\" write`",
            )),
        }
    }

    /// Runs `#read (Handle, names ...)`, whose keyword is taken: reads numbers, vectors and strings separated by commas.
    ///
    /// As in POV-Ray the file is at its end after its last value, unless a comma follows: then it is when there was no value any more, and
    /// the variables that got none keep what they have (measured).
    pub(super) fn read(&mut self) -> PResult<()> {
        self.expect(Kind::LeftParen)?;
        let handle = self.raw_name("the name of a file handle")?;
        while !self.accept(Kind::RightParen)? {
            self.comma()?;
            let symbol = self.raw_name("the name of a variable")?;
            let place = self.place();
            let found = self.scopes.target(symbol, false);
            let mut target = found.unwrap_or_else(|| self.global_target(symbol));
            self.steps_into(&mut target)?;
            if let Some(value) = self.read_value(handle, place)? {
                self.assign(&target, value, place)?;
            }
        }
        if !self.more_to_read(handle) {
            let target = self.global_target(handle);
            self.scopes.remove(&target);
        }
        Ok(())
    }

    fn more_to_read(&self, handle: Symbol) -> bool {
        match self.io.open.get(&handle) {
            Some(OpenFile::Read(file, position)) => {
                let rest = file.lexed.tokens.get(*position..).unwrap_or(&[]);
                rest.iter().any(|token| token.kind != Kind::End)
            }
            _ => false,
        }
    }

    /// The next value of a file; `None` at its end.
    fn read_value(&mut self, handle: Symbol, place: Place) -> PResult<Option<Value>> {
        let Some(OpenFile::Read(file, position)) = self.io.open.get_mut(&handle) else {
            return Err(self.fail_hint(
                place,
                "this file is not open for reading",
                "open it by `#fopen Handle \"name\" read`",
            ));
        };
        let mut reader = Reader {
            file,
            position: *position,
        };
        if reader.is_at_end() {
            *position = reader.position;
            return Ok(None);
        }
        let value = reader.value();
        *position = reader.position;
        let name = file.source.name.clone();
        match value {
            Some(value) => Ok(Some(value)),
            None => Err(self.fail_hint(
                place,
                format!("`{name}` has no number, vector or string here"),
                "`#while (defined(Handle))` reads up to the end of the file",
            )),
        }
    }

    pub(crate) fn global_target(&self, symbol: Symbol) -> crate::parser::Target {
        crate::parser::Target {
            symbol,
            depth: 0,
            path: vec![],
        }
    }
}

/// Reads values from the tokens of a data file.
struct Reader<'a> {
    file: &'a Chunk,
    position: usize,
}

impl Reader<'_> {
    fn next(&mut self) -> Token {
        let token = self.file.token(self.position);
        self.position += 1;
        token.unwrap_or(Token::END)
    }

    /// Skips commas; whether nothing follows them.
    fn is_at_end(&mut self) -> bool {
        let kind = |position| self.file.token(position).map_or(Kind::End, |t| t.kind);
        while kind(self.position) == Kind::Comma {
            self.position += 1;
        }
        kind(self.position) == Kind::End
    }

    /// The value that follows, which is no comma.
    fn value(&mut self) -> Option<Value> {
        let token = self.next();
        match token.kind {
            Kind::String => {
                let text = self.file.lexed.strings.get(token.bits as usize)?;
                Some(Value::String(Arc::clone(text)))
            }
            Kind::Less => {
                let mut numbers = vec![];
                loop {
                    let token = self.next();
                    match token.kind {
                        Kind::Comma => {}
                        Kind::Greater if (2..=5).contains(&numbers.len()) => {
                            return Some(Value::Vector(Vector::new(&numbers)));
                        }
                        _ if numbers.len() < 5 => numbers.push(self.number(token)?),
                        _ => return None,
                    }
                }
            }
            _ => self.number(token).map(Value::Float),
        }
    }

    fn number(&mut self, token: Token) -> Option<f64> {
        match token.kind {
            Kind::Number => Some(token.number()),
            Kind::Minus => {
                let next = self.next();
                (next.kind == Kind::Number).then(|| -next.number())
            }
            Kind::Plus => {
                let next = self.next();
                (next.kind == Kind::Number).then(|| next.number())
            }
            _ => None,
        }
    }
}

/// A number as `#write` writes it: with up to six digits, and with an exponent if it is below 0.0001 or has more than six digits
/// before the point (measured).
fn six_digits(x: f64) -> String {
    if !x.is_finite() {
        return x.to_string().to_lowercase();
    }
    let text = format!("{x:.5e}");
    let Some((digits, exponent)) = text.split_once('e') else {
        return text;
    };
    let exponent: i32 = exponent.parse().unwrap_or_default();
    let without_zeros = |digits: &str| match digits.contains('.') {
        true => digits
            .trim_end_matches('0')
            .trim_end_matches('.')
            .to_owned(),
        false => digits.to_owned(),
    };
    if (-4..6).contains(&exponent) {
        let places = usize::try_from(5 - exponent).unwrap_or_default();
        return without_zeros(&format!("{x:.places$}"));
    }
    let sign = if exponent < 0 { '-' } else { '+' };
    format!("{}e{sign}{:02}", without_zeros(digits), exponent.abs())
}
