//! The settings of POV-Ray's switches and keys, and the options of strahl that do the same.

use super::ini;
use super::keys::{COMMANDS, IGNORED, KEYS, LEFT_OUT, NUMBERS, spelled};
use crate::input::DEFAULT_SIZE;
use std::ffi::OsString;
use std::path::{Path, PathBuf};
use strahl::Format;
use strahl::formats::image::ImageFormat;

/// The settings so far; later ones override earlier ones.
#[derive(Debug, Default)]
pub(super) struct Settings {
    /// The scene; empty if there is none.
    pub(super) input: String,
    /// Whether the scene's file is in POV-Ray's language, although its name doesn't tell.
    pub(super) is_pov: bool,
    /// The .ini files that are being read: each one includes the next.
    pub(super) open: Vec<PathBuf>,
    /// Notes on settings that will have no effect.
    pub(super) notes: Vec<String>,
    width: Option<u32>,
    height: Option<u32>,
    antialias: Option<bool>,
    threshold: Option<f64>,
    recursive: bool,
    antialias_gamma: Option<f64>,
    depth: Option<u32>,
    output: Option<String>,
    file_type: Option<char>,
    bits: Option<u32>,
    grayscale: bool,
    no_output: bool,
    columns: Range,
    rows: Range,
    threads: Option<u32>,
    library: Vec<String>,
    declare: Vec<String>,
    version: Option<f64>,
    header: Option<String>,
    /// The quality of JPEG.
    jpeg_quality: Option<u8>,
    /// The level of `+Q`.
    quality: Option<u32>,
    alpha: bool,
    resume: bool,
    cyclic: bool,
    initial_frame: Option<u32>,
    final_frame: Option<u32>,
    /// Options of clocks, subset and step with their values as written.
    times: Vec<(&'static str, String)>,
}

/// First and last column or row, as numbers from 1 or as fractions.
#[derive(Clone, Copy, Debug, Default)]
struct Range {
    start: Option<f64>,
    end: Option<f64>,
}

impl Range {
    /// Position and length in pixels. Fractions are rounded down; a start of 1 is the first pixel, an end of 1 is 100 %.
    fn pixels(self, size: u32, what: &str) -> Result<(u32, u32), String> {
        let all = f64::from(size);
        let place = |value: f64, first: f64| match value {
            v if (0.0..1.0).contains(&v) => Some((v * all).floor()),
            v if v >= 1.0 && v <= all && v.fract() == 0.0 => Some(v - first),
            _ => None,
        };
        let start = self.start.map_or(Some(0.0), |v| place(v, 1.0));
        let end = match self.end {
            None | Some(1.0) => Some(all),
            Some(v) => place(v, 0.0),
        };
        match (start, end) {
            (Some(start), Some(end)) if start < end => Ok((start as u32, (end - start) as u32)),
            _ => {
                let show = |v: Option<f64>, or: &str| v.map_or(or.to_owned(), |v| v.to_string());
                Err(format!(
                    "the {what} from {} to {} of {size} are not a part of the picture: expected numbers from 1 to {size}, or fractions from 0.0 to 1.0",
                    show(self.start, "the first"),
                    show(self.end, "the last"),
                ))
            }
        }
    }
}

impl Settings {
    /// Applies a key and its value.
    pub(super) fn set(&mut self, key: &str, value: &str) -> Result<(), String> {
        let Some(key) = spelled(key) else {
            return Err(unknown(key));
        };
        if IGNORED.contains(&key) {
            return Ok(());
        }
        if let Some((_, what)) = LEFT_OUT.iter().find(|(k, _)| *k == key) {
            if !is_off(value) {
                self.note(what);
            }
            return Ok(());
        }
        if COMMANDS.contains(&key) {
            self.notes
                .push(format!("{key} is ignored: strahl runs no programs"));
            return Ok(());
        }
        let value = match NUMBERS.contains(&key) {
            true => self.leading_number(key, value),
            false => value,
        };
        self.apply(key, value).map_err(|e| format!("{key}: {e}"))
    }

