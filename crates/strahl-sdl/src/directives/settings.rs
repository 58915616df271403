use crate::keywords::Word;
use crate::parser::{PResult, Parser};
use crate::token::Kind;

/// The version from which on the default `ambient` is 0, according to its documentation.
const DARK_SINCE: f64 = 3.8;

impl Parser<'_> {
    /// Runs `#version 3.7;`, whose keyword is taken; `#version unofficial ...` is skipped.
    pub(super) fn version(&mut self) -> PResult<()> {
        if self.accept_word(Word::Unofficial)? {
            let token = self.peek()?;
            if token.kind == Kind::Name || token.kind == Kind::Word {
                self.take(token)?;
            }
        }
        // Without a semicolon the next directive is carried out in the new version.
        let version = self.declared_value(Self::float)?;
        let place = self.place();
        if version > 3.8 {
            self.warn(
                place,
                format!(
                    "the scene is written for version {version} of the language; strahl supports versions up to 3.8"
                ),
            );
        }
        self.begin_version(version);
        self.raw_accept(Kind::Semicolon)?;
        Ok(())
    }

    /// Sets the version of the following text.
    pub(crate) fn begin_version(&mut self, version: f64) {
        self.version = version;
        let scene_file = self.in_scene_file();
        let global = &mut self.state.global;
        if scene_file {
            global.scene_version = Some(version);
        }
        let first = !std::mem::replace(&mut global.versioned, true);
        if first && scene_file && version >= DARK_SINCE {
            self.state.darken();
        }
    }

    /// Runs `#max_trace_level` and `#max_intersections`, which were directives up to version 2.2.
    pub(super) fn old_setting(&mut self, name: &str) -> PResult<()> {
        self.warn_hint(
            self.place(),
            format!("`#{name}` is a setting"),
            format!("write `global_settings {{ {name} ... }}`"),
        );
        if name == "max_trace_level" {
            return self.trace_level();
        }
        self.float().map(|_| ())
    }

    /// Runs `#default { ... }`, whose keyword is taken.
    pub(super) fn default_directive(&mut self) -> PResult<()> {
        self.braces(crate::grammar::default_items)
    }
}
