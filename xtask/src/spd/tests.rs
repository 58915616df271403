use super::rings::six_rings;
use super::{KINDS, Kind, run};
use crate::convert;
use std::collections::{HashMap, HashSet};
use std::path::PathBuf;
use strahl::formats::scene::load_path;
use strahl::geometry::{Primitive, Shape};
use strahl::math::DVec3;
use strahl::scene::ObjectKind;

/// A place as bits: the ends of cones and the centres of spheres are to be the same, not just near to each other.
type Place = [u64; 3];

/// The objects of a scene's text.
struct Objects {
    spheres: Vec<(Place, f64)>,
    cones: Vec<[(Place, f64); 2]>,
    text: String,
}

fn kind(name: &str) -> &'static Kind {
    KINDS.iter().find(|kind| kind.name == name).unwrap()
}

fn objects(name: &str, size: u32) -> Objects {
    let text = kind(name).text(size).unwrap();
    let numbers = |line: &str| -> Vec<f64> {
        let numbers: Vec<f64> = line.split(' ').map(|n| n.parse().unwrap()).collect();
        assert!(numbers.iter().all(|n| n.is_finite()), "{line}");
        numbers
    };
    // Zeros of either sign are the same place.
    let end = |n: &[f64]| {
        assert!(n[3] > 0.0);
        ([n[0], n[1], n[2]].map(|x| (x + 0.0).to_bits()), n[3])
    };
    let lines = |word| text.lines().filter_map(move |line| line.strip_prefix(word));
    Objects {
        spheres: lines("s ").map(|line| end(&numbers(line))).collect(),
        cones: lines("c ")
            .map(numbers)
            .map(|n| [end(&n[..4]), end(&n[4..])])
            .collect(),
        text,
    }
}

impl Objects {
    fn lines(&self, word: &str) -> usize {
        self.text.lines().filter(|l| l.starts_with(word)).count()
    }

    /// How many pieces the cones join the places to.
    fn pieces(&self) -> usize {
        let mut near: HashMap<Place, Vec<Place>> = HashMap::new();
        for [(a, _), (b, _)] in &self.cones {
            near.entry(*a).or_default().push(*b);
            near.entry(*b).or_default().push(*a);
        }
        let mut seen = HashSet::new();
        let mut pieces = 0;
        for start in near.keys() {
            pieces += usize::from(!seen.contains(start));
            let mut waiting = vec![*start];
            while let Some(place) = waiting.pop() {
                if seen.insert(place) {
                    waiting.extend(&near[&place]);
                }
            }
        }
        pieces
    }
}

#[test]
fn rings_have_the_published_numbers() {
    for (size, spheres) in [(1, 30), (2, 150), (7, 4200)] {
        let all = objects("rings", size);
        assert_eq!([all.spheres.len(), all.cones.len()], [spheres, spheres]);
        assert_eq!([all.lines("p "), all.lines("l ")], [1, 3]);
        assert_eq!(all.pieces(), spheres / 5);
    }
}

#[test]
fn every_corner_of_a_ring_joins_two_cylinders_in_a_larger_sphere() {
    let all = objects("rings", 3);
    let spheres: HashMap<Place, f64> = all.spheres.iter().copied().collect();
    assert_eq!(spheres.len(), all.spheres.len());
    let mut ends: HashMap<Place, usize> = HashMap::new();
    for cylinder in &all.cones {
        assert!(cylinder[0].1 == cylinder[1].1);
        for (place, radius) in cylinder {
            assert!(*radius < spheres[place]);
            *ends.entry(*place).or_default() += 1;
        }
    }
    assert!(ends.len() == spheres.len() && ends.values().all(|n| *n == 2));
}

