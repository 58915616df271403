use super::{MOST_ALONG, MOST_CELLS};
use strahl_math::DVec3;

/// The number of cells along each axis: about as many as wanted in total, as cubic as the box allows, none smaller than
/// `smallest`.
pub(super) fn cubic(size: DVec3, wanted: f64, smallest: f64) -> [u32; 3] {
    let most = MOST_CELLS as f64;
    let wanted = if wanted < most { wanted } else { most };
    let mut count = [1.0; 3];
    let mut open = [true; 3];
    // If the box is too flat for a second layer of cells along an axis, the other axes get all of them.
    loop {
        let axes: Vec<usize> = (0..3).filter(|axis| open[*axis]).collect();
        let volume: f64 = axes.iter().map(|axis| size[*axis]).product();
        let density = match axes.len() {
            0 => break,
            1 => wanted / volume,
            2 => (wanted / volume).sqrt(),
            _ => (wanted / volume).cbrt(),
        };
        let flat = axes.iter().copied().find(|axis| {
            let cells = size[*axis] * density;
            !(cells >= 1.5 && size[*axis] >= 2.0 * smallest)
        });
        if let Some(axis) = flat {
            open[axis] = false;
            continue;
        }
        for axis in axes {
            count[axis] = (size[axis] * density).round();
        }
        break;
    }
    [0, 1, 2].map(|axis| {
        let most = (size[axis] / smallest).floor();
        let n = if count[axis] < most {
            count[axis]
        } else {
            most
        };
        // Conversions saturate.
        (n as u32).clamp(1, MOST_ALONG)
    })
}