    /// The number that a value begins with, as in POV-Ray, with a note if more follows. A value without a number stays as it is.
    fn leading_number<'a>(&mut self, key: &str, value: &'a str) -> &'a str {
        let number = leading_number(value);
        // POV-Ray reads hexadecimal fractions, which strahl refuses, but no hexadecimal levels: `Quality=0x9` is 0.
        let is_hexadecimal = number == "0" && value[1..].starts_with(['x', 'X']);
        let is_refused = is_hexadecimal && key != "Quality";
        if number.is_empty() || number == value || is_refused {
            return value;
        }
        self.note(&format!(
            "{key}: `{value}` is read as {number}, as in POV-Ray"
        ));
        number
    }

    /// The folder of the .ini file that is being read.
    pub(super) fn beside(&self) -> Option<&Path> {
        self.open.last().and_then(|file| file.parent())
    }

    fn apply(&mut self, key: &'static str, value: &str) -> Result<(), String> {
        match key {
            "Width" => self.width = Some(whole(value, 1, 1 << 24)?),
            "Height" => self.height = Some(whole(value, 1, 1 << 24)?),
            "Antialias" => self.antialias = Some(is_on(value)),
            "Antialias_Threshold" => self.threshold = Some(number(value)?),
            "Antialias_Gamma" => {
                let gamma = number(value)?;
                if gamma <= 0.0 {
                    return Err(format!("expected a gamma above 0, found `{value}`"));
                }
                self.antialias_gamma = Some(gamma);
            }
            "Antialias_Depth" => self.depth = Some(whole(value, 1, u32::MAX)?.min(9)),
            // 3 is a newer variant of 2 in POV-Ray 3.8.
            "Sampling_Method" => self.recursive = whole(value, 1, 3)? > 1,
            "Input_File_Name" => {
                self.input = self.scene(value)?;
                let file = Path::new(&self.input);
                self.is_pov = Format::of_path(file).is_none() && file.is_file();
            }
            "Output_File_Name" => self.output = Some(output_name(value)?),
            "Output_File_Type" => self.file_type = Some(self.picture_type(value)?),
            "Bits_Per_Color" => self.bits = Some(whole(value, 1, u32::MAX)?),
            "Grayscale_Output" => self.grayscale = is_on(value),
            "Output_to_File" => self.no_output = !is_on(value),
            "Start_Column" => self.columns.start = Some(number(value)?),
            "End_Column" => self.columns.end = Some(number(value)?),
            "Start_Row" => self.rows.start = Some(number(value)?),
            "End_Row" => self.rows.end = Some(number(value)?),
            "Work_Threads" => self.threads = Some(whole(value, 1, 512)?),
            "Library_Path" => self.library.push(file_name(value)?),
            "Declare" => {
                let declaration = self.declaration(value)?;
                self.add_declaration(declaration);
            }
            "Version" => self.version = Some(self.language_version(value)?),
            "Continue_Trace" => self.resume = is_on(value),
            "Cyclic_Animation" => self.cyclic = is_on(value),
            "Initial_Frame" => self.initial_frame = frame(value)?,
            "Final_Frame" => self.final_frame = frame(value)?,
            "Initial_Clock" => self.time("--initial-clock", value)?,
            "Final_Clock" => self.time("--final-clock", value)?,
            "Subset_Start_Frame" => self.time("--subset-start-frame", value)?,
            "Subset_End_Frame" => self.time("--subset-end-frame", value)?,
            "Frame_Step" => self.time("--frame-step", value)?,
            "Clock" => self.time("--clock", value)?,
            "Quality" => self.quality = Some(whole(value, 0, u32::MAX)?),
            "Output_Alpha" => self.alpha = is_on(value),
            "Create_Ini" if !is_off(value) => self.notes.push("no .ini file is written".into()),
            "Include_Ini" => ini::include(&file_name(value)?, self)?,
            "Include_Header" => self.header = Some(file_name(value)?),
            "Compression" => {
                // As in POV-Ray, 0 and 1 select the usual quality.
                let quality = number(value)?.clamp(0.0, 100.0) as u8;
                self.jpeg_quality = (quality > 1).then_some(quality);
            }
            "File_Gamma" if !value.eq_ignore_ascii_case("srgb") && number(value)? != 2.2 => {
                self.note(
                    "File_Gamma is ignored: pictures are written with sRGB's transfer function",
                );
            }
            _ => {}
        }
        Ok(())
    }

    /// Adds a note, unless there is the same note already.
    fn note(&mut self, what: &str) {
        if !self.notes.iter().any(|n| n == what) {
            self.notes.push(what.to_owned());
        }
    }

    /// Stores an option with a number; a later value replaces an earlier one.
    fn time(&mut self, option: &'static str, value: &str) -> Result<(), String> {
        number(value)?;
        self.times.retain(|(o, _)| *o != option);
        self.times.push((option, value.to_owned()));
        Ok(())
    }

    /// NAME=NUMBER. What follows the number is left out.
    fn declaration(&mut self, value: &str) -> Result<String, String> {
        match value.split_once('=') {
            Some((name, number)) if !name.trim().is_empty() => {
                let number = self.leading_number("Declare", number.trim());
                Ok(format!("{}={number}", name.trim()))
            }
            _ => Err(format!("expected NAME=NUMBER, found `{value}`")),
        }
    }

    /// Adds NAME=NUMBER. Of several with one name the first counts, as in POV-Ray (measured).
    fn add_declaration(&mut self, declaration: String) {
        let name = |text: &str| text.split_once('=').map(|(name, _)| name.to_owned());
        let first = self
            .declare
            .iter()
            .find(|known| name(known) == name(&declaration));
        match first {
            None => self.declare.push(declaration),
            Some(first) if *first == declaration => {}
            Some(first) => {
                let note = format!(
                    "Declare: {declaration} is ignored, because {first} stands before it; the first one counts, as in POV-Ray"
                );
                self.note(&note);
            }
        }
    }

    /// The letter of a picture's type. Only the first one counts, as in POV-Ray.
    fn picture_type(&mut self, value: &str) -> Result<char, String> {
        let letter = value.chars().next().map_or(' ', |c| c.to_ascii_uppercase());
        if !"BCEHJNPST".contains(letter) {
            return Err(format!(
                "unknown type of picture `{value}`: N is PNG, P PPM, J JPEG, B BMP, T and C TGA, H Radiance, E OpenEXR"
            ));
        }
        if value.len() > 1 {
            self.note(&format!(
                "Output_File_Type: of `{value}` only the letter {letter} counts, as in POV-Ray; the picture is of the type .{} (N is PNG)",
                ending(letter)
            ));
        }
        Ok(letter)
    }

    /// A version of the language. POV-Ray 3.7 takes numbers above all versions (`350`) for itself.
    fn language_version(&mut self, value: &str) -> Result<f64, String> {
        const OF_POVRAY: f64 = 3.7;
        let version = number(value)?;
        if version < 4.0 {
            return Ok(version);
        }
        self.note(&format!(
            "Version: {value} is read as {OF_POVRAY}; version 3.5 is written with a point"
        ));
        Ok(OF_POVRAY)
    }

    /// The scene file of a setting; `.pov` may be omitted.
    fn scene(&self, value: &str) -> Result<String, String> {
        let name = self.complete(&file_name(value)?);
        let path = Path::new(&name);
        let complete = name == "-" || path.extension().is_some() || path.is_file();
        Ok(match complete {
            true => name,
            false => format!("{name}.pov"),
        })
    }

    /// The scene file of this name, with `.pov` if that file exists, in the current folder or in that of the .ini file.
    pub(super) fn complete(&self, name: &str) -> String {
        if name == "-" {
            return name.to_owned();
        }
        let folders = [Some(Path::new("")), self.beside()];
        let names = [
            name.to_owned(),
            format!("{name}.pov"),
            format!("{name}.POV"),
        ];
        for folder in folders.into_iter().flatten() {
            let found = names.iter().map(|n| folder.join(n)).find(|p| p.is_file());
            if let Some(found) = found {
                return found.to_string_lossy().into_owned();
            }
        }
        name.to_owned()
    }

    /// All settings but the scene as options of strahl. `own` are the options of strahl that follow them.
    pub(super) fn words(&mut self, own: &Own) -> Result<Vec<String>, String> {
        if let Some((width, height)) = own.size {
            (self.width, self.height) = (Some(width), Some(height));
        }
        let mut words: Vec<String> = vec![];
        let mut add = |option: &str, value: String| words.extend([option.to_owned(), value]);
        let size = (
            self.width.unwrap_or(DEFAULT_SIZE.0),
            self.height.unwrap_or(DEFAULT_SIZE.1),
        );
        let (columns, rows) = (
            self.columns.pixels(size.0, "columns")?,
            self.rows.pixels(size.1, "rows")?,
        );
        let is_part = (columns.1, rows.1) != size && !own.region;
        if self.width.or(self.height).is_some() || is_part {
            add("--size", format!("{}x{}", size.0, size.1));
        }
        if is_part {
            let region = format!("{},{},{}x{}", columns.0, rows.0, columns.1, rows.1);
            add("--region", region);
        }
        // As in POV-Ray, there is no antialiasing unless it is asked for.
        let sampling = match self.antialias {
            Some(true) => self.sampling(),
            _ => "center".into(),
        };
        add("--sampling", sampling);
        if let Some(n) = self.threads {
            add("--threads", n.to_string());
        }
        // As in POV-Ray, grey pictures have 16 bits.
        if let Some(bits) = self.bits.or(self.grayscale.then_some(16)) {
            let is_deep = bits > 8 || self.grayscale;
            add("--bit-depth", if is_deep { "16" } else { "8" }.into());
        }
        for folder in &self.library {
            add("--library-path", folder.clone());
        }
        for declaration in &self.declare {
            add("--declare", declaration.clone());
        }
        if let Some(version) = self.version {
            add("--language-version", version.to_string());
        }
        // The frames from 1 to 1 are no animation, whatever else is said of it, as in POV-Ray (measured).
        let is_still = self.initial_frame == Some(1) && self.final_frame == Some(1);
        for (option, n) in [
            ("--initial-frame", self.initial_frame),
            ("--final-frame", self.final_frame),
        ] {
            if let Some(n) = n.filter(|_| !is_still) {
                add(option, n.to_string());
            }
        }
        for (option, value) in &self.times {
            if !is_still || *option == "--clock" {
                add(option, value.clone());
            }
        }
        if let Some(header) = &self.header {
            add("--include", header.clone());
        }
        if let Some(quality) = self.quality.filter(|quality| *quality < 9) {
            add("--quality", quality.to_string());
        }
        if let Some(quality) = self.jpeg_quality {
            add("--jpeg-quality", quality.to_string());
        }
        if let Some(output) = self.output()? {
            let stream = output == "-";
            add("--output", output);
            if stream && let Some(ending) = self.file_type.map(ending) {
                add("--picture-format", ending.to_owned());
            }
        }
        let has_alpha = matches!(self.file_type, None | Some('N' | 'E' | 'S' | 'T' | 'C'));
        if self.alpha && !has_alpha {
            self.note("pictures of this type are written without an alpha channel");
        }
        let flags = [
            (self.alpha && has_alpha, "--alpha"),
            (self.grayscale, "--grayscale"),
            (is_part, "--full-size"),
            (self.no_output, "--no-output"),
            (self.cyclic && !is_still, "--cyclic"),
            (self.resume, "--resume"),
        ];
        words.extend(flags.iter().filter(|f| f.0).map(|f| f.1.to_owned()));
        if (self.input == "-" || self.is_pov) && !own.format {
            words.extend(["--format".to_owned(), "pov".to_owned()]);
        }
        Ok(words)
    }

    /// The value of `--sampling`: method, threshold, depth and gamma.
    fn sampling(&self) -> String {
        let threshold = self.threshold.unwrap_or(0.3).max(0.0);
        if threshold >= 3.0 {
            return "center".into();
        }
        let method = if self.recursive {
            "recursive"
        } else {
            "adaptive"
        };
        let depth = self.depth.unwrap_or(3);
        match self.antialias_gamma {
            None => format!("{method}:{threshold},{depth}"),
            Some(gamma) => format!("{method}:{threshold},{depth},{gamma}"),
        }
    }

    /// Where the picture goes if no setting names it: beside the scene, as in POV-Ray. `None` for strahl's default, the current folder.
    fn beside_the_scene(&self) -> Option<String> {
        let scene = Path::new(&self.input);
        let stem = scene.file_stem().filter(|_| self.input != "-")?;
        let folder = scene.parent().unwrap_or(Path::new(""));
        let path = match self.file_type.map(ending) {
            Some(ending) => folder.join(format!("{}.{ending}", stem.to_string_lossy())),
            None if folder.as_os_str().is_empty() => return None,
            // Only the folder, with a separator at its end: strahl's own options may still decide about the file's name.
            None => folder.join(""),
        };
        Some(path.to_string_lossy().into_owned())
    }

    /// The name of the picture with the extension of its type; `None` for strahl's default.
    fn output(&self) -> Result<Option<String>, String> {
        if self.output.as_deref() == Some("-") {
            return Ok(self.output.clone());
        }
        let ending = self.file_type.map_or("png", ending);
        let scene = Path::new(&self.input).file_stem().unwrap_or_default();
        let scene = scene.to_string_lossy().into_owned();
        let Some(output) = &self.output else {
            return Ok(self.beside_the_scene());
        };
        if output.ends_with('/') || Path::new(output).is_dir() {
            let file = Path::new(output).join(format!("{scene}.{ending}"));
            return Ok(Some(file.to_string_lossy().into_owned()));
        }
        let path = Path::new(output);
        let has = path
            .extension()
            .map(|e| e.to_string_lossy().to_ascii_lowercase());
        let name = match (has.as_deref(), self.file_type) {
            (Some(e), _) if ImageFormat::from_name(e) == ImageFormat::from_name(ending) => {
                output.clone()
            }
            (Some(_), None) if ImageFormat::from_path(path).is_ok() => output.clone(),
            _ => format!("{output}.{ending}"),
        };
        Ok(Some(name))
    }
}

