use super::Parser;
use crate::Parsed;
use crate::grammar::default_camera;

impl Parser<'_> {
    /// Declares the names given in the options.
    pub(crate) fn declare_given(&mut self) {
        for (name, value) in &self.options.declare {
            let symbol = self.symbols.intern(name.as_bytes());
            if symbol.index() >= crate::keywords::Word::ALL.len() {
                self.scopes.bind_value(symbol, value.clone());
            }
        }
    }

    /// Includes the header file given in the options.
    pub(crate) fn include_header(&mut self) {
        if let Some(name) = &self.options.header {
            let place = self.place();
            // The error is already reported.
            let _ = self.include(name, place);
        }
    }

    /// The name of the scene file.
    pub(crate) fn scene_name(&self) -> String {
        self.sources
            .first()
            .map_or(String::new(), |f| f.source.name.clone())
    }

    /// The result of parsing.
    pub(crate) fn into_parsed(mut self) -> Parsed {
        self.close_files();
        if self.errors == 0 {
            // Names are no longer needed, so objects that only names refer to can be moved into the scene.
            self.scopes = super::Scopes::default();
            // The error is already reported.
            let _ = self.link_instances();
        }
        self.scene.camera.get_or_insert_with(default_camera);
        let (diagnostics, failed) = self.take_diagnostics();
        Parsed {
            scene: (!failed).then_some(self.scene),
            diagnostics,
        }
    }
}
