//! The legend below a heat map: its colours with their values, and a title.

use super::color;

/// The number of rows of the legend.
pub(crate) const LEGEND_ROWS: u32 = 40;

/// Edge of a dot of a letter in pixels.
const DOT: u32 = 2;

/// Letters of 3 x 5 dots, row by row from the top, three bits (an octal digit) each.
const LETTERS: [(char, u16); 40] = [
    ('0', 0o75557),
    ('1', 0o26227),
    ('2', 0o71747),
    ('3', 0o71717),
    ('4', 0o55711),
    ('5', 0o74717),
    ('6', 0o74757),
    ('7', 0o71122),
    ('8', 0o75757),
    ('9', 0o75717),
    ('A', 0o25755),
    ('B', 0o65656),
    ('C', 0o34443),
    ('D', 0o65556),
    ('E', 0o74647),
    ('F', 0o74644),
    ('G', 0o34553),
    ('H', 0o55755),
    ('I', 0o72227),
    ('J', 0o11152),
    ('K', 0o55655),
    ('L', 0o44447),
    ('M', 0o57755),
    ('N', 0o65555),
    ('O', 0o25552),
    ('P', 0o65644),
    ('Q', 0o25573),
    ('R', 0o65655),
    ('S', 0o34216),
    ('T', 0o72222),
    ('U', 0o55557),
    ('V', 0o55552),
    ('W', 0o55775),
    ('X', 0o55255),
    ('Y', 0o55222),
    ('Z', 0o71247),
    ('.', 0o00002),
    ('-', 0o00700),
    ('/', 0o11244),
    (':', 0o02020),
];

/// The rows of a legend: the colours from 0 to `max`, the values at both ends and in the middle, and the title.
pub(crate) fn legend(width: u32, max: f64, title: &str) -> Vec<[f32; 3]> {
    let mut pixels = vec![[0.0; 3]; (width * LEGEND_ROWS) as usize];
    let margin = 8.min(width / 4);
    let bar = (width - 2 * margin).max(1);
    for x in 0..bar {
        let shade = color(f64::from(x) / f64::from((bar - 1).max(1)));
        for y in 4..14 {
            pixels[(y * width + margin + x) as usize] = shade;
        }
    }
    let mut canvas = Canvas { pixels, width };
    let labels = [(0.0, 0.0), (0.5, max / 2.0), (1.0, max)];
    for (place, value) in labels {
        let text = number(value);
        let room = f64::from(bar) - f64::from(extent(&text));
        let x = margin + (room.max(0.0) * place) as u32;
        canvas.text(x, 16, &text);
    }
    canvas.text(margin, 28, title);
    canvas.pixels
}

/// A number with few digits, because space is short.
fn number(value: f64) -> String {
    let (value, unit) = match value {
        v if v >= 1e6 => (v / 1e6, "M"),
        v if v >= 1e4 => (v / 1e3, "K"),
        v => (v, ""),
    };
    let text = if value >= 100.0 || value.fract() == 0.0 {
        format!("{value:.0}")
    } else {
        format!("{value:.1}")
    };
    text + unit
}

/// Width of a text in pixels.
fn extent(text: &str) -> u32 {
    4 * DOT * text.len() as u32
}

struct Canvas {
    pixels: Vec<[f32; 3]>,
    width: u32,
}

impl Canvas {
    /// Draws a text as far as it fits.
    fn text(&mut self, x: u32, y: u32, text: &str) {
        for (place, letter) in text.to_uppercase().chars().enumerate() {
            let found = LETTERS.iter().find(|(l, _)| *l == letter);
            let Some((_, dots)) = found else { continue };
            let left = x + 4 * DOT * place as u32;
            for dot in 0..15 {
                if dots >> (14 - dot) & 1 == 1 {
                    self.dot(left + dot % 3 * DOT, y + dot / 3 * DOT);
                }
            }
        }
    }

    fn dot(&mut self, x: u32, y: u32) {
        for (dx, dy) in [(0, 0), (1, 0), (0, 1), (1, 1)] {
            let (x, y) = (x + dx, y + dy);
            if x < self.width && y < LEGEND_ROWS {
                self.pixels[(y * self.width + x) as usize] = [1.0; 3];
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short() {
        let texts = [0.0, 2.5, 17.0, 1234.0, 12345.0, 2.5e6].map(number);
        assert_eq!(texts, ["0", "2.5", "17", "1234", "12.3K", "2.5M"]);
    }

    #[test]
    fn a_legend_fits_any_width() {
        for width in [1, 2, 3, 40, 640] {
            let pixels = legend(width, 1000.0, "tests per pixel: octree");
            assert_eq!(pixels.len(), (width * LEGEND_ROWS) as usize);
        }
        let white = legend(640, 7.0, "tests")
            .iter()
            .filter(|p| **p == [1.0; 3])
            .count();
        assert!(white > 200, "{white}");
    }
}
