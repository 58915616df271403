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

/// All names so far, each stored once: an open-addressing hash table of their numbers.
///
/// It is used instead of a `HashMap<Box<str>, _>` because every identifier of the text is looked up here: one multiplication per
/// eight bytes, no allocation for known names, and no access to the text of names of up to 16 bytes.
#[derive(Debug)]
pub(crate) struct Symbols {
    text: String,
    /// The names in the order of their numbers.
    names: Vec<Name>,
    /// Symbol numbers plus one; 0 is free. The length is a power of two.
    table: Vec<u32>,
    /// Keywords that the scene has declared as names.
    freed: Vec<Symbol>,
}

/// A name.
#[derive(Clone, Copy, Debug)]
struct Name {
    /// The first bytes; a shorter name is padded with zeros.
    head: u128,
    /// The number of bytes.
    length: u32,
    /// Where the name ends in the text of all names.
    end: u32,
}

/// The number of bytes of a name that are known without its text.
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
            names: vec![],
            table: vec![0; 2048],
            freed: vec![],
        };
        for (_, text, _) in Word::ALL {
            symbols.intern(text.as_bytes());
        }
        symbols
    }

    /// The spelling of a symbol; empty if it belongs to another table.
    pub(crate) fn text(&self, symbol: Symbol) -> &str {
        let Some(name) = self.names.get(symbol.index()) else {
            return "";
        };
        let (start, end) = (name.end - name.length, name.end);
        self.text.get(start as usize..end as usize).unwrap_or("")
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
        (0..self.names.len() as u32).map(|n| (Symbol(n), self.text(Symbol(n))))
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
        while let Some(index) = self.table[slot].checked_sub(1) {
            let known = self.names[index as usize];
            let symbol = Symbol(index);
            if known.head == head
                && known.length as usize == length
                && (length <= HEAD || self.text(symbol).as_bytes() == name)
            {
                return symbol;
            }
            slot = (slot + 1) & mask;
        }
        let symbol = Symbol(self.names.len() as u32);
        let name = std::str::from_utf8(name).unwrap_or("");
        self.text.push_str(name);
        self.names.push(Name {
            head,
            length: name.len() as u32,
            end: self.text.len() as u32,
        });
        self.table[slot] = symbol.0 + 1;
        if self.names.len() * 2 > self.table.len() {
            self.grow();
        }
        symbol
    }

    fn grow(&mut self) {
        let mut table = vec![0; self.table.len() * 2];
        let mask = table.len() - 1;
        for (symbol, text) in self.iter() {
            let head = self.names[symbol.index()].head;
            let mut slot = hash(head, text.as_bytes()) as usize & mask;
            while table[slot] != 0 {
                slot = (slot + 1) & mask;
            }
            table[slot] = symbol.0 + 1;
        }
        self.table = table;
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
