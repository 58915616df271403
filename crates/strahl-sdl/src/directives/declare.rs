use crate::keywords::{Word, WordKind};
use crate::parser::{Notice, PResult, Parser, Place, Step, Target};
use crate::symbol::Symbol;
use crate::token::Kind;
use crate::value::Value;

impl Parser<'_> {
    /// Runs `#declare` or `#local`, whose keyword is taken.
    pub(super) fn declare(&mut self, local: bool) -> PResult<()> {
        let notice = self.deprecated()?;
        if self.accept(Kind::LeftParen)? {
            self.declare_tuple(local, notice.as_ref())?;
        } else {
            let (target, place) = self.assigned(local)?;
            self.expect(Kind::Equal)?;
            let value = self.declared_value(Self::value).inspect_err(|_| {
                // Later uses of the name must not report errors of their own.
                self.doubtful.insert(target.symbol);
            })?;
            self.assign_noted(&target, value, place, notice.as_ref())?;
        }
        self.end_of_assignment()
    }

    /// The semicolon is required, but the meaning is clear without it. If the value came from a macro, the macro ends before it. A second one
    /// is taken too, as in POV-Ray (measured): macros whose value ends with one leave it.
    fn end_of_assignment(&mut self) -> PResult<()> {
        for _ in 0..2 {
            if !self.at_floor() {
                self.value_ends()?;
            }
            if !self.raw_accept(Kind::Semicolon)? {
                break;
            }
        }
        Ok(())
    }

    /// Assigns to a name. If that declares it, its uses get the notice; a notice for a known name has no effect, as in POV-Ray (measured).
    fn assign_noted(
        &mut self,
        target: &Target,
        value: Value,
        place: Place,
        notice: Option<&Notice>,
    ) -> PResult<()> {
        let notice = notice.filter(|_| self.scopes.at(target).is_none());
        self.assign(target, value, place)?;
        if let Some(notice) = notice.filter(|_| target.path.is_empty()) {
            self.scopes.deprecate(target, notice.clone());
        }
        Ok(())
    }

    /// `deprecated [once] "text"`: a notice for users of the name.
    fn deprecated(&mut self) -> PResult<Option<Notice>> {
        if !self.raw().is(Word::Deprecated) {
            return Ok(None);
        }
        self.next()?;
        let once = self.accept_word(Word::Once)?;
        let token = self.peek()?;
        let has_text = token.kind == Kind::String
            || token.word().map(Word::kind) == Some(WordKind::StringFunction);
        let text = match has_text {
            true => self.string()?,
            false => "".into(),
        };
        Ok(Some(Notice { text, once }))
    }

    /// `(A, B, ...) = values` (3.8): assigns to several names; all values are read before the first one is assigned.
    fn declare_tuple(&mut self, local: bool, notice: Option<&Notice>) -> PResult<()> {
        let mut targets = vec![];
        loop {
            let optional = self.raw().is(Word::Optional);
            if optional {
                self.next()?;
            }
            let (target, place) = self.assigned(local)?;
            targets.push((target, place, optional));
            self.comma()?;
            if self.accept(Kind::RightParen)? {
                break;
            }
        }
        self.expect(Kind::Equal)?;
        let place = self.place();
        let values = if self.accept(Kind::LeftParen)? {
            let values = self.nested(|p| p.tuple(targets.len()))?;
            values.into_iter().map(Some).collect()
        } else {
            match self.value()? {
                Value::Array(array) => array.elements().to_vec(),
                other => {
                    let message = format!(
                        "expected as many values as names, found {}",
                        other.describe()
                    );
                    return Err(self.fail_hint(
                        place,
                        message,
                        "write `(a, b)` or an array on the right",
                    ));
                }
            }
        };
        for (index, (target, place, optional)) in targets.iter().enumerate() {
            match values.get(index).cloned().flatten() {
                Some(value) => self.assign_noted(target, value, *place, notice)?,
                None if *optional => {}
                None => {
                    let message = "there is no value for this name in the list on the right";
                    return Err(self.fail(*place, message));
                }
            }
        }
        Ok(())
    }

    fn tuple(&mut self, count: usize) -> PResult<Vec<Value>> {
        let mut values = vec![];
        while values.len() < count && self.peek()?.kind != Kind::RightParen {
            values.push(self.value()?);
            self.comma()?;
        }
        self.expect(Kind::RightParen)?;
        Ok(values)
    }

    /// The name and the indices on the left of `=`.
    fn assigned(&mut self, mut local: bool) -> PResult<(Target, Place)> {
        let mut global = false;
        let scope = self.raw();
        if (scope.is(Word::Local) || scope.is(Word::Global)) && self.raw_ahead(1).kind == Kind::Dot
        {
            global = scope.is(Word::Global);
            local = !global;
            self.next()?;
            self.next()?;
        }
        let symbol = self.raw_name("the name of a variable")?;
        let place = self.place();
        let mut target = match (global, local) {
            (true, _) => Target {
                symbol,
                depth: 0,
                path: vec![],
            },
            (false, true) => self.local_target(symbol),
            // A visible local name is assigned to, as in POV-Ray.
            (false, false) => self.scopes.target(symbol, false).unwrap_or(Target {
                symbol,
                depth: 0,
                path: vec![],
            }),
        };
        self.steps_into(&mut target)?;
        Ok((target, place))
    }

    /// The place where `#local` stores a name.
    pub(super) fn local_target(&self, symbol: Symbol) -> Target {
        self.scopes.target(symbol, true).unwrap_or(Target {
            symbol,
            depth: self.scopes.depth(),
            path: vec![],
        })
    }

    /// `[i]` and `.Key` after a name on the left of `=`.
    pub(crate) fn steps_into(&mut self, target: &mut Target) -> PResult<()> {
        loop {
            let token = self.raw();
            match token.kind {
                Kind::LeftBracket => match self.scopes.at(target) {
                    Some(Value::Dictionary(_)) => {
                        let key = self.key_in_brackets()?;
                        target.path.push(Step::Key(key));
                    }
                    Some(Value::Array(_)) => {
                        let index = self.array_index(target)?;
                        target.path.push(Step::Index(index));
                    }
                    _ => {
                        let place = self.place();
                        return Err(self.fail_hint(
                            place,
                            "this is not an array, so it has no elements",
                            "declare it first: `#declare Name = array[10];`",
                        ));
                    }
                },
                Kind::Dot => {
                    self.take(token)?;
                    let key = self.key()?;
                    target.path.push(Step::Key(key));
                }
                _ => return Ok(()),
            }
        }
    }

    pub(super) fn assign(&mut self, target: &Target, value: Value, place: Place) -> PResult<()> {
        if self.scopes.store(target, value) {
            return Ok(());
        }
        Err(self.fail(
            place,
            "this element cannot be assigned to: it does not exist, or arrays and dictionaries would be nested more than 100 deep",
        ))
    }

    /// Runs `#undef`, whose keyword is taken.
    pub(super) fn undef(&mut self) -> PResult<()> {
        let scope = self.raw();
        if (scope.is(Word::Local) || scope.is(Word::Global)) && self.raw_ahead(1).kind == Kind::Dot
        {
            self.next()?;
            self.next()?;
        }
        let symbol = self.raw_name("the name of a variable")?;
        let place = self.place();
        let is_whole = !matches!(self.raw().kind, Kind::LeftBracket | Kind::Dot);
        if is_whole && self.scopes.remove_parameter(symbol) {
            return self.end_of_assignment();
        }
        match self.scopes.target(symbol, false) {
            Some(mut target) => {
                self.steps_into(&mut target)?;
                self.scopes.remove(&target);
            }
            None => {
                let name = self.symbols.text(symbol).to_owned();
                self.warn(
                    place,
                    format!("`{name}` is not declared, so `#undef` does nothing"),
                );
            }
        }
        self.end_of_assignment()
    }
}
