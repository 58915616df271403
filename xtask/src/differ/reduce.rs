//! Delta debugging on the generator's tree (Zeller and Hildebrandt 2002; Misherghi and Su 2006): tries everything that makes a
//! scene smaller, the largest cuts first, and keeps a cut if the finding remains.

use super::node::{Node, Part, Sort, block, list, needed, run, words};
use std::collections::HashSet;

/// Steps from a group to one of its parts, from the root.
type Path = Vec<usize>;

/// Finds a smaller scene for which `fails` still holds. `fails` gets up to `batch` scenes at once, as `write` writes them, and returns for
/// each whether the finding remains; at most `most` scenes are tried. Numbers, which take most of the time, stay as they are if the scene
/// without all that doesn't matter is `enough`.
pub(super) fn reduce(
    scene: &Node,
    batch: usize,
    most: usize,
    write: fn(&Node) -> String,
    enough: impl Fn(&str) -> bool,
    fails: impl FnMut(&[String]) -> Vec<bool>,
) -> Node {
    let mut search = Search {
        smallest: scene.clone(),
        tried: HashSet::from([write(scene)]),
        write,
        left: most,
        batch: batch.max(1),
        fails,
    };
    loop {
        // Cut halves of lists, then single parts, then replace things by simpler ones.
        while [halves as Cuts, without, simpler_things]
            .into_iter()
            .fold(false, |better, cuts| better | search.pass(cuts))
        {}
        if enough(&write(&search.smallest)) || !search.pass(simpler_numbers) {
            return search.smallest;
        }
    }
}

/// Makes all scenes that are smaller by one cut of a kind at a place.
type Cuts = fn(&Node, &[usize], &mut Vec<Node>);

struct Search<F> {
    smallest: Node,
    tried: HashSet<String>,
    left: usize,
    batch: usize,
    write: fn(&Node) -> String,
    fails: F,
}

impl<F: FnMut(&[String]) -> Vec<bool>> Search<F> {
    /// Tries the cuts of one kind at all places, outer ones first; after a successful cut it continues with the next place.
    fn pass(&mut self, cuts: Cuts) -> bool {
        let (mut at, mut better) = (0, false);
        loop {
            let mut paths = vec![];
            collect(&self.smallest, &mut paths);
            let weight = weigh(&self.smallest);
            // A batch of scenes, each with the place of its cut.
            let mut some: Vec<(usize, Node, String)> = vec![];
            let mut place = at;
            while place < paths.len() && some.len() < self.batch {
                let mut found = vec![];
                cuts(&self.smallest, &paths[place], &mut found);
                for node in found.into_iter().filter(|node| weigh(node) < weight) {
                    let text = (self.write)(&node);
                    if self.tried.insert(text.clone()) {
                        some.push((place, node, text));
                    }
                }
                place += 1;
            }
            if some.is_empty() || self.left == 0 {
                return better;
            }
            for chunk in some.chunks(self.batch) {
                let chunk = &chunk[..chunk.len().min(self.left)];
                self.left -= chunk.len();
                let texts: Vec<String> = chunk.iter().map(|(.., text)| text.clone()).collect();
                let stays = (self.fails)(&texts);
                if let Some(index) = stays.iter().position(|stays| *stays) {
                    (at, better) = (chunk[index].0, true);
                    self.smallest = chunk[index].1.clone();
                    break;
                }
                at = place;
            }
        }
    }
}

/// How complicated a scene is. Every step of the reduction makes it smaller, so the reduction ends.
fn weigh(node: &Node) -> usize {
    match node {
        Node::Words(text) => 4 * text.split_whitespace().count(),
        Node::Number(number) => weigh_number(*number),
        Node::Vector(numbers) => 1 + numbers.iter().copied().map(weigh_number).sum::<usize>(),
        Node::Group { head, parts, .. } => {
            let head = if head.is_some() { 8 } else { 0 };
            head + parts.iter().map(|p| 1 + weigh(&p.node)).sum::<usize>()
        }
    }
}

fn weigh_number(number: f64) -> usize {
    match number {
        0.0 => 1,
        1.0 => 2,
        _ => 1 + format!("{number}").len(),
    }
}

/// The paths of all nodes, outer ones first (breadth first).
fn collect(scene: &Node, paths: &mut Vec<Path>) {
    paths.push(vec![]);
    let mut at = 0;
    while at < paths.len() {
        let here = paths[at].clone();
        if let Some(Node::Group { parts, .. }) = find(scene, &here) {
            for index in 0..parts.len() {
                let mut inner = here.clone();
                inner.push(index);
                paths.push(inner);
            }
        }
        at += 1;
    }
}

