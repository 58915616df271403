use std::fmt::Write;

/// Lines of a scene's text are broken before this length where possible.
const WIDTH: usize = 100;

/// The sort of a part: parts of the same sort can replace each other.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Sort {
    /// The whole scene: a list of statements.
    Scene,
    /// An object with its braces.
    Object,
    /// `texture { }`
    Texture,
    /// The inside of `pigment { }`, or an entry of a pigment map.
    Pigment,
    /// The inside of `normal { }`, or an entry of a normal map.
    Normal,
    /// A colour.
    Color,
    /// Anything else.
    Other,
}

/// A part of a scene.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Node {
    /// Literal words.
    Words(String),
    Number(f64),
    /// Numbers in angle brackets.
    Vector(Vec<f64>),
    /// A list of parts; with a `head`, that word comes first and the parts are in braces.
    Group {
        sort: Sort,
        head: Option<String>,
        parts: Vec<Part>,
    },
}

/// A node within a group.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Part {
    pub(super) node: Node,
    /// Whether the group is invalid without this part.
    pub(super) needed: bool,
}

pub(super) fn words(text: impl Into<String>) -> Node {
    Node::Words(text.into())
}

/// `head { parts }`
pub(super) fn block(sort: Sort, head: impl Into<String>, parts: Vec<Part>) -> Node {
    let head = Some(head.into());
    Node::Group { sort, head, parts }
}

/// Parts one after the other, without braces.
pub(super) fn run(sort: Sort, parts: Vec<Part>) -> Node {
    let head = None;
    Node::Group { sort, head, parts }
}

pub(super) fn needed(node: Node) -> Part {
    Part { node, needed: true }
}

pub(super) fn optional(node: Node) -> Part {
    Part {
        node,
        needed: false,
    }
}

/// A list of words, numbers and vectors that belong together: `list![words("scale"), number]`.
macro_rules! list {
    ($($node:expr),* $(,)?) => {
        $crate::differ::node::run(
            $crate::differ::node::Sort::Other,
            vec![$($crate::differ::node::needed($crate::differ::node::Node::from($node))),*],
        )
    };
}
pub(super) use list;

impl From<&str> for Node {
    fn from(text: &str) -> Self {
        Self::Words(text.to_owned())
    }
}

impl From<String> for Node {
    fn from(text: String) -> Self {
        Self::Words(text)
    }
}

impl From<f64> for Node {
    fn from(number: f64) -> Self {
        Self::Number(number)
    }
}

impl<const N: usize> From<[f64; N]> for Node {
    fn from(vector: [f64; N]) -> Self {
        Self::Vector(vector.to_vec())
    }
}

impl Node {
    pub(super) fn sort(&self) -> Sort {
        match self {
            Self::Group { sort, .. } => *sort,
            _ => Sort::Other,
        }
    }

    /// The same with every coordinate changed by some ten-thousandths, so that no surfaces, borders of blocks or points coincide any more.
    /// Colours and whole numbers stay.
    pub(super) fn nudged(&self) -> Self {
        let mut count = 0;
        self.nudged_from(&mut count)
    }

    fn nudged_from(&self, count: &mut u32) -> Self {
        let mut moved = |x: f64| {
            *count += 1;
            // 1 to 7 steps up or down, by turns.
            let steps = [3.0, -5.0, 1.0, 7.0, -2.0, 6.0, -1.0, -7.0, 4.0, 2.0, -3.0];
            x + 1e-4 * steps[*count as usize % steps.len()]
        };
        match self {
            Self::Words(_) => self.clone(),
            Self::Group {
                sort: Sort::Color, ..
            } => self.clone(),
            Self::Number(number) if number.fract() == 0.0 => self.clone(),
            Self::Number(number) => Self::Number(moved(*number)),
            Self::Vector(numbers) => Self::Vector(numbers.iter().map(|x| moved(*x)).collect()),
            Self::Group { sort, head, parts } => Self::Group {
                sort: *sort,
                head: head.clone(),
                parts: parts
                    .iter()
                    .map(|part| Part {
                        node: part.node.nudged_from(count),
                        needed: part.needed,
                    })
                    .collect(),
            },
        }
    }

    /// The scene's text.
    pub(super) fn text(&self) -> String {
        match self {
            Self::Group {
                sort: Sort::Scene,
                parts,
                ..
            } => parts
                .iter()
                .map(|p| p.node.lines(0) + "\n")
                .collect::<String>(),
            _ => self.lines(0) + "\n",
        }
    }

