//! Finds out whether two texts of a scene differ in nothing but the numbers of a camera.

use strahl::sdl::{Piece, highlight};

/// Whether a scene that was compiled from `old` is also that of `new`, but for its camera: the texts differ only inside the braces of one
/// `camera` statement outside of all others. What is inside may have no effect elsewhere, so it holds no directives, no calls of functions
/// that have one, and no other number of lines.
pub(crate) fn only_camera(old: &str, new: &str) -> bool {
    if old == new {
        return true;
    }
    let same = |a: &str, b: &str| a.bytes().zip(b.bytes()).take_while(|(a, b)| a == b).count();
    let front = same(old, new);
    let back = old
        .bytes()
        .rev()
        .zip(new.bytes().rev())
        .take(old.len().min(new.len()) - front)
        .take_while(|(a, b)| a == b)
        .count();
    let block = |text: &str| {
        let changed = (front, text.len() - back);
        let mut all = cameras(text).into_iter();
        all.find(|block| block.0 <= changed.0 && changed.1 <= block.1)
    };
    let (Some(a), Some(b)) = (block(old), block(new)) else {
        return false;
    };
    let lines = |text: &str, (from, to): (usize, usize)| text[from..to].matches('\n').count();
    // Places of what stands behind it would change.
    let alone = |text: &str, (_, to): (usize, usize)| {
        let rest = text[to + 1..].lines().next().unwrap_or("").trim();
        rest.is_empty() || rest.starts_with("//")
    };
    a.0 == b.0 && lines(old, a) == lines(new, b) && alone(old, a) && alone(new, b)
}

/// The places between the braces of the `camera` statements that have no effect but a camera.
fn cameras(text: &str) -> Vec<(usize, usize)> {
    let mut found = vec![];
    let (mut at, mut depth) = (0, 0_u32);
    let mut wanted = false;
    // Where a camera begins, and whether it is harmless.
    let mut open: Option<(usize, bool)> = None;
    for (length, piece) in highlight(text) {
        let part = &text[at..at + length];
        match piece {
            Piece::Comment => {}
            Piece::Plain if part.trim().is_empty() => {}
            Piece::Sign => {
                for (offset, sign) in part.char_indices() {
                    match sign {
                        '{' => {
                            if wanted {
                                open = Some((at + offset + 1, true));
                            }
                            depth += 1;
                        }
                        '}' => {
                            depth = depth.saturating_sub(1);
                            if depth == 0
                                && let Some((from, true)) = open.take()
                            {
                                found.push((from, at + offset));
                            }
                        }
                        _ => {}
                    }
                    wanted = false;
                }
            }
            Piece::Directive => {
                open = open.map(|(from, _)| (from, false));
                wanted = false;
            }
            _ => {
                // `rand` moves a stream on; macros may do anything.
                let plain = matches!(piece, Piece::Number | Piece::Block | Piece::Word)
                    || matches!(part, "x" | "y" | "z" | "u" | "v" | "t" | "clock" | "pi");
                let function = matches!(piece, Piece::Function)
                    && !matches!(part, "rand" | "trace" | "inside");
                if !(plain || function) {
                    open = open.map(|(from, _)| (from, false));
                }
                wanted = part == "camera" && depth == 0;
            }
        }
        at += length;
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_camera_alone_is_found_and_nothing_else() {
        let text = |camera: &str, rest: &str| {
            format!("// a camera {{ }}\ncamera {{ {camera} }} // it\nsphere {{ {rest}, 1 }}\n")
        };
        let old = text("location <0, 1, -4> look_at 0", "0");
        assert!(only_camera(&old, &old));
        assert!(only_camera(
            &old,
            &text("location <0, 1, -40> look_at 0", "0")
        ));
        assert!(only_camera(
            &old,
            &text("location 3*z look_at sin(2)*y angle 30", "0")
        ));
        for other in [
            text("location <0, 1, -4> look_at 0", "1"),
            text("location <0, 1, -5> look_at 0", "1"),
            text("location\n<0, 1, -4> look_at 0", "0"),
            text("location <0, 1, -4> look_at 0 } sphere { 0, 2", "0"),
            text("location rand(S) look_at 0", "0"),
            text("location Macro() look_at 0", "0"),
            text("location <0, 1, -4> look_at 0 #declare A = 1;", "0"),
            old.replace("} // it\n", "} "),
            String::new(),
        ] {
            assert!(!only_camera(&old, &other), "{other}");
            assert!(!only_camera(&other, &old), "{other}");
        }
    }
}