#[test]
fn rings_are_linked_and_do_not_touch() {
    let rings = six_rings();
    let edge = |ring: [DVec3; 5], i: usize| (ring[i], ring[(i + 1) % 5]);
    let mut nearest: [f64; 2] = [f64::INFINITY; 2];
    for (a, first) in rings.iter().enumerate() {
        for second in &rings[..a] {
            let mut through = 0;
            for i in 0..5 {
                through += usize::from(passes_through(*first, edge(*second, i)));
                for j in 0..5 {
                    let apart = segments_apart(edge(*first, i), edge(*second, j));
                    nearest[0] = nearest[0].min(apart);
                    for (ring, other) in [(first, second), (second, first)] {
                        let apart = point_apart(ring[i], edge(*other, j));
                        nearest[1] = nearest[1].min(apart);
                    }
                }
            }
            assert_eq!(through, 1, "one edge goes through the other ring");
        }
    }
    // Two cylinders; a sphere and a cylinder.
    let radii = [
        2.0 * super::rings::CYLINDER,
        super::rings::SPHERE + super::rings::CYLINDER,
    ];
    for (nearest, radii) in nearest.iter().zip(radii) {
        assert!(nearest * super::rings::RING > radii * 1.05, "{nearest}");
    }
    // Neighbouring objects, which are at a distance of one.
    const { assert!(super::rings::RING + super::rings::SPHERE < 0.5) };
}

/// Whether a segment goes through the inside of a regular pentagon around the origin.
fn passes_through(ring: [DVec3; 5], (a, b): (DVec3, DVec3)) -> bool {
    let axis = ring[0].cross(ring[1]).normalize();
    let (from, to) = (a.dot(axis), b.dot(axis));
    let crossing = a + (b - a) * (from / (from - to));
    let inside = |i: usize| {
        let middle = (ring[i] + ring[(i + 1) % 5]) * 0.5;
        crossing.dot(middle) < middle.dot(middle)
    };
    from * to < 0.0 && (0..5).all(inside)
}

fn point_apart(p: DVec3, (a, b): (DVec3, DVec3)) -> f64 {
    let t = (p - a).dot(b - a) / (b - a).dot(b - a);
    (a + (b - a) * t.clamp(0.0, 1.0)).distance(p)
}

fn segments_apart((a, b): (DVec3, DVec3), other: (DVec3, DVec3)) -> f64 {
    let places = (0..=200).map(|i| a + (b - a) * (f64::from(i) / 200.0));
    places
        .map(|p| point_apart(p, other))
        .fold(f64::INFINITY, f64::min)
}

#[test]
fn the_rings_corners_are_the_middles_of_a_dodecahedrons_edges() {
    let rings = six_rings();
    let corners: Vec<DVec3> = rings.iter().flatten().copied().collect();
    for (i, corner) in corners.iter().enumerate() {
        assert!((corner.length() - 1.0).abs() < 1e-12);
        // Nearest are the four middles of the edges that share a corner with it, 36 degrees away.
        let others = corners.iter().enumerate().filter(|(j, _)| *j != i);
        let cosines: Vec<f64> = others.map(|(_, other)| corner.dot(*other)).collect();
        let near = cosines
            .iter()
            .filter(|c| (*c - 36_f64.to_radians().cos()).abs() < 1e-12);
        assert_eq!(near.count(), 4);
        assert!(cosines.iter().all(|c| *c < 0.81));
    }
}

#[test]
fn a_tree_has_the_published_numbers_and_grows_from_its_trunk() {
    for (size, branches) in [(0, 1), (3, 15), (11, 4095)] {
        let all = objects("tree", size);
        assert_eq!([all.spheres.len(), all.cones.len()], [branches, branches]);
        assert_eq!([all.lines("p "), all.lines("l ")], [1, 7]);
        assert_eq!(all.pieces(), 1);
        let spheres: HashMap<Place, f64> = all.spheres.iter().copied().collect();
        assert_eq!(spheres.len(), branches);
        let mut children: HashMap<Place, usize> = HashMap::new();
        for [(base, base_radius), (end, end_radius)] in &all.cones {
            assert!(base_radius > end_radius && spheres[end] >= *end_radius);
            *children.entry(*base).or_default() += 1;
            if *base != [0; 3] {
                assert!(*base_radius < spheres[base]);
            }
        }
        assert_eq!(children.remove(&[0; 3]), Some(1));
        assert!(children.values().all(|n| *n == 2));
        assert_eq!(children.len(), branches / 2);
    }
}

