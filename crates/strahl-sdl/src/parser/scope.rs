//! Bindings of names, and their scopes.
//!
//! Scopes are dynamic, as in POV-Ray: a macro sees the local names of its caller. Every symbol has a stack of bindings, so
//! looking up a name takes one step however deeply macros are nested.

use crate::expr::{Array, Dictionary};
use crate::symbol::Symbol;
use crate::value::Value;
use std::sync::Arc;

/// A storage location: a binding, or an element of the array or dictionary bound.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Target {
    pub(crate) symbol: Symbol,
    /// Depth of the scope that contains the name.
    pub(crate) depth: u32,
    pub(crate) path: Vec<Step>,
}

/// A step from an array or dictionary to one of its elements.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Step {
    /// Index into the flat elements of an array.
    Index(usize),
    /// Key of a dictionary.
    Key(Symbol),
}

#[derive(Debug)]
enum Bound {
    Value(Value),
    /// A parameter of a macro that stands for a variable of the caller.
    Alias(Target),
}

/// What users of a deprecated name are told.
#[derive(Clone, Debug)]
pub(crate) struct Notice {
    /// The author's words; may be empty.
    pub(crate) text: Arc<str>,
    /// Whether only the first use is noted.
    pub(crate) once: bool,
}

#[derive(Debug)]
struct Binding {
    depth: u32,
    /// The number of its notice, from 1 on; 0 without one.
    notice: u32,
    bound: Bound,
}

/// All bindings.
#[derive(Debug, Default)]
pub(crate) struct Scopes {
    bindings: Vec<Vec<Binding>>,
    /// Symbols bound in each scope but the global one, scope by scope.
    declared: Vec<Symbol>,
    /// The beginning of each scope in `declared`.
    begins: Vec<usize>,
    /// The notices of deprecated names.
    notices: Vec<Notice>,
}

impl Scopes {
    /// Depth of the innermost scope; 0 is the global one.
    pub(crate) fn depth(&self) -> u32 {
        self.begins.len() as u32
    }

    pub(crate) fn enter(&mut self) {
        self.begins.push(self.declared.len());
    }

    pub(crate) fn leave(&mut self) {
        let depth = self.depth();
        let Some(begin) = self.begins.pop() else {
            return;
        };
        for symbol in self.declared.drain(begin..) {
            if let Some(stack) = self.bindings.get_mut(symbol.index())
                && stack.last().is_some_and(|b| b.depth == depth)
            {
                stack.pop();
            }
        }
    }

    /// The value of a name.
    #[inline]
    pub(crate) fn find(&self, symbol: Symbol) -> Option<&Value> {
        match &self.bindings.get(symbol.index())?.last()?.bound {
            Bound::Value(value) => Some(value),
            Bound::Alias(target) => self.at(target),
        }
    }

    /// The value of a name whose uses need no notice.
    #[inline]
    pub(crate) fn find_plain(&self, symbol: Symbol) -> Option<&Value> {
        let binding = self.bindings.get(symbol.index())?.last()?;
        match &binding.bound {
            Bound::Value(value) if binding.notice == 0 => Some(value),
            Bound::Value(_) => None,
            Bound::Alias(target) => self.at(target),
        }
    }

    /// Whether any name was declared as deprecated.
    #[inline]
    pub(crate) fn has_notices(&self) -> bool {
        !self.notices.is_empty()
    }

    /// Makes the name at a location deprecated.
    pub(crate) fn deprecate(&mut self, target: &Target, notice: Notice) {
        let stack = self.bindings.get_mut(target.symbol.index());
        let stack = stack.into_iter().flatten();
        for binding in stack.filter(|b| b.depth == target.depth) {
            self.notices.push(notice.clone());
            binding.notice = self.notices.len() as u32;
        }
    }

    /// The notice for a use of a name; with `once` for the first use only.
    pub(crate) fn notice(&mut self, symbol: Symbol) -> Option<Arc<str>> {
        let binding = self.bindings.get_mut(symbol.index())?.last_mut()?;
        let number = binding.notice.checked_sub(1)?;
        let notice = self.notices.get(number as usize)?;
        if notice.once {
            binding.notice = 0;
        }
        Some(Arc::clone(&notice.text))
    }

    /// The macro with this name.
    #[inline]
    pub(crate) fn find_macro(&self, symbol: Symbol) -> Option<&Arc<super::Macro>> {
        match &self.bindings.get(symbol.index())?.last()?.bound {
            Bound::Value(Value::Macro(found)) => Some(found),
            _ => None,
        }
    }

    /// The value stored at a location.
    #[inline]
    pub(crate) fn at(&self, target: &Target) -> Option<&Value> {
        let stack = self.bindings.get(target.symbol.index())?;
        let binding = stack.iter().rev().find(|b| b.depth == target.depth)?;
        let Bound::Value(bound) = &binding.bound else {
            return None;
        };
        let mut value = bound;
        for step in &target.path {
            value = match (value, *step) {
                (Value::Array(array), Step::Index(index)) => array.element(index)?,
                (Value::Dictionary(d), Step::Key(key)) => d.get(key)?,
                _ => return None,
            };
        }
        Some(value)
    }

    fn at_mut(&mut self, target: &Target) -> Option<&mut Value> {
        let stack = self.bindings.get_mut(target.symbol.index())?;
        let binding = stack.iter_mut().rev().find(|b| b.depth == target.depth)?;
        match &mut binding.bound {
            Bound::Value(value) => Some(value),
            Bound::Alias(_) => None,
        }
    }

