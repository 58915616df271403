use super::Parser;
use crate::Parsed;
use crate::grammar::default_camera;

impl Parser<'_> {
    /// Declares the names given by the caller.
    pub(crate) fn declare_given(&mut self) {
        for (name, value) in &self.options.declare {
            let symbol = self.symbols.intern(name.as_bytes());
            if symbol.index() >= crate::keywords::Word::ALL.len() {
                self.scopes.bind_value(symbol, value.clone());
            }
        }
    }

    /// Begins with the file that the caller wants included before all others.
    pub(crate) fn include_header(&mut self) {
        if let Some(name) = &self.options.header {
            let place = self.place();
            // What is wrong is reported.
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
            // Names are not needed any more, so objects that only names refer to can be moved into the scene.
            self.scopes = super::Scopes::default();
            // What is wrong is reported.
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
