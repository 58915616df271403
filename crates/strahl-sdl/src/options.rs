use crate::Value;

/// The inputs of the parser besides the text.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Options {
    /// The value of `clock`.
    pub clock: f64,
    /// The animation's numbers.
    pub frame: Frame,
    /// The value of `image_width`, in pixels.
    pub image_width: u32,
    /// The value of `image_height`, in pixels.
    pub image_height: u32,
    /// Names declared before the scene begins (`Declare=NAME=VALUE`).
    pub declare: Vec<(String, Value)>,
    /// A file that is included before the scene begins (`Include_Header`).
    pub header: Option<String>,
    /// The language version of a scene that has no `#version`. Without either, `version` is 3.7, but the scene is read as an older one.
    pub version: Option<f64>,
    /// Limits on the resources that a scene may use.
    pub limits: Limits,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            clock: 0.0,
            frame: Frame::default(),
            image_width: 800,
            image_height: 600,
            declare: vec![],
            header: None,
            version: None,
            limits: Limits::default(),
        }
    }
}

/// The position of the picture in an animation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    /// Whether there is an animation: the value of `clock_on`.
    pub animated: bool,
    /// `frame_number`
    pub number: f64,
    /// `initial_frame`
    pub first: f64,
    /// `final_frame`
    pub last: f64,
    /// `initial_clock`
    pub initial_clock: f64,
    /// `final_clock`
    pub final_clock: f64,
    /// `clock_delta`
    pub clock_delta: f64,
}

impl Default for Frame {
    fn default() -> Self {
        Self {
            animated: false,
            number: 1.0,
            first: 1.0,
            last: 1.0,
            initial_clock: 0.0,
            final_clock: 1.0,
            clock_delta: 1.0,
        }
    }
}

/// Limits on the resources that a scene may use, so that a mistake in a scene ends in an error instead of exhausting the machine.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Limits {
    /// Tokens read in total; tokens in loops and macros count each time.
    pub steps: u64,
    /// The same since the last object, or part of a mesh or texture: a loop that creates nothing for this long is considered
    /// infinite. 600 million take about four seconds; a loop of a million rounds with 20 directives in each takes a third of
    /// that.
    pub idle_steps: u64,
    /// Operations that one evaluation of a function may take.
    pub function_cost: u64,
    /// Operations of all functions, with those copied from the functions they call.
    pub function_operations: u64,
    /// Nesting depth of macro calls and includes.
    pub depth: usize,
    /// Nesting depth of braces and parentheses.
    pub nesting: usize,
    /// Elements of all arrays.
    pub array_elements: u64,
    /// Bytes of one string.
    pub string_bytes: usize,
    /// Bytes of all strings.
    pub all_strings: u64,
    /// Objects, with the parts of CSG objects and all copies.
    pub objects: usize,
    /// Entries of all textures and meshes: colours of maps, copied members, vertices, faces.
    pub parts: u64,
    /// Nesting depth of textures.
    pub texture_depth: u32,
    /// Bytes of all files read.
    pub read_bytes: u64,
    /// Files opened for writing.
    pub written_files: usize,
    /// Bytes written to files, and bytes of messages.
    pub written_bytes: u64,
    /// Errors after which parsing ends.
    pub errors: usize,
}

impl Default for Limits {
    fn default() -> Self {
        Self {
            steps: 2_000_000_000,
            idle_steps: 600_000_000,
            function_cost: strahl_function::limits::COST,
            function_operations: 1 << 24,
            depth: 10_000,
            nesting: 1000,
            array_elements: 1 << 24,
            string_bytes: 1 << 24,
            all_strings: 1 << 30,
            objects: 20_000_000,
            parts: 1 << 28,
            texture_depth: 100,
            read_bytes: 8 << 30,
            written_files: 1000,
            written_bytes: 1 << 30,
            errors: 20,
        }
    }
}

impl Limits {
    /// The names of all limits.
    pub const NAMES: [&str; 16] = [
        "steps",
        "idle_steps",
        "function_cost",
        "function_operations",
        "depth",
        "nesting",
        "array_elements",
        "string_bytes",
        "all_strings",
        "objects",
        "parts",
        "texture_depth",
        "read_bytes",
        "written_files",
        "written_bytes",
        "errors",
    ];

    /// Sets the limit of this name; `false` if there is none, or its type does not hold the number.
    pub fn set(&mut self, name: &str, value: u64) -> bool {
        let size = usize::try_from(value);
        match (name, size) {
            ("steps", _) => self.steps = value,
            ("idle_steps", _) => self.idle_steps = value,
            ("function_cost", _) => self.function_cost = value,
            ("function_operations", _) => self.function_operations = value,
            ("depth", Ok(size)) => self.depth = size,
            ("nesting", Ok(size)) => self.nesting = size,
            ("array_elements", _) => self.array_elements = value,
            ("string_bytes", Ok(size)) => self.string_bytes = size,
            ("all_strings", _) => self.all_strings = value,
            ("objects", Ok(size)) => self.objects = size,
            ("parts", _) => self.parts = value,
            ("texture_depth", _) => match u32::try_from(value) {
                Ok(depth) => self.texture_depth = depth,
                Err(_) => return false,
            },
            ("read_bytes", _) => self.read_bytes = value,
            ("written_files", Ok(size)) => self.written_files = size,
            ("written_bytes", _) => self.written_bytes = value,
            ("errors", Ok(size)) => self.errors = size,
            _ => return false,
        }
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_limit_can_be_set() {
        let mut limits = Limits::default();
        for name in Limits::NAMES {
            assert!(limits.set(name, 7), "{name}");
        }
        let Limits {
            steps,
            idle_steps,
            function_cost,
            function_operations,
            depth,
            nesting,
            array_elements,
            string_bytes,
            all_strings,
            objects,
            parts,
            texture_depth,
            read_bytes,
            written_files,
            written_bytes,
            errors,
        } = limits;
        let wide = [
            steps,
            idle_steps,
            function_cost,
            function_operations,
            array_elements,
            all_strings,
            parts,
            read_bytes,
            written_bytes,
        ];
        let sizes = [depth, nesting, string_bytes, objects, written_files, errors];
        assert_eq!((wide, sizes, texture_depth), ([7; 9], [7; 6], 7));
        assert!(!limits.set("step", 7));
    }
}