    /// The location of a name, if it is bound; with `local`, in the innermost scope only.
    pub(crate) fn target(&self, symbol: Symbol, local: bool) -> Option<Target> {
        let binding = self.bindings.get(symbol.index())?.last()?;
        if local && binding.depth != self.depth() {
            return None;
        }
        Some(match &binding.bound {
            Bound::Value(_) => Target {
                symbol,
                depth: binding.depth,
                path: vec![],
            },
            Bound::Alias(target) => Target::clone(target),
        })
    }

    /// Removes a name that is a parameter of the innermost macro and stands for a variable of the caller, which stays. Tells whether it is one.
    pub(crate) fn remove_parameter(&mut self, symbol: Symbol) -> bool {
        let stack = self.bindings.get_mut(symbol.index());
        let found = stack.and_then(|stack| stack.pop_if(|b| matches!(b.bound, Bound::Alias(_))));
        found.is_some()
    }

    /// Stores a value at a location; returns `false` if the location no longer exists or is not an element of the container. A
    /// value for a scope that has been left is dropped.
    pub(crate) fn store(&mut self, target: &Target, value: Value) -> bool {
        if target.depth > self.depth() {
            return true;
        }
        if target.path.is_empty() {
            match self.at_mut(target) {
                Some(place) => *place = value,
                None => self.bind(target.symbol, target.depth, Bound::Value(value)),
            }
            return true;
        }
        let Some(mut place) = self.at_mut(target) else {
            return false;
        };
        let (last, before) = match target.path.split_last() {
            Some(split) => split,
            None => return false,
        };
        for step in before {
            let inner = match (place, *step) {
                (Value::Array(array), Step::Index(index)) => {
                    Arc::make_mut(array).element_mut(index)
                }
                (Value::Dictionary(d), Step::Key(key)) => Arc::make_mut(d).get_mut(key),
                _ => None,
            };
            match inner {
                Some(inner) => place = inner,
                None => return false,
            }
        }
        match (place, *last) {
            (Value::Array(array), Step::Index(index)) => {
                Arc::make_mut(array).set(index, Some(value))
            }
            (Value::Dictionary(d), Step::Key(key)) => {
                Arc::make_mut(d).set(key, value);
                true
            }
            _ => false,
        }
    }

    /// Removes the value at a location.
    pub(crate) fn remove(&mut self, target: &Target) {
        if let Some((last, before)) = target.path.split_last() {
            let parent = Target {
                path: before.to_vec(),
                ..target.clone()
            };
            if let Some(Value::Array(array)) = self.at(&parent)
                && let Step::Index(index) = *last
            {
                let mut array = Array::clone(array);
                array.set(index, None);
                self.store(&parent, Value::Array(Arc::new(array)));
            } else if let Some(Value::Dictionary(d)) = self.at(&parent)
                && let Step::Key(key) = *last
            {
                let mut d = Dictionary::clone(d);
                d.remove(key);
                self.store(&parent, Value::Dictionary(Arc::new(d)));
            }
        } else if let Some(stack) = self.bindings.get_mut(target.symbol.index()) {
            stack.retain(|b| b.depth != target.depth);
        }
    }

    /// Binds a parameter of the innermost scope to a value.
    pub(crate) fn bind_value(&mut self, symbol: Symbol, value: Value) {
        self.bind(symbol, self.depth(), Bound::Value(value));
    }

    /// Binds a parameter of the innermost scope to a variable of the caller.
    pub(crate) fn bind_alias(&mut self, symbol: Symbol, target: Target) {
        self.bind(symbol, self.depth(), Bound::Alias(target));
    }

    fn bind(&mut self, symbol: Symbol, depth: u32, bound: Bound) {
        if self.bindings.len() <= symbol.index() {
            self.bindings.resize_with(symbol.index() + 1, Vec::new);
        }
        let Some(stack) = self.bindings.get_mut(symbol.index()) else {
            return;
        };
        match stack.iter().rposition(|b| b.depth <= depth) {
            Some(at) if stack[at].depth == depth => stack[at].bound = bound,
            found => {
                // Most names are bound once: without this a list would get room for four values.
                stack.reserve_exact(usize::from(stack.is_empty()));
                let binding = Binding {
                    depth,
                    notice: 0,
                    bound,
                };
                stack.insert(found.map_or(0, |at| at + 1), binding);
                self.remember(symbol, depth);
            }
        }
    }

    /// Records that a scope has a symbol, which is removed on leaving the scope. The scope need not be the innermost one: the
    /// value of a macro is stored while the macro's own scope is still open.
    fn remember(&mut self, symbol: Symbol, depth: u32) {
        if depth == 0 {
            return;
        }
        let further_in = self.begins.get_mut(depth as usize..).unwrap_or_default();
        let end = further_in.first().copied();
        for begin in further_in {
            *begin += 1;
        }
        self.declared
            .insert(end.unwrap_or(self.declared.len()), symbol);
    }

    /// All bound names, for suggestions.
    pub(crate) fn bound(&self) -> impl Iterator<Item = Symbol> {
        let bound = self
            .bindings
            .iter()
            .enumerate()
            .filter(|(_, s)| !s.is_empty());
        bound.map(|(index, _)| Symbol(index as u32))
    }
}
