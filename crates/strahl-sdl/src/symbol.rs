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

/// All names so far, each stored once: an open-addressing hash table over one string.
///
/// It is used instead of a `HashMap<Box<str>, _>` because every identifier of the text is looked up here: one multiplication per
/// eight bytes, no allocation for known names, and no access to the text of names of up to 16 bytes.
#[derive(Debug)]
pub(crate) struct Symbols {
    text: String,
    ends: Vec<u32>,
    /// The length is a power of two.
    table: Vec<Slot>,
    /// Keywords that the scene has declared as names.
    freed: Vec<Symbol>,
}

/// A slot of the table.
#[derive(Clone, Copy, Debug, Default)]
struct Slot {
    /// The first bytes of the name; a shorter name is padded with zeros.
    head: u128,
    /// The length of the name in bytes.
    length: u32,
    /// Symbol number plus one; 0 is free.
    number: u32,
}

/// The number of bytes of a name that its slot holds.
const HEAD: usize = 16;

/// The head of the name of this length at the beginning of a text.
#[inline]
fn head(text: &[u8], length: usize) -> u128 {
    let mask = match length {
        0..HEAD => (1 << (8 * length)) - 1,
        _ => u128::MAX,
    };
    let bytes = match text.first_chunk() {
        Some(bytes) => *bytes,
        None => {
            let mut bytes = [0; HEAD];
            bytes.iter_mut().zip(text).for_each(|(b, t)| *b = *t);
            bytes
        }
    };
    u128::from_le_bytes(bytes) & mask
}

impl Symbols {
    /// A table with the reserved words.
    pub(crate) fn new() -> Self {
        let mut symbols = Self {
            text: String::new(),
            ends: vec![],
            table: vec![Slot::default(); 2048],
            freed: vec![],
        };
        for (_, text, _) in Word::ALL {
            symbols.intern(text.as_bytes());
        }
        symbols
    }

    /// The spelling of a symbol; empty if it belongs to another table.
    pub(crate) fn text(&self, symbol: Symbol) -> &str {
        let index = symbol.index();
        let start = match index {
            0 => 0,
            _ => self.ends.get(index - 1).copied().unwrap_or(0) as usize,
        };
        let end = self.ends.get(index).copied().unwrap_or(0) as usize;
        self.text.get(start..end).unwrap_or("")
    }

    /// Turns a keyword into a name, from here on.
    pub(crate) fn free(&mut self, word: Symbol) {
        self.freed.push(word);
    }

    /// Whether a reserved word is a name now.
    pub(crate) fn is_freed(&self, word: Symbol) -> bool {
        self.freed.contains(&word)
    }

    /// All spellings, in the order in which they were added.
    pub(crate) fn iter(&self) -> impl Iterator<Item = (Symbol, &str)> {
        (0..self.ends.len() as u32).map(|n| (Symbol(n), self.text(Symbol(n))))
    }

    /// The symbol of a name, which is valid UTF-8: ASCII letters, digits and underscores, or the key of a dictionary.
    pub(crate) fn intern(&mut self, name: &[u8]) -> Symbol {
        self.intern_front(name, name.len())
    }

    /// The symbol of the name of this many bytes at the beginning of a text.
    pub(crate) fn intern_front(&mut self, text: &[u8], length: usize) -> Symbol {
        let head = head(text, length);
        let name = text.get(..length).unwrap_or(text);
        let mask = self.table.len() - 1;
        let mut slot = hash(head, name) as usize & mask;
        loop {
            let Slot {
                head: known,
                length: known_length,
                number,
            } = self.table[slot];
            if number == 0 {
                break;
            }
            let symbol = Symbol(number.wrapping_sub(1));
            if known == head
                && known_length as usize == length
                && (length <= HEAD || self.text(symbol).as_bytes() == name)
            {
                return symbol;
            }
            slot = (slot + 1) & mask;
        }
        let symbol = Symbol(self.ends.len() as u32);
        self.text.push_str(std::str::from_utf8(name).unwrap_or(""));
        self.ends.push(self.text.len() as u32);
        self.table[slot] = Slot {
            head,
            length: length as u32,
            number: symbol.0 + 1,
        };
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
            table: vec![Slot::default(); size],
            freed: std::mem::take(&mut self.freed),
        };
        for name in names {
            self.intern(&name);
        }
    }
}

#[inline]
fn hash(head: u128, name: &[u8]) -> u64 {
    // 2^64 divided by the golden ratio; the upper bits of the product depend on all lower ones.
    const FACTOR: u64 = 0x9e37_79b9_7f4a_7c15;
    let mix = |hash: u64, word: u64| (hash.rotate_left(5) ^ word).wrapping_mul(FACTOR);
    let mut hash = mix(mix(name.len() as u64, head as u64), (head >> 64) as u64);
    for part in name.get(HEAD..).unwrap_or(&[]).chunks(8) {
        hash = mix(hash, part.iter().fold(0, |w, b| w << 8 | u64::from(*b)));
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