fn unknown(key: &str) -> String {
    let common = |other: &str| {
        let pairs = key.chars().zip(other.chars());
        pairs.take_while(|(a, b)| a.eq_ignore_ascii_case(b)).count()
    };
    let near = KEYS
        .iter()
        .max_by_key(|k| (common(k), std::cmp::Reverse(k.len())));
    let hint = match near {
        Some(near) if common(near) >= 3 => format!("; did you mean `{near}`?"),
        _ => String::new(),
    };
    format!("POV-Ray has no setting `{key}`{hint}")
}

/// Whether POV-Ray reads the value as on; any other value is off.
fn is_on(value: &str) -> bool {
    ["true", "yes", "on", "1"]
        .iter()
        .any(|w| value.eq_ignore_ascii_case(w))
}

fn is_off(value: &str) -> bool {
    ["false", "no", "off", "0"]
        .iter()
        .any(|w| value.eq_ignore_ascii_case(w))
}

fn number(value: &str) -> Result<f64, String> {
    let parsed = value.parse().ok().filter(|v: &f64| v.is_finite());
    parsed.ok_or_else(|| format!("expected a number, found `{value}`"))
}

/// A whole number; decimals are cut off, as in POV-Ray (programs write `Height=320.4585`).
fn whole(value: &str, least: u32, most: u32) -> Result<u32, String> {
    let (digits, decimals) = value.split_once('.').unwrap_or((value, ""));
    let parsed = digits
        .parse()
        .ok()
        .filter(|v| decimals.bytes().all(|b| b.is_ascii_digit()) && (least..=most).contains(v));
    let range = match most {
        u32::MAX => format!("from {least} up"),
        most => format!("from {least} to {most}"),
    };
    parsed.ok_or_else(|| format!("expected a whole number {range}, found `{value}`"))
}

