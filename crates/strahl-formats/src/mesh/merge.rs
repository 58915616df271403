use super::builder::{MeshBuilder, MeshParts, VertexKey};
use hashbrown::hash_table::Entry;
use hashbrown::{DefaultHashBuilder, HashTable};
use rayon::prelude::*;
use std::hash::{BuildHasher, Hash};
use std::sync::Arc;
use strahl_geometry::{GeometryError, TriangleMesh};

/// Keys are looked up in this many tables, so that each of them stays in the cache.
const SHARDS: usize = 128;

/// A mesh in pieces, read by several threads. Vertices of different pieces with the same key are merged.
#[derive(Debug)]
pub(crate) struct MeshPieces<K>(Vec<MeshBuilder<K>>);

impl<K> Default for MeshPieces<K> {
    fn default() -> Self {
        Self(vec![])
    }
}

impl<K: VertexKey> MeshPieces<K> {
    /// Adds the next piece.
    pub(crate) fn push(&mut self, piece: MeshBuilder<K>) {
        if !piece.triangles.is_empty() {
            self.0.push(piece);
        }
    }

    /// The line of the first triangle and the mesh, if there is any triangle: as if one builder had been given all of
    /// them, whatever the number of threads.
    pub(crate) fn finish(self) -> Option<(u32, Result<Arc<TriangleMesh>, GeometryError>)> {
        let Self(mut pieces) = self;
        let vertices: usize = pieces.iter().map(|piece| piece.vertices.len()).sum();
        if u32::try_from(vertices).is_err() {
            let problem = GeometryError::IndexOutOfRange {
                what: "vertex",
                index: vertices as u64 - 1,
                count: u64::from(u32::MAX),
            };
            return Some((*pieces.first()?.lines.first()?, Err(problem)));
        }
        let (vertices, triangles, lines) = match pieces.len() {
            0 | 1 => {
                let piece = pieces.pop()?;
                (piece.vertices, piece.triangles, piece.lines)
            }
            _ => merged(pieces),
        };
        let mut parts = MeshParts {
            triangles,
            lines,
            ..MeshParts::default()
        };
        for vertex in vertices {
            parts.push(vertex.vertex());
        }
        parts.finish()
    }
}

/// The vertices, triangles and lines of the mesh.
fn merged<K: VertexKey>(pieces: Vec<MeshBuilder<K>>) -> (Vec<K>, Vec<[u32; 3]>, Vec<u32>) {
    let Numbers { of_pieces, starts } = Numbers::new(&pieces);
    let mut triangles = vec![[0; 3]; pieces.iter().map(|p| p.triangles.len()).sum()];
    slices(&mut triangles, pieces.iter().map(|p| p.triangles.len()))
        .into_par_iter()
        .zip(&pieces)
        .zip(&of_pieces)
        .for_each(|((places, piece), numbers)| {
            for (place, triangle) in places.iter_mut().zip(&piece.triangles) {
                *place = triangle.map(|vertex| numbers[vertex as usize]);
            }
        });
    let vertices = pieces
        .iter()
        .zip(&of_pieces)
        .zip(&starts)
        .flat_map(|((piece, numbers), start)| {
            let vertices = piece.vertices.iter().zip(numbers);
            vertices.filter(move |(_, number)| *number >= start)
        })
        .map(|(vertex, _)| *vertex)
        .collect();
    let lines = pieces.iter().flat_map(|p| &p.lines).copied().collect();
    (vertices, triangles, lines)
}

/// The mesh's number of each vertex of the pieces. Vertices that occur in a piece first are numbered in their order.
struct Numbers {
    /// By piece and vertex.
    of_pieces: Vec<Vec<u32>>,
    /// The first number that each piece adds, and how many there are.
    starts: Vec<u32>,
}

impl Numbers {
    fn new<K: VertexKey>(pieces: &[MeshBuilder<K>]) -> Self {
        // Vertices are first told by their places among those of all pieces.
        let places = sums(pieces.iter().map(|piece| piece.vertices.len() as u32));
        let mut firsts = first_places(pieces, &places);
        let new: Vec<u32> = firsts
            .par_iter()
            .zip(&places)
            .map(|(firsts, start)| {
                let own = firsts.iter().zip(*start..);
                own.filter(|(first, own)| **first == *own).count() as u32
            })
            .collect();
        let starts = sums(new.into_iter());
        let mut numbers = vec![0; places.last().map_or(0, |count| *count as usize)];
        slices(&mut numbers, firsts.iter().map(Vec::len))
            .into_par_iter()
            .zip(&firsts)
            .zip(&places)
            .zip(&starts)
            .for_each(|(((numbers, firsts), place), start)| {
                let mut next = *start;
                for ((number, first), own) in numbers.iter_mut().zip(firsts).zip(*place..) {
                    if *first == own {
                        *number = next;
                        next += 1;
                    }
                }
            });
        firsts.par_iter_mut().for_each(|firsts| {
            for first in firsts {
                *first = numbers[*first as usize];
            }
        });
        Self {
            of_pieces: firsts,
            starts,
        }
    }
}