fn find<'a>(scene: &'a Node, path: &[usize]) -> Option<&'a Node> {
    path.iter().try_fold(scene, |node, index| match node {
        Node::Group { parts, .. } => parts.get(*index).map(|p| &p.node),
        _ => None,
    })
}

/// The scene with the node at this place replaced.
fn replaced(scene: &Node, path: &[usize], node: Node) -> Node {
    let Some((first, rest)) = path.split_first() else {
        return node;
    };
    let mut copy = scene.clone();
    if let Node::Group { parts, .. } = &mut copy
        && let Some(part) = parts.get_mut(*first)
    {
        part.node = replaced(&part.node, rest, node);
    }
    copy
}

fn with_parts(node: &Node, keep: impl Fn(usize, &Part) -> bool) -> Option<Node> {
    let Node::Group { sort, head, parts } = node else {
        return None;
    };
    let kept: Vec<Part> = parts
        .iter()
        .enumerate()
        .filter(|(index, part)| keep(*index, part))
        .map(|(_, part)| part.clone())
        .collect();
    (kept.len() < parts.len()).then(|| Node::Group {
        sort: *sort,
        head: head.clone(),
        parts: kept,
    })
}

/// The node without all of its optional parts, and without either half of them.
fn halves(scene: &Node, path: &[usize], found: &mut Vec<Node>) {
    let Some(node) = find(scene, path) else {
        return;
    };
    let Node::Group { parts, .. } = node else {
        return;
    };
    let free: Vec<usize> = (0..parts.len()).filter(|i| !parts[*i].needed).collect();
    if free.len() < 2 {
        return;
    }
    let middle = free[free.len() / 2];
    let cuts: [&dyn Fn(usize) -> bool; 3] = [&|_| true, &|i| i >= middle, &|i| i < middle];
    for cut in cuts {
        let smaller = with_parts(node, |i, part| part.needed || !cut(i));
        found.extend(smaller.map(|n| replaced(scene, path, n)));
    }
}

/// The node without each of its optional parts.
fn without(scene: &Node, path: &[usize], found: &mut Vec<Node>) {
    let Some((index, parent)) = path.split_last() else {
        return;
    };
    let Some(node) = find(scene, parent) else {
        return;
    };
    let smaller = with_parts(node, |i, part| i != *index || part.needed);
    found.extend(smaller.map(|n| replaced(scene, parent, n)));
}

/// The node replaced by something of the same sort inside it, or by the simplest thing of its sort.
fn simpler_things(scene: &Node, path: &[usize], found: &mut Vec<Node>) {
    let Some(node) = find(scene, path) else {
        return;
    };
    let sort = node.sort();
    if matches!(sort, Sort::Scene | Sort::Other) {
        return;
    }
    let simplest: &[&str] = match sort {
        Sort::Object => {
            // With a vector, which can be nudged: spheres that coincide are another finding.
            let ball = |texture: &str| {
                let parts = vec![needed(list![[0.0; 3], ", 1", texture])];
                block(Sort::Object, "sphere", parts)
            };
            for texture in ["", "pigment { rgb 1 }"] {
                found.push(replaced(scene, path, ball(texture)));
            }
            &[]
        }
        Sort::Texture => &["texture { pigment { rgb 1 } }"],
        Sort::Pigment => &["rgb 1", "rgb x"],
        Sort::Normal => &["bumps"],
        Sort::Color => &["rgb 1", "rgb 0", "rgb x"],
        Sort::Scene | Sort::Other => &[],
    };
    for text in simplest {
        let simple = run(
            sort,
            vec![Part {
                node: words(*text),
                needed: true,
            }],
        );
        found.push(replaced(scene, path, simple));
    }
    let mut inner = vec![];
    collect(node, &mut inner);
    for below in inner.iter().skip(1) {
        if let Some(other) = find(node, below)
            && other.sort() == sort
        {
            found.push(replaced(scene, path, other.clone()));
        }
    }
}