/// The number of a frame; -1 means none.
fn frame(value: &str) -> Result<Option<u32>, String> {
    match value {
        "-1" => Ok(None),
        value => whole(value, 0, 1 << 24).map(Some),
    }
}

fn file_name(value: &str) -> Result<String, String> {
    match value {
        "" => Err("expected a file or folder name directly after it, without a space".into()),
        name => Ok(name.to_owned()),
    }
}

/// The name of the picture; `stdout` is the standard output, like `-`.
fn output_name(value: &str) -> Result<String, String> {
    match file_name(value)?.as_str() {
        "stdout" => Ok("-".to_owned()),
        name => Ok(name.to_owned()),
    }
}

/// The longest beginning of a text that is a number; empty if there is none.
fn leading_number(text: &str) -> &str {
    let is_part = |c: char| c.is_ascii_digit() || matches!(c, '+' | '-' | '.' | 'e' | 'E');
    let most = text.find(|c| !is_part(c)).unwrap_or(text.len());
    let mut beginnings = (1..=most).rev().map(|end| &text[..end]);
    beginnings
        .find(|beginning| beginning.parse::<f64>().is_ok())
        .unwrap_or("")
}

/// The file extension of a picture type.
fn ending(letter: char) -> &'static str {
    match letter {
        'B' => "bmp",
        'C' | 'T' => "tga",
        'E' => "exr",
        'H' => "hdr",
        'J' => "jpg",
        'P' => "ppm",
        // Also for the system's own format.
        _ => "png",
    }
}

/// The options of strahl that override or complete POV-Ray's settings.
#[derive(Debug, Default)]
pub(super) struct Own {
    size: Option<(u32, u32)>,
    region: bool,
    format: bool,
}

impl Own {
    pub(super) fn of(words: &[OsString]) -> Self {
        let mut own = Self::default();
        let mut texts = words.iter().map(|w| w.to_str().unwrap_or_default());
        while let Some(text) = texts.next() {
            let (name, value) = match text.split_once('=') {
                Some((name, value)) => (name, Some(value)),
                None => (text, None),
            };
            match name {
                "--size" => {
                    let value = value.or_else(|| texts.next()).unwrap_or_default();
                    // clap refuses a malformed size.
                    let pair = value.split_once('x');
                    own.size = pair.and_then(|(w, h)| Some((w.parse().ok()?, h.parse().ok()?)));
                }
                "--region" => own.region = true,
                "--format" | "--scene-format" => own.format = true,
                _ => {}
            }
        }
        own
    }
}