/// By piece and vertex: the place of the first vertex with the same key. `places` are those of each piece's first vertex.
fn first_places<K: VertexKey>(pieces: &[MeshBuilder<K>], places: &[u32]) -> Vec<Vec<u32>> {
    let hasher = DefaultHashBuilder::default();
    let sorted: Vec<Sorted<K>> = pieces
        .par_iter()
        .map(|piece| Sorted::new(&piece.vertices, &hasher))
        .collect();
    let found: Vec<Vec<Vec<u32>>> = (0..SHARDS)
        .into_par_iter()
        .map(|shard| {
            let mut known: HashTable<(K, u32)> = HashTable::new();
            let mut find = |(key, vertex): &(K, u32), start: u32| {
                let entry = known.entry(
                    hasher.hash_one(key),
                    |(known, _)| known == key,
                    |(known, _)| hasher.hash_one(known),
                );
                match entry {
                    Entry::Occupied(found) => found.get().1,
                    Entry::Vacant(free) => free.insert((*key, start + vertex)).get().1,
                }
            };
            sorted
                .iter()
                .zip(places)
                .map(|(piece, start)| piece.shard(shard).iter().map(|v| find(v, *start)).collect())
                .collect()
        })
        .collect();
    sorted
        .par_iter()
        .enumerate()
        .map(|(piece, sorted)| {
            let mut firsts = vec![0; sorted.vertices.len()];
            for (shard, found) in found.iter().enumerate() {
                for ((_, vertex), first) in sorted.shard(shard).iter().zip(&found[piece]) {
                    firsts[*vertex as usize] = *first;
                }
            }
            firsts
        })
        .collect()
}

/// The keys of a piece with its vertices, by shards, each of them in the order of the piece.
struct Sorted<K> {
    vertices: Vec<(K, u32)>,
    /// Where each shard begins, and the end.
    starts: Vec<u32>,
}

impl<K: Copy + Hash> Sorted<K> {
    fn new(keys: &[K], hasher: &DefaultHashBuilder) -> Self {
        // The table of a shard tells its keys apart by the lowest and the highest bits.
        let shard = |key: &K| (hasher.hash_one(key) >> 32) as usize % SHARDS;
        let mut counts = [0u32; SHARDS];
        for key in keys {
            counts[shard(key)] += 1;
        }
        let starts = sums(counts.into_iter());
        let Some(first) = keys.first() else {
            let vertices = vec![];
            return Self { vertices, starts };
        };
        let mut next = starts.clone();
        let mut vertices = vec![(*first, 0); keys.len()];
        for (key, vertex) in keys.iter().zip(0..) {
            let place = &mut next[shard(key)];
            vertices[*place as usize] = (*key, vertex);
            *place += 1;
        }
        Self { vertices, starts }
    }

    fn shard(&self, shard: usize) -> &[(K, u32)] {
        &self.vertices[self.starts[shard] as usize..self.starts[shard + 1] as usize]
    }
}

/// 0, and the sums of the first one, two, ... numbers.
fn sums(numbers: impl Iterator<Item = u32>) -> Vec<u32> {
    let add = |sum: &mut u32, n| {
        *sum += n;
        Some(*sum)
    };
    std::iter::once(0).chain(numbers.scan(0, add)).collect()
}

/// Slices of these lengths, one behind the other.
fn slices<T>(mut rest: &mut [T], lengths: impl Iterator<Item = usize>) -> Vec<&mut [T]> {
    lengths
        .map(|length| {
            let (slice, others) = std::mem::take(&mut rest).split_at_mut(length);
            rest = others;
            slice
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::Vertex;
    use strahl_math::DVec3;

    /// Triangles with corners from a small box of whole numbers, always the same.
    fn triangles(count: usize) -> Vec<[DVec3; 3]> {
        let mut state = 1u64;
        let mut number = move || {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1);
            (state >> 60) as f64
        };
        let mut corner = move || DVec3::new(number(), number(), number());
        (0..count).map(|_| [corner(), corner(), corner()]).collect()
    }

    #[derive(Clone, Copy, PartialEq, Eq, Hash)]
    struct Key([u64; 3]);

    impl VertexKey for Key {
        fn vertex(self) -> Vertex {
            let position = DVec3::from(self.0.map(f64::from_bits));
            let normal = Some(position.normalize_or(DVec3::X));
            Vertex {
                normal,
                ..Vertex::at(position)
            }
        }
    }

    fn add(mesh: &mut MeshBuilder<Key>, corners: [DVec3; 3], line: u32) {
        let corners = corners.map(|p| Key(p.to_array().map(f64::to_bits)));
        mesh.triangle(corners, line);
    }

    #[test]
    fn pieces_become_the_mesh_that_one_builder_makes() {
        let all = triangles(5000);
        let mut one = MeshBuilder::default();
        for (corners, line) in all.iter().zip(1..) {
            add(&mut one, *corners, line);
        }
        let mut pieces = MeshPieces::default();
        pieces.push(one);
        let expected = pieces.finish().expect("triangles");
        assert!(
            expected
                .1
                .as_ref()
                .is_ok_and(|m| m.positions().len() < 4096)
        );
        for size in [1, 7, 500, 4999, 5000] {
            let mut pieces = MeshPieces::default();
            let mut line = 0;
            for part in all.chunks(size) {
                let mut piece = MeshBuilder::default();
                for corners in part {
                    line += 1;
                    add(&mut piece, *corners, line);
                }
                pieces.push(piece);
                pieces.push(MeshBuilder::default());
            }
            assert_eq!(pieces.finish(), Some(expected.clone()), "{size}");
        }
    }

    #[test]
    fn nothing_is_no_mesh() {
        assert!(MeshPieces::<Key>::default().finish().is_none());
    }
}
