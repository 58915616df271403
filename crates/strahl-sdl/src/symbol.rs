//! Names as numbers.

use crate::keywords::Word;

/// A name or reserved word; reserved words have the numbers of [`Word`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Symbol(pub(crate) u32);

impl Symbol {
    pub(crate) fn index(self) -> usize {
        self.0 as usize
    }
}

/// All names met so far, each stored once: an open-addressing table of numbers over one string.
///
/// Own code instead of a `HashMap<Box<str>, _>` because every identifier of the text passes here: one multiplication per
/// eight bytes, no allocation for known names.
#[derive(Debug)]
pub(crate) struct Symbols {
    text: String,
    ends: Vec<u32>,
    /// Symbol number plus one; 0 is free. The length is a power of two.
    table: Vec<u32>,
    /// Reserved words that the scene has declared as names.
    freed: Vec<Symbol>,
}

impl Symbols {
    /// A table that holds the reserved words.
    pub(crate) fn new() -> Self {
        let mut symbols = Self {
            text: String::new(),
            ends: vec![],
            table: vec![0; 2048],
            freed: vec![],
        };
        for (_, text, _) in Word::ALL {
            symbols.intern(text.as_bytes());
        }
        symbols
    }

    /// The spelling of a symbol; empty for a number of another table.
    pub(crate) fn text(&self, symbol: Symbol) -> &str {
        let index = symbol.index();
        let start = match index {
            0 => 0,
            _ => self.ends.get(index - 1).copied().unwrap_or(0) as usize,
        };
        let end = self.ends.get(index).copied().unwrap_or(0) as usize;
        self.text.get(start..end).unwrap_or("")
    }

    /// Makes a name of a reserved word, for all that is read from now on.
    pub(crate) fn free(&mut self, word: Symbol) {
        self.freed.push(word);
    }

    /// Whether a reserved word is a name now.
    pub(crate) fn is_freed(&self, word: Symbol) -> bool {
        self.freed.contains(&word)
    }

    /// All spellings, in the order in which they were met.
    pub(crate) fn iter(&self) -> impl Iterator<Item = (Symbol, &str)> {
        (0..self.ends.len() as u32).map(|n| (Symbol(n), self.text(Symbol(n))))
    }

    /// The symbol of a name, which is valid UTF-8: ASCII letters, digits and underscores, or the key of a dictionary.
    pub(crate) fn intern(&mut self, name: &[u8]) -> Symbol {
        let mask = self.table.len() - 1;
        let mut slot = hash(name) as usize & mask;
        loop {
            match self.table[slot] {
                0 => break,
                n if self.text(Symbol(n - 1)).as_bytes() == name => return Symbol(n - 1),
                _ => slot = (slot + 1) & mask,
            }
        }
        let symbol = Symbol(self.ends.len() as u32);
        self.text.push_str(std::str::from_utf8(name).unwrap_or(""));
        self.ends.push(self.text.len() as u32);
        self.table[slot] = symbol.0 + 1;
        if self.ends.len() * 2 > self.table.len() {
            self.grow();
        }
        symbol
    }

    fn grow(&mut self) {
        let names: Vec<Vec<u8>> = self.iter().map(|(_, t)| t.as_bytes().to_vec()).collect();
        let size = self.table.len() * 4;
        *self = Self {
            text: String::with_capacity(self.text.len() * 2),
            ends: Vec::with_capacity(self.ends.len() * 2),
            table: vec![0; size],
            freed: std::mem::take(&mut self.freed),
        };
        for name in names {
            self.intern(&name);
        }
    }
}

fn hash(name: &[u8]) -> u64 {
    // 2^64 divided by the golden ratio; the upper bits of the product depend on all lower ones.
    const FACTOR: u64 = 0x9e37_79b9_7f4a_7c15;
    let mut hash = name.len() as u64;
    for part in name.chunks(8) {
        let word = match <[u8; 8]>::try_from(part) {
            Ok(word) => u64::from_le_bytes(word),
            Err(_) => part.iter().fold(0, |word, b| word << 8 | u64::from(*b)),
        };
        hash = (hash.rotate_left(5) ^ word).wrapping_mul(FACTOR);
    }
    hash >> 32
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_keep_their_numbers_while_the_table_grows() {
        let mut symbols = Symbols::new();
        assert_eq!(symbols.intern(b"sphere").0, Word::Sphere as u32);
        let first = symbols.intern(b"Ball");
        for i in 0..5000 {
            symbols.intern(format!("Name_{i}").as_bytes());
        }
        assert_eq!(symbols.intern(b"Ball"), first);
        assert_eq!(symbols.text(first), "Ball");
        assert_eq!(symbols.text(Symbol(u32::MAX)), "");
        let again = symbols.intern(b"Name_4321");
        assert_eq!(symbols.text(again), "Name_4321");
    }
}
