use super::header::{Header, Scalar};
use crate::input::Fallible;
use crate::input::text::{NumberError, Text, Words, parse_f32, parse_f64, parse_integer};
use strahl_scene::Diagnostic;

/// Where the numbers of the body come from.
pub(super) trait Source {
    /// The next number, exactly; it need not be finite.
    fn number(&mut self, scalar: Scalar) -> Fallible<f64>;

    /// The next number, which is of an integer type.
    fn integer(&mut self, scalar: Scalar) -> Fallible<i64>;

    /// Passes over numbers.
    fn skip(&mut self, scalar: Scalar, count: u64) -> Fallible<()>;

    /// How many bytes there still are.
    fn left(&self) -> u64;

    /// Puts a place to an error about the number just read.
    fn at_last(&self, problem: Diagnostic) -> Diagnostic;
}

/// Numbers as words.
pub(super) struct Ascii<'a> {
    text: Text<'a>,
    words: Words<'a>,
}

impl<'a> Ascii<'a> {
    pub(super) fn new(text: Text<'a>, header: &Header) -> Self {
        Self {
            text,
            words: text.words(header.body, header.body_line).without_comments(),
        }
    }
}

impl Source for Ascii<'_> {
    fn number(&mut self, scalar: Scalar) -> Fallible<f64> {
        let what = "a number";
        let word = self
            .words
            .next()
            .ok_or_else(|| Box::new(self.words.expected(what)))?;
        let parsed = match scalar {
            Scalar::F32 => parse_f32(word.bytes).map(f64::from),
            _ => parse_f64(word.bytes),
        };
        match parsed {
            Ok(number) => Ok(number),
            Err(NumberError::NotFinite) => Ok(f64::NAN),
            Err(e) => Err(Box::new(self.text.at(&word, e.describe(&word, what)))),
        }
    }

    fn integer(&mut self, _scalar: Scalar) -> Fallible<i64> {
        let what = "a whole number";
        let word = self
            .words
            .next()
            .ok_or_else(|| Box::new(self.words.expected(what)))?;
        parse_integer(word.bytes)
            .map_err(|e| Box::new(self.text.at(&word, e.describe(&word, what))))
    }

    fn skip(&mut self, _scalar: Scalar, count: u64) -> Fallible<()> {
        for _ in 0..count {
            self.words
                .next()
                .ok_or_else(|| Box::new(self.words.expected("a number")))?;
        }
        Ok(())
    }

    fn left(&self) -> u64 {
        // The last number needs no blank behind it.
        (self.text.bytes.len() - self.words.position()) as u64 + 1
    }

    fn at_last(&self, problem: Diagnostic) -> Diagnostic {
        match self.words.last() {
            Some(word) => self.text.at(&word, problem),
            None => problem,
        }
    }
}

/// Numbers as bytes.
pub(super) struct Binary<'a> {
    rest: &'a [u8],
    total: usize,
    name: &'a str,
    big_endian: bool,
}

impl<'a> Binary<'a> {
    pub(super) fn new(bytes: &'a [u8], header: &Header, name: &'a str, big_endian: bool) -> Self {
        Self {
            rest: &bytes[header.body..],
            total: bytes.len(),
            name,
            big_endian,
        }
    }

    #[inline]
    fn take<const N: usize>(&mut self) -> Fallible<[u8; N]> {
        let Some((bytes, rest)) = self.rest.split_first_chunk::<N>() else {
            return Err(self.ended());
        };
        self.rest = rest;
        let mut bytes = *bytes;
        if self.big_endian {
            bytes.reverse();
        }
        Ok(bytes)
    }

    #[cold]
    fn ended(&self) -> Box<Diagnostic> {
        let problem = format!("`{}` ends too early, after {} bytes", self.name, self.total);
        Box::new(Diagnostic::error(problem).hint("the file is cut off: copy or download it again"))
    }
}

impl Source for Binary<'_> {
    #[inline]
    fn number(&mut self, scalar: Scalar) -> Fallible<f64> {
        Ok(match scalar {
            Scalar::F32 => f64::from(f32::from_le_bytes(self.take()?)),
            Scalar::F64 => f64::from_le_bytes(self.take()?),
            _ => self.integer(scalar)? as f64,
        })
    }

    #[inline]
    fn integer(&mut self, scalar: Scalar) -> Fallible<i64> {
        Ok(match scalar {
            Scalar::I8 => i8::from_le_bytes(self.take()?).into(),
            Scalar::U8 => u8::from_le_bytes(self.take()?).into(),
            Scalar::I16 => i16::from_le_bytes(self.take()?).into(),
            Scalar::U16 => u16::from_le_bytes(self.take()?).into(),
            Scalar::I32 => i32::from_le_bytes(self.take()?).into(),
            Scalar::U32 => u32::from_le_bytes(self.take()?).into(),
            // Lists of these are refused with the header.
            Scalar::F32 => f32::from_le_bytes(self.take()?) as i64,
            Scalar::F64 => f64::from_le_bytes(self.take()?) as i64,
        })
    }

    fn skip(&mut self, scalar: Scalar, count: u64) -> Fallible<()> {
        let bytes = usize::try_from(count)
            .ok()
            .and_then(|n| n.checked_mul(scalar.size()));
        match bytes.and_then(|n| self.rest.get(n..)) {
            Some(rest) => self.rest = rest,
            None => return Err(self.ended()),
        }
        Ok(())
    }

    fn left(&self) -> u64 {
        self.rest.len() as u64
    }

    fn at_last(&self, mut problem: Diagnostic) -> Diagnostic {
        problem.message = format!("`{}`: {}", self.name, problem.message);
        problem
    }
}

/// The length of a list.
pub(super) fn list_length(scalar: Scalar, source: &mut impl Source) -> Fallible<u64> {
    let length = source.integer(scalar)?;
    u64::try_from(length).map_err(|_| {
        Box::new(source.at_last(Diagnostic::error(format!(
            "the length of a list cannot be negative, found `{length}`"
        ))))
    })
}