fn simpler_numbers(scene: &Node, path: &[usize], found: &mut Vec<Node>) {
    match find(scene, path) {
        Some(Node::Number(number)) => {
            for simple in simpler(*number) {
                found.push(replaced(scene, path, Node::Number(simple)));
            }
        }
        Some(Node::Vector(numbers)) => {
            let rounded = numbers.iter().map(|n| n.round() + 0.0).collect();
            found.push(replaced(scene, path, Node::Vector(rounded)));
            let short = numbers.iter().map(|n| one_digit(*n)).collect();
            found.push(replaced(scene, path, Node::Vector(short)));
            for (index, number) in numbers.iter().enumerate() {
                let mut simple = simpler(*number);
                // A zero vector would mean something else.
                if numbers.iter().filter(|n| **n != 0.0).count() > 1 {
                    simple.insert(0, 0.0);
                }
                for simple in simple {
                    let mut numbers = numbers.clone();
                    numbers[index] = simple;
                    found.push(replaced(scene, path, Node::Vector(numbers)));
                }
            }
        }
        _ => {}
    }
}

fn one_digit(number: f64) -> f64 {
    // Adding 0 turns -0 into 0.
    (number * 10.0).round() / 10.0 + 0.0
}

/// Simpler numbers than this one. A number other than 0 never becomes 0, because most things of size 0 mean something else.
fn simpler(number: f64) -> Vec<f64> {
    let mut found = vec![1.0, number.round(), 0.5, one_digit(number)];
    found.retain(|n| *n != number && *n != 0.0);
    found
}

#[cfg(test)]
mod tests {
    use super::super::grammar;
    use super::super::node::optional;
    use super::*;

    fn reduced(scene: &Node, fails: impl Fn(&str) -> bool) -> String {
        let all = |texts: &[String]| texts.iter().map(|t| fails(t)).collect();
        reduce(scene, 4, 100_000, Node::text, |_| false, all).text()
    }

    #[test]
    fn what_does_not_matter_goes() {
        for number in 0..40 {
            let scene = grammar::scene(5, number);
            let text = reduced(&scene, |_| true);
            assert!(text.len() < 150 && !text.contains("light"), "{text}");
        }
    }

    #[test]
    fn what_matters_stays() {
        let mut seen = 0;
        for number in 0..200 {
            let scene = grammar::scene(6, number);
            let fails = |text: &str| text.contains("turbulence") && text.contains("sphere {");
            if fails(&scene.text()) {
                seen += 1;
                let text = reduced(&scene, fails);
                assert!(fails(&text) && text.len() < 500, "{text}");
            }
        }
        assert!(seen > 5, "{seen}");
    }

    #[test]
    fn numbers_become_simple_and_inner_things_come_out() {
        let ball = block(
            Sort::Object,
            "sphere",
            vec![needed(list![[0.37, 2.61, -1.0], ",", 1.25])],
        );
        let union = block(
            Sort::Object,
            "union",
            vec![optional(ball), optional(words("hollow"))],
        );
        let scene = run(
            Sort::Scene,
            vec![optional(words("#version 3.7;")), optional(union)],
        );
        // The simplest sphere does not suffice here: the finding is the 2 of 2.61.
        let text = reduced(&scene, |text| text.contains(", 2") || text.contains(", 3,"));
        assert_eq!(text, "sphere { <0, 3, 0>, 1 }\n");
    }

    #[test]
    fn numbers_stay_where_what_is_left_is_enough() {
        let ball = block(
            Sort::Object,
            "sphere",
            vec![
                needed(list![[0.37, 2.61, -1.0], ",", 1.25]),
                optional(words("hollow")),
            ],
        );
        let all = |texts: &[String]| texts.iter().map(|t| t.contains("2.61")).collect();
        let smallest = reduce(&ball, 4, 100_000, Node::text, |_| true, all);
        assert_eq!(smallest.text(), "sphere { <0.37, 2.61, -1>, 1.25 }\n");
    }

    #[test]
    fn the_budget_is_kept() {
        let scene = grammar::scene(7, 1);
        let mut count = 0;
        reduce(
            &scene,
            3,
            20,
            Node::text,
            |_| false,
            |texts| {
                count += texts.len();
                vec![false; texts.len()]
            },
        );
        assert!(count <= 20, "{count}");
    }

    #[test]
    fn the_size_of_a_batch_changes_nothing() {
        let scene = grammar::scene(8, 3);
        let fails = |texts: &[String]| texts.iter().map(|t| t.contains("location")).collect();
        let one = reduce(&scene, 1, 100_000, Node::text, |_| false, fails);
        assert_eq!(
            one,
            reduce(&scene, 7, 100_000, Node::text, |_| false, fails)
        );
    }
}
