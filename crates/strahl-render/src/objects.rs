use crate::runs::{Run, RunList};
use std::sync::Arc;
use strahl_scene::Span;

/// Data of an object of the scene, for ray trees and layers.
#[derive(Clone, Debug, PartialEq)]
pub struct ObjectInfo {
    /// Name given in the scene.
    pub name: Option<Arc<str>>,
    /// The field's word for it: `sphere`, `mesh`, ...
    pub kind: &'static str,
    /// The place in the scene that made it.
    pub span: Span,
}

/// Data of the objects of a scene, by number.
///
/// Millions of objects may come from a loop, or one from each line of a file: such a run takes no more memory than one object.
#[derive(Clone, Debug, Default)]
pub struct Objects(RunList<ObjectRun>);

impl Objects {
    /// Number of objects.
    pub fn len(&self) -> usize {
        self.0.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// The object with a number.
    pub fn get(&self, number: u32) -> Option<ObjectInfo> {
        self.0.get(number)
    }

    /// All objects in the order of their numbers.
    pub fn iter(&self) -> impl Iterator<Item = ObjectInfo> {
        self.0.iter()
    }

    pub(crate) fn push(&mut self, object: ObjectInfo) {
        self.0.push(object);
    }

    pub(crate) fn completed(self) -> Self {
        Self(self.0.completed())
    }

    /// Bytes they occupy.
    pub(crate) fn bytes(&self) -> usize {
        self.0.bytes()
    }
}

/// Objects of the same name and kind whose places are at equal distances.
#[derive(Clone, Debug)]
struct ObjectRun {
    first: ObjectInfo,
    /// Lines from one object to the next.
    lines: u32,
}

impl Run for ObjectRun {
    type Item = ObjectInfo;

    fn of(item: ObjectInfo) -> Self {
        Self {
            first: item,
            lines: 0,
        }
    }

    fn goes_on(&mut self, len: u32, item: &ObjectInfo) -> bool {
        if len == 1 {
            self.lines = item.span.line.wrapping_sub(self.first.span.line);
        }
        self.item(len) == *item
    }

    fn item(&self, place: u32) -> ObjectInfo {
        let mut object = self.first.clone();
        let lines = self.lines.wrapping_mul(place);
        object.span.line = object.span.line.wrapping_add(lines);
        object
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use strahl_scene::FileId;

    #[test]
    fn a_million_objects_of_a_file_take_as_much_as_two() {
        let object = |line, name: Option<&str>| ObjectInfo {
            name: name.map(Arc::from),
            kind: "sphere",
            span: Span::line(FileId(0), line),
        };
        let mut objects = Objects::default();
        for line in 0..500_000 {
            objects.push(object(17 + line, None));
        }
        for _ in 0..500_000 {
            objects.push(object(500_017, Some("drop")));
        }
        let objects = objects.completed();
        assert_eq!(objects.len(), 1_000_000);
        assert!(objects.bytes() < 256, "{}", objects.bytes());
        assert_eq!(objects.get(0), Some(object(17, None)));
        assert_eq!(objects.get(499_999), Some(object(500_016, None)));
        assert_eq!(objects.get(999_999), Some(object(500_017, Some("drop"))));
        assert_eq!(objects.get(1_000_000), None);
    }
}
