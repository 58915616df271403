use std::collections::HashMap;

/// The normal of a vertex of a mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum NormalKey {
    /// None: flat faces.
    Flat,
    /// One of the list.
    Given(u32),
    /// The mean within a smoothing group.
    Group(u32),
}

/// No part, no vertex, no texture coordinate.
const NONE: u32 = u32::MAX;

/// Further vertices of a part at one position are not searched: a duplicate does no harm.
const MOST_AT_ONE: u32 = 16;

/// Finds the vertices of meshes by their positions in the file.
///
/// A hash table of the keys would take most of the time for files of millions of faces, missing the cache at every lookup; an
/// array by position is looked up where the last face has been.
#[derive(Debug, Default)]
pub(super) struct Vertices {
    /// By position: the part that has used it last, and the vertex that part made there last.
    latest: Vec<Place>,
    /// The same for the parts that used a position earlier.
    former: HashMap<(u32, u32), u32>,
}

#[derive(Clone, Copy, Debug)]
struct Place {
    part: u32,
    vertex: u32,
}

/// What distinguishes vertices of one position.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Key {
    pub(super) uv: Option<u32>,
    pub(super) normal: NormalKey,
}

/// A vertex of a part, and the one before it at the same position.
#[derive(Clone, Copy, Debug)]
pub(super) struct Link {
    key: Key,
    before: u32,
}

impl Vertices {
    /// The vertex of a part at a position with this key; made by `make` if there is none.
    ///
    /// `links` are those of the part, one for each of its vertices.
    pub(super) fn find(
        &mut self,
        part: u32,
        position: u32,
        key: Key,
        links: &mut Vec<Link>,
        make: impl FnOnce() -> u32,
    ) -> u32 {
        let index = position as usize;
        if self.latest.len() <= index {
            let place = Place {
                part: NONE,
                vertex: NONE,
            };
            self.latest.resize(index + 1, place);
        }
        let place = self.latest[index];
        let newest = match place.part {
            known if known == part => place.vertex,
            NONE => NONE,
            other => {
                self.former.insert((other, position), place.vertex);
                self.former.remove(&(part, position)).unwrap_or(NONE)
            }
        };
        let mut vertex = newest;
        for _ in 0..MOST_AT_ONE {
            let Some(link) = links.get(vertex as usize) else {
                break;
            };
            if link.key == key {
                self.latest[index] = Place {
                    part,
                    vertex: newest,
                };
                return vertex;
            }
            vertex = link.before;
        }
        let vertex = make();
        links.push(Link {
            key,
            before: newest,
        });
        self.latest[index] = Place { part, vertex };
        vertex
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn vertices_are_found_again_in_their_parts() {
        let mut vertices = Vertices::default();
        let mut parts = [vec![], vec![]];
        let key = |uv| Key {
            uv,
            normal: NormalKey::Flat,
        };
        let mut at = |part: usize, position, uv| {
            let links: &mut Vec<Link> = &mut parts[part];
            let count = links.len() as u32;
            vertices.find(part as u32, position, key(uv), links, || count)
        };
        assert_eq!(at(0, 7, None), 0);
        assert_eq!(at(0, 7, Some(1)), 1);
        assert_eq!(at(1, 7, Some(1)), 0);
        assert_eq!(at(1, 7, None), 1);
        for _ in 0..3 {
            assert_eq!(at(0, 7, None), 0);
            assert_eq!(at(1, 7, Some(1)), 0);
            assert_eq!(at(0, 7, Some(1)), 1);
            assert_eq!(at(1, 7, None), 1);
        }
        assert_eq!(at(0, 2, None), 2);
        // More than are searched: made again.
        for uv in 2..40 {
            at(0, 2, Some(uv));
        }
        assert!(at(0, 2, None) > 40);
    }
}