    /// The text in one line.
    fn flat(&self) -> String {
        match self {
            Self::Words(text) => text.clone(),
            Self::Number(number) => decimal(*number),
            Self::Vector(numbers) => {
                let numbers: Vec<String> = numbers.iter().map(|n| decimal(*n)).collect();
                format!("<{}>", numbers.join(", "))
            }
            Self::Group { head, parts, .. } => {
                let texts = parts.iter().map(|p| p.node.flat());
                let mut inner = String::new();
                for text in texts.filter(|t| !t.is_empty()) {
                    if !inner.is_empty() && !text.starts_with(',') {
                        inner.push(' ');
                    }
                    inner.push_str(&text);
                }
                match head {
                    Some(head) => format!("{head} {{ {inner} }}"),
                    None => inner,
                }
            }
        }
    }

    /// The text in one line if it fits, or else with a line for every part.
    fn lines(&self, indent: usize) -> String {
        let flat = self.flat();
        let lead = "  ".repeat(indent);
        let Self::Group { head, parts, .. } = self else {
            return lead + &flat;
        };
        if lead.len() + flat.len() <= WIDTH || !self.has_block() {
            return lead + &flat;
        }
        let mut out = String::new();
        let inner = match head {
            Some(head) => {
                let _ = writeln!(out, "{lead}{head} {{");
                indent + 1
            }
            None => indent,
        };
        // A part without braces stays on the line of the part before it.
        let mut short = String::new();
        let lead_inner = "  ".repeat(inner);
        let flush = |short: &mut String, out: &mut String| {
            if !short.is_empty() {
                let _ = writeln!(out, "{lead_inner}{short}");
                short.clear();
            }
        };
        for part in parts {
            let text = part.node.flat();
            if part.node.has_block() && text.len() > WIDTH / 2 {
                flush(&mut short, &mut out);
                out.push_str(&part.node.lines(inner));
                out.push('\n');
            } else if !text.is_empty() {
                if !short.is_empty() && !text.starts_with(',') {
                    short.push(' ');
                }
                short.push_str(&text);
            }
        }
        flush(&mut short, &mut out);
        match head {
            Some(_) => out.push_str(&format!("{lead}}}")),
            None => out.truncate(out.trim_end().len()),
        }
        out
    }

    fn has_block(&self) -> bool {
        match self {
            Self::Group { head, parts, .. } => {
                head.is_some() || parts.iter().any(|p| p.node.has_block())
            }
            _ => false,
        }
    }
}

/// A number without the noise of its last binary digits.
fn decimal(number: f64) -> String {
    // Adding 0 turns -0 into 0.
    ((number * 1e9).round() / 1e9 + 0.0).to_string()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scenes_are_printed_with_commas_and_braces() {
        let ball = block(
            Sort::Object,
            "sphere",
            vec![
                needed(list![[0.0, 1.5, -2.0], ",", 1.0]),
                optional(list!["scale", 0.5]),
            ],
        );
        let scene = run(
            Sort::Scene,
            vec![needed(words("#version 3.7;")), optional(ball)],
        );
        assert_eq!(
            scene.text(),
            "#version 3.7;\nsphere { <0, 1.5, -2>, 1 scale 0.5 }\n"
        );
    }

    #[test]
    fn nudging_moves_coordinates_but_neither_colours_nor_whole_numbers() {
        let scene = list![
            [0.0, 1.5, -2.0],
            0.5,
            3.0,
            run(Sort::Color, vec![needed(list!["rgb", [1.0, 0.0, 0.5]])])
        ];
        let text = scene.nudged().text();
        assert_eq!(
            text,
            "<-0.0005, 1.5001, -1.9993> 0.4998 3 rgb <1, 0, 0.5>\n"
        );
    }

    #[test]
    fn long_lines_are_broken_at_blocks() {
        let ball = |n: f64| {
            let parts = vec![needed(list![
                [n, n, n],
                ",",
                1.25,
                "scale <0.125, 0.125, 0.125>"
            ])];
            optional(block(Sort::Object, "sphere", parts))
        };
        let union = block(
            Sort::Object,
            "union",
            vec![ball(0.125), ball(0.25), optional(words("hollow"))],
        );
        let expected = "union {\n  sphere { <0.125, 0.125, 0.125>, 1.25 scale <0.125, 0.125, 0.125> }\n  \
                        sphere { <0.25, 0.25, 0.25>, 1.25 scale <0.125, 0.125, 0.125> }\n  hollow\n}\n";
        assert_eq!(union.text(), expected);
    }
}