#[test]
fn a_lattice_is_joined_along_all_edges() {
    for size in [1, 2, 12] {
        let all = objects("lattice", size);
        let side = size as usize + 1;
        assert_eq!(all.spheres.len(), side.pow(3));
        assert_eq!(all.cones.len(), 3 * size as usize * side.pow(2));
        assert_eq!(all.pieces(), 1);
        let spheres: HashMap<Place, f64> = all.spheres.iter().copied().collect();
        assert_eq!(spheres.len(), all.spheres.len());
        for (place, radius) in all.cones.iter().flatten() {
            assert!(*radius < spheres[place]);
        }
    }
}

#[test]
fn strahl_reads_every_scene_without_a_word() {
    let folder = tempfile::tempdir().unwrap();
    for (kind, open) in KINDS.iter().zip([4200, 4095, 6084]) {
        let path = kind.write_usual(folder.path()).unwrap();
        let loaded = load_path(&path, None);
        assert!(loaded.diagnostics.is_empty(), "{}", kind.name);
        let (mut cones, mut cylinders) = (0, 0);
        for object in &loaded.scene.unwrap().objects.0 {
            let ObjectKind::Shape(shape) = &object.kind else {
                panic!("not a plain shape");
            };
            shape.validate().unwrap();
            match shape {
                Shape::Cone(c) => cones += usize::from(!c.is_capped()),
                Shape::Cylinder(c) => cylinders += usize::from(!c.is_capped()),
                _ => {}
            }
        }
        let expected = if kind.name == "tree" {
            [open, 0]
        } else {
            [0, open]
        };
        assert_eq!([cones, cylinders], expected);
    }
}

#[test]
fn cones_and_cylinders_are_converted_one_by_one_and_stay_open() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    let count = |path: PathBuf, start: &str, end: &str| {
        let text = std::fs::read_to_string(path).unwrap();
        text.lines()
            .filter(|l| l.starts_with(start) && l.contains(end))
            .count()
    };
    for (name, size, word, open) in [("rings", 1, "cylinder {", 30), ("tree", 2, "cone {", 7)] {
        let scene = at("scene.nff");
        kind(name).write(size, &scene).unwrap();
        convert::to_pov(&scene, &at("scene.pov")).unwrap();
        assert_eq!(count(at("scene.pov"), word, " open "), open);
        assert_eq!(count(at("scene.pov"), "sphere {", ""), open);
        let for_tachyon = convert::to_dat(&scene, &at("scene.dat"));
        // Tachyon has no cones.
        assert_eq!(for_tachyon.is_ok(), name == "rings");
    }
    assert_eq!(count(at("scene.dat"), "FCylinder ", ""), 30);
}

#[test]
fn bad_arguments_are_explained() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name).display().to_string();
    let (good, bad) = (path("scene.nff"), path("scene.txt"));
    let cases: [(&[&str], &str); 9] = [
        (&[], "expected a scene and its size"),
        (&["rings", "-o", &good], "expected a scene and its size"),
        (&["rings", "2"], "-o FILE.nff"),
        (&["rings", "2", "-o"], "-o needs a value"),
        (&["rings", "two", "-o", &good], "found `two`"),
        (&["rings", "0", "-o", &good], "from 1 to 58, found 0"),
        (&["tree", "21", "-o", &good], "from 0 to 20, found 21"),
        (&["cube", "2", "-o", &good], "rings|tree|lattice"),
        (&["tree", "2", "-o", &bad], ".nff or .nff.gz"),
    ];
    for (args, expected) in cases {
        let error = run(args).unwrap_err().to_string();
        assert!(error.contains(expected), "{args:?}: {error}");
    }
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
    run(&["tree", "2", "-o", &good]).unwrap();
    run(&["tree", "2", "-o", &path("scene.nff.gz")]).unwrap();
    let [plain, packed] = ["scene.nff", "scene.nff.gz"].map(|name| folder.path().join(name));
    let unpacked = strahl::formats::scene::read_decompressed(&packed).unwrap();
    assert_eq!(std::fs::read(plain).unwrap(), unpacked);
}
