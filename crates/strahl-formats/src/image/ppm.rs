//! Portable pixmaps (Netpbm's raw `P6`, or `P5` for grey values): 8 or 16 bit, with the sRGB transfer function every viewer assumes.

use std::io::{self, Write};

use super::png::push_codes;
use super::{BitDepth, Picture, WriteOptions};

pub(super) fn encode(
    writer: &mut dyn Write,
    picture: &Picture<'_>,
    options: &WriteOptions,
) -> io::Result<()> {
    let window = picture.window;
    let largest = match options.bit_depth {
        BitDepth::Eight => u8::MAX.into(),
        BitDepth::Sixteen => u16::MAX,
    };
    let magic = if options.grayscale { "P5" } else { "P6" };
    let comments = picture.comments();
    write!(
        writer,
        "{magic}\n{comments}{} {}\n{largest}\n",
        window.width, window.height
    )?;
    let mut codes = Vec::new();
    for row in picture.rgb.chunks_exact(window.width as usize) {
        codes.clear();
        push_codes(row, options, &mut codes);
        writer.write_all(&codes)?;
    }
    Ok(())
}
