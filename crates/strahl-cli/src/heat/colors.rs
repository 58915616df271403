/// The colours from 0 to the maximum, in CIE L*a*b* (D65): equal steps of the value are equal steps of lightness, so that the map
/// is also readable in grey and for colour-blind people.
const ANCHORS: [[f64; 3]; 5] = [
    [4.0, 1.0, -5.0],
    [27.0, 38.0, -36.0],
    [50.0, 56.0, 12.0],
    [73.0, 30.0, 66.0],
    [96.0, -8.0, 30.0],
];

/// The linear Rec. 709 colour of a value from 0 to 1.
pub(crate) fn color(value: f64) -> [f32; 3] {
    let last = ANCHORS.len() - 1;
    let place = value.clamp(0.0, 1.0) * last as f64;
    let index = (place as usize).min(last - 1);
    let part = place - index as f64;
    let (a, b) = (ANCHORS[index], ANCHORS[index + 1]);
    let [l, a, b] = [0, 1, 2].map(|i| a[i] + (b[i] - a[i]) * part);
    let rgb = from_lab(l, a, b);
    rgb.map(|x| x.clamp(0.0, 1.0) as f32)
}

/// CIE 15:2004, with IEC 61966-2-1's matrix.
fn from_lab(l: f64, a: f64, b: f64) -> [f64; 3] {
    const WHITE: [f64; 3] = [0.95047, 1.0, 1.08883];
    let y = (l + 16.0) / 116.0;
    let cube = |t: f64| {
        if t > 6.0 / 29.0 {
            t * t * t
        } else {
            108.0 / 841.0 * (t - 4.0 / 29.0)
        }
    };
    let [x, y, z] = [y + a / 500.0, y, y - b / 200.0].map(cube);
    let [x, y, z] = [x * WHITE[0], y * WHITE[1], z * WHITE[2]];
    [
        3.2404542 * x - 1.5371385 * y - 0.4985314 * z,
        -0.9692660 * x + 1.8760108 * y + 0.0415560 * z,
        0.0556434 * x - 0.2040259 * y + 1.0572252 * z,
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lightness_grows_evenly() {
        for step in 0..=20 {
            let value = f64::from(step) / 20.0;
            let [r, g, b] = color(value).map(f64::from);
            let y = 0.2126729 * r + 0.7151522 * g + 0.0721750 * b;
            let l = if y > 216.0 / 24389.0 {
                116.0 * y.cbrt() - 16.0
            } else {
                y * 24389.0 / 27.0
            };
            // Colours slightly outside of the screen's gamut are clipped.
            assert!((l - (4.0 + 92.0 * value)).abs() < 2.5, "{value}: {l}");
        }
    }
}
