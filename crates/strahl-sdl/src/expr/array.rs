use crate::keywords::Word;
use crate::parser::{PResult, Parser, Target};
use crate::token::Kind;
use crate::value::Value;
use std::sync::Arc;

/// Largest nesting depth of arrays and dictionaries.
pub(super) const MAX_DEPTH: u16 = 100;

/// Values by index, in one or more dimensions; the last index varies fastest.
#[derive(Clone, Debug)]
pub struct Array {
    dimensions: Vec<usize>,
    growing: bool,
    elements: Vec<Option<Value>>,
    depth: u16,
}

impl Array {
    /// The number of elements along each dimension.
    pub fn dimensions(&self) -> &[usize] {
        &self.dimensions
    }

    /// All elements; `None` for those without a value.
    pub fn elements(&self) -> &[Option<Value>] {
        &self.elements
    }

    /// An element by its flat index.
    pub fn element(&self, index: usize) -> Option<&Value> {
        self.elements.get(index)?.as_ref()
    }

    pub(crate) fn element_mut(&mut self, index: usize) -> Option<&mut Value> {
        self.elements.get_mut(index)?.as_mut()
    }

    /// Sets an element; an array without a fixed size grows. Returns `false` if there is no such element, or if arrays would be
    /// nested too deep.
    pub(crate) fn set(&mut self, index: usize, value: Option<Value>) -> bool {
        let depth = value.as_ref().map_or(0, depth_of);
        if depth >= MAX_DEPTH {
            return false;
        }
        if self.growing && index >= self.elements.len() {
            self.elements.resize(index + 1, None);
            self.dimensions = vec![index + 1];
        }
        let Some(slot) = self.elements.get_mut(index) else {
            return false;
        };
        *slot = value;
        self.depth = self.depth.max(depth + 1);
        true
    }

    pub(super) fn depth(&self) -> u16 {
        self.depth
    }
}

/// The nesting depth of containers in a value, which is limited because dropping them recurses.
pub(super) fn depth_of(value: &Value) -> u16 {
    match value {
        Value::Array(array) => array.depth(),
        Value::Dictionary(d) => d.depth(),
        _ => 0,
    }
}

impl Parser<'_> {
    /// `array [mixed] [n][m]... { values }`, whose keyword is taken.
    pub(super) fn array(&mut self) -> PResult<Value> {
        self.accept_word(Word::Mixed)?;
        let place = self.place();
        let mut dimensions = vec![];
        // `peek` would run a directive that follows, which might assign to this array.
        while self.raw().kind == Kind::LeftBracket {
            self.next()?;
            let size = self.float()?;
            self.expect(Kind::RightBracket)?;
            if !(1.0..1e15).contains(&size) {
                return Err(self.fail(place, format!("an array cannot have {size} elements")));
            }
            if dimensions.len() == 15 {
                return Err(self.fail(place, "an array has at most 15 dimensions"));
            }
            dimensions.push((size + 1e-8) as usize);
        }
        let sized = !dimensions.is_empty();
        let count = dimensions
            .iter()
            .try_fold(1u64, |n, d| n.checked_mul(*d as u64));
        let count = if sized { count.unwrap_or(u64::MAX) } else { 0 };
        self.spend_elements(count)?;
        let mut array = Array {
            elements: vec![None; count as usize],
            growing: !sized,
            depth: 1,
            dimensions: if sized { dimensions } else { vec![0] },
        };
        let mut given = false;
        if self.raw().kind == Kind::LeftBrace {
            given = true;
            let all = array.dimensions.clone();
            self.initialiser(&mut array, &all, 0)?;
        }
        // `array { ... }` has the size of its values; `array` alone grows.
        array.growing &= !given;
        Ok(Value::Array(Arc::new(array)))
    }

    /// `{ ... }` for the dimensions from here on, starting at flat index `at`.
    fn initialiser(&mut self, array: &mut Array, dimensions: &[usize], at: usize) -> PResult<()> {
        let rest = dimensions.get(1..).unwrap_or(&[]);
        let stride: usize = rest.iter().product();
        let place = self.place();
        self.braces(|p| {
            let mut index = 0;
            while p.peek()?.kind != Kind::RightBrace {
                if !array.growing && index >= dimensions.first().copied().unwrap_or(0) {
                    return Err(p.fail(place, "there are more values than elements"));
                }
                let flat = at + index * stride;
                if rest.is_empty() {
                    let value = p.value()?;
                    if array.growing {
                        p.spend_elements(1)?;
                    }
                    if !array.set(flat, Some(value)) {
                        return Err(p.fail(place, "arrays are nested too deep"));
                    }
                } else {
                    p.initialiser(array, rest, flat)?;
                }
                p.comma()?;
                index += 1;
            }
            Ok(())
        })
    }

    /// Counts new elements toward the limit.
    pub(crate) fn spend_elements(&mut self, count: u64) -> PResult<()> {
        let limit = self.options.limits.array_elements;
        self.array_elements = self.array_elements.saturating_add(count);
        if self.array_elements <= limit {
            return Ok(());
        }
        let place = self.place();
        let message = format!("all arrays together have more than {limit} elements");
        Err(self.fail_fatally(
            place,
            message,
            "make the arrays smaller, or raise the limit: `--limit array_elements=N`",
        ))
    }

    /// The flat index that the `[i][j]...` after the array stored at `target` mean.
    pub(crate) fn array_index(&mut self, target: &Target) -> PResult<usize> {
        match self.scopes.at(target) {
            Some(Value::Array(array)) => {
                let array = Arc::clone(array);
                self.index_in(&array, true)
            }
            _ => {
                let token = self.raw();
                Err(self.unexpected(token, "the name of an array before `[`"))
            }
        }
    }

    /// Reads one index per dimension.
    pub(super) fn index_in(&mut self, array: &Array, assigned: bool) -> PResult<usize> {
        /// An index this close below an integer means that integer.
        const ROUNDING: f64 = 1e-8;
        let mut flat = 0usize;
        for &size in &array.dimensions {
            self.expect(Kind::LeftBracket)?;
            let place = self.place();
            let index = self.nested(Self::float)? + ROUNDING;
            self.expect(Kind::RightBracket)?;
            if array.growing && assigned && index >= size as f64 && index < 1e15 {
                self.spend_elements(index as u64 + 1 - size as u64)?;
            } else if !(index >= 0.0 && index < size as f64) {
                let shown = (index - ROUNDING).floor();
                let message =
                    format!("index {shown} is outside of the array, which has {size} elements");
                return Err(self.fail_hint(place, message, "the first element has index 0"));
            }
            flat = flat * size + index as usize;
        }
        Ok(flat)
    }

    /// An array as the next argument of a function.
    pub(super) fn array_argument(&mut self) -> PResult<Arc<Array>> {
        let token = self.peek()?;
        let place = self.place_of(token);
        match self.value()? {
            Value::Array(array) => Ok(array),
            other => {
                let message = format!("expected an array, found {}", other.describe());
                Err(self.fail(place, message))
            }
        }
    }
}
