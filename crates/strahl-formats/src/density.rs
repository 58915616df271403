//! Density files (DF3): the values of a grid in the unit cube, as POV-Ray's `density_file` reads them.

use strahl_shade::patterns::{DensityCodes, DensityGrid};

/// Why a density file was not read.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum DensityError {
    /// The file is shorter than its header.
    #[error(
        "the density file has {0} bytes, and its header alone has 6: the numbers of values along x, y and z"
    )]
    NoHeader(usize),
    /// The file's length belongs to no kind of values.
    #[error(
        "a density file of {} by {} by {} values has {lengths} bytes after its header, one, two or four for each of them; \
         this one has {found}", size[0], size[1], size[2]
    )]
    Length {
        /// The numbers of values along x, y and z that the header gives.
        size: [u16; 3],
        /// The lengths that belong to it, in words.
        lengths: String,
        /// The number of bytes after the header.
        found: usize,
    },
}

/// Reads a density file: the numbers of values along x, y and z with 16 bits each, then the values, of which x changes fastest. They have 8, 16
/// or 32 bits, which the length of the file tells; all numbers have their highest byte first.
///
/// # Errors
/// The file's length does not belong to the size in its header.
pub fn decode_density(bytes: &[u8]) -> Result<DensityGrid, DensityError> {
    let Some((header, values)) = bytes.split_first_chunk::<6>() else {
        return Err(DensityError::NoHeader(bytes.len()));
    };
    let [a, b, c, d, e, f] = *header;
    let size = [[a, b], [c, d], [e, f]].map(u16::from_be_bytes);
    let count = size.iter().map(|n| u64::from(*n)).product::<u64>();
    let length = values.len() as u64;
    let codes = if length == count {
        DensityCodes::U8(values.to_vec())
    } else if length == 2 * count {
        let (codes, _) = values.as_chunks::<2>();
        DensityCodes::U16(codes.iter().map(|code| u16::from_be_bytes(*code)).collect())
    } else {
        let (codes, _) = values.as_chunks::<4>();
        DensityCodes::U32(codes.iter().map(|code| u32::from_be_bytes(*code)).collect())
    };
    let known = [1, 2, 4].map(|bytes| bytes * count);
    let grid = known
        .contains(&length)
        .then(|| DensityGrid::try_new(size, codes));
    grid.flatten().ok_or_else(|| DensityError::Length {
        size,
        lengths: format!("{}, {} or {}", known[0], known[1], known[2]),
        found: values.len(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use strahl_math::DVec3;
    use strahl_shade::patterns::DensityInterpolation;

    fn file(values: &[u8]) -> Vec<u8> {
        [&[0, 2, 0, 1, 0, 1], values].concat()
    }

    #[test]
    fn the_length_tells_the_bits_of_the_values() {
        let cases: [(&[u8], [f64; 2]); 4] = [
            (&[100, 200], [100.0 / 255.0, 200.0 / 255.0]),
            (&[100, 200, 50, 60], [25800.0 / 65535.0, 12860.0 / 65535.0]),
            (&[255; 8], [1.0, 1.0]),
            (
                &[0, 0, 0, 1, 128, 0, 0, 0],
                [1.0, 2_147_483_648.0].map(|x| x / 4_294_967_295.0),
            ),
        ];
        for (values, expected) in cases {
            let grid = decode_density(&file(values)).expect("a density file");
            let found = [0.1, 0.9]
                .map(|x| grid.density(DVec3::new(x, 0.1, 0.1), DensityInterpolation::Nearest));
            assert_eq!(found, expected);
        }
        let empty = decode_density(&[0; 6]).expect("a file without values");
        assert_eq!(
            empty.density(DVec3::splat(0.5), DensityInterpolation::Tricubic),
            0.0
        );
    }

    #[test]
    fn other_lengths_are_errors() {
        for bytes in [&[][..], &[0, 1], &[0, 2, 0, 1, 0]] {
            let error = decode_density(bytes).expect_err("too short").to_string();
            assert!(
                error.contains(&format!("has {} bytes", bytes.len())),
                "{error}"
            );
        }
        for values in [&[1][..], &[1, 2, 3], &[1; 5], &[1; 6], &[1; 7], &[1; 9]] {
            let error = decode_density(&file(values))
                .expect_err("another length")
                .to_string();
            assert!(error.contains("2, 4 or 8 bytes"), "{error}");
            assert!(
                error.contains(&format!("this one has {}", values.len())),
                "{error}"
            );
        }
        // 2^48 values, which no file has.
        assert!(decode_density(&[255; 7]).is_err());
    }
}
