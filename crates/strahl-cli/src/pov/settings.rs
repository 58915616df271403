//! What POV-Ray's switches and keys ask for, and the same in strahl's options.

use crate::input::DEFAULT_SIZE;
use std::path::{Path, PathBuf};
use strahl::formats::image::ImageFormat;

/// Keys whose values make a difference here, as the manual spells them.
const KEYS: &[&str] = &[
    "Antialias",
    "Antialias_Depth",
    "Antialias_Threshold",
    "Bits_Per_Color",
    "Clock",
    "Continue_Trace",
    "Create_Ini",
    "Cyclic_Animation",
    "Declare",
    "End_Column",
    "End_Row",
    "Field_Render",
    "Final_Clock",
    "Final_Frame",
    "Frame_Step",
    "Height",
    "Include_Header",
    "Initial_Clock",
    "Initial_Frame",
    "Input_File_Name",
    "Library_Path",
    "Output_Alpha",
    "Output_File_Name",
    "Output_File_Type",
    "Output_to_File",
    "Quality",
    "Sampling_Method",
    "Start_Column",
    "Start_Row",
    "Subset_End_Frame",
    "Subset_Start_Frame",
    "Version",
    "Width",
    "Work_Threads",
];

/// Keys that concern displays, messages, memory and speed, or noise that strahl has no use for: accepted, without effect.
const IGNORED: &[&str] = &[
    "All_Console",
    "All_File",
    "Antialias_Gamma",
    "Append_File",
    "Bounding",
    "Bounding_Method",
    "Bounding_Threshold",
    "BSP_BaseAccessCost",
    "BSP_ChildAccessCost",
    "BSP_IsectCost",
    "BSP_MaxDepth",
    "BSP_MissChance",
    "Buffer_Output",
    "Buffer_Size",
    "Compression",
    "Debug_Console",
    "Debug_File",
    "Display",
    "Display_Gamma",
    "Dither",
    "Dither_Method",
    "Draw_Vistas",
    "Fatal_Console",
    "Fatal_File",
    "File_Gamma",
    "High_Reproducibility",
    "Jitter",
    "Jitter_Amount",
    "Light_Buffer",
    "Max_Image_Buffer_Memory",
    "Odd_Field",
    "Palette",
    "Pause_When_Done",
    "Preview_End_Size",
    "Preview_Start_Size",
    "Radiosity_File_Name",
    "Radiosity_From_File",
    "Radiosity_To_File",
    "Radiosity_Vain_Pretrace",
    "Remove_Bounds",
    "Render_Block_Size",
    "Render_Block_Step",
    "Render_Console",
    "Render_File",
    "Render_Pattern",
    "Split_Unions",
    "Statistic_Console",
    "Statistic_File",
    "Test_Abort",
    "Test_Abort_Count",
    "Verbose",
    "Video_Mode",
    "Vista_Buffer",
    "Warning_Console",
    "Warning_File",
    "Warning_Level",
];

/// Keys that run programs.
const COMMANDS: &[&str] = &[
    "Fatal_Error_Command",
    "Fatal_Error_Return",
    "Post_Frame_Command",
    "Post_Frame_Return",
    "Post_Scene_Command",
    "Post_Scene_Return",
    "Pre_Frame_Command",
    "Pre_Frame_Return",
    "Pre_Scene_Command",
    "Pre_Scene_Return",
    "User_Abort_Command",
    "User_Abort_Return",
];

fn spelled(key: &str) -> Option<&'static str> {
    let mut all = KEYS.iter().chain(IGNORED).chain(COMMANDS);
    all.find(|k| k.eq_ignore_ascii_case(key)).copied()
}

/// Whether POV-Ray has a setting of this name.
pub(super) fn is_key(key: &str) -> bool {
    spelled(key).is_some()
}

/// What was set so far; later settings win.
#[derive(Debug, Default)]
pub(super) struct Settings {
    /// The scene; empty if none is named.
    pub(super) input: String,
    /// Where the .ini file lies that is being read.
    pub(super) beside: Option<PathBuf>,
    /// What was asked for and will not be done.
    pub(super) notes: Vec<String>,
    width: Option<u32>,
    height: Option<u32>,
    antialias: Option<bool>,
    threshold: Option<f64>,
    recursive: bool,
    depth: Option<u32>,
    output: Option<String>,
    file_type: Option<char>,
    bits: Option<u32>,
    no_output: bool,
    columns: Range,
    rows: Range,
    threads: Option<u32>,
    library: Vec<String>,
    declare: Vec<String>,
    version: Option<f64>,
    resume: bool,
    cyclic: bool,
    initial_frame: Option<u32>,
    final_frame: Option<u32>,
    /// Clocks, subset and step: options with the values as they were written.
    times: Vec<(&'static str, String)>,
}

/// First and last column or row, as numbers from 1 or as parts.
#[derive(Clone, Copy, Debug, Default)]
struct Range {
    start: Option<f64>,
    end: Option<f64>,
}

impl Range {
    /// Position and length in pixels. Parts are rounded down; a start of 1 is the first pixel, an end of 1 is 100 %.
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
                    "no {what} are left of {size} from {} to {}: expected numbers from 1 to {size}, or parts from 0.0 to 1.0",
                    show(self.start, "the first"),
                    show(self.end, "the last"),
                ))
            }
        }
    }
}

impl Settings {
    /// Sets what a key of POV-Ray's says.
    pub(super) fn set(&mut self, key: &str, value: &str) -> Result<(), String> {
        let Some(key) = spelled(key) else {
            return Err(unknown(key));
        };
        if IGNORED.contains(&key) {
            return Ok(());
        }
        if COMMANDS.contains(&key) {
            self.notes
                .push(format!("{key} is not done: strahl runs no programs"));
            return Ok(());
        }
        self.apply(key, value).map_err(|e| format!("{key}: {e}"))
    }

    fn apply(&mut self, key: &'static str, value: &str) -> Result<(), String> {
        match key {
            "Width" => self.width = Some(whole(value, 1, 1 << 24)?),
            "Height" => self.height = Some(whole(value, 1, 1 << 24)?),
            "Antialias" => self.antialias = Some(is_on(value)),
            "Antialias_Threshold" => self.threshold = Some(number(value)?),
            "Antialias_Depth" => self.depth = Some(whole(value, 1, 9)?),
            // 3 is POV-Ray 3.8's further development of 2.
            "Sampling_Method" => self.recursive = whole(value, 1, 3)? > 1,
            "Input_File_Name" => self.input = self.scene(value)?,
            "Output_File_Name" => self.output = Some(file_name(value)?),
            "Output_File_Type" => self.file_type = Some(picture_type(value)?),
            "Bits_Per_Color" => self.bits = Some(whole(value, 1, 16)?),
            "Output_to_File" => self.no_output = !is_on(value),
            "Start_Column" => self.columns.start = Some(number(value)?),
            "End_Column" => self.columns.end = Some(number(value)?),
            "Start_Row" => self.rows.start = Some(number(value)?),
            "End_Row" => self.rows.end = Some(number(value)?),
            "Work_Threads" => self.threads = Some(whole(value, 1, 512)?),
            "Library_Path" => self.library.push(file_name(value)?),
            "Declare" => self.declare.push(declaration(value)?),
            "Version" => self.version = Some(number(value)?),
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
            "Quality" if whole(value, 0, 11)? < 9 => {
                let note = format!("quality {value} is not reduced: pictures are rendered in full");
                self.notes.push(note);
            }
            "Output_Alpha" if is_on(value) => {
                self.notes
                    .push("pictures are written without an alpha channel".into());
            }
            "Create_Ini" if !is_off(value) => self.notes.push("no .ini file is written".into()),
            "Field_Render" if is_on(value) => {
                return Err("fields are not rendered; leave it out to render whole frames".into());
            }
            "Include_Header" => {
                return Err(format!(
                    "`{value}` cannot be included from here; write `#include \"{value}\"` into the scene"
                ));
            }
            _ => {}
        }
        Ok(())
    }

    /// Remembers an option with a number, once.
    fn time(&mut self, option: &'static str, value: &str) -> Result<(), String> {
        number(value)?;
        self.times.retain(|(o, _)| *o != option);
        self.times.push((option, value.to_owned()));
        Ok(())
    }

    /// The scene file: `.pov` may be left out, and beside an .ini file is as good as in the current folder.
    fn scene(&self, value: &str) -> Result<String, String> {
        let name = file_name(value)?;
        if name == "-" {
            return Ok(name);
        }
        let folders = [Some(PathBuf::new()), self.beside.clone()];
        let names = [name.clone(), format!("{name}.pov"), format!("{name}.POV")];
        for folder in folders.into_iter().flatten() {
            let found = names.iter().map(|n| folder.join(n)).find(|p| p.is_file());
            if let Some(found) = found {
                return Ok(found.to_string_lossy().into_owned());
            }
        }
        let complete = Path::new(&name).extension().is_some();
        Ok(if complete {
            name
        } else {
            format!("{name}.pov")
        })
    }

    /// All of it in strahl's words, the scene last; `formatted` if the scene's format is given elsewhere.
    pub(super) fn words(&mut self, formatted: bool) -> Result<Vec<String>, String> {
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
        let is_part = (columns.1, rows.1) != size;
        if self.width.or(self.height).is_some() || is_part {
            add("--size", format!("{}x{}", size.0, size.1));
        }
        if is_part {
            let region = format!("{},{},{}x{}", columns.0, rows.0, columns.1, rows.1);
            add("--region", region);
        }
        if let Some(on) = self.antialias {
            add(
                "--sampling",
                if on { self.sampling() } else { "center".into() },
            );
        }
        if let Some(n) = self.threads {
            add("--threads", n.to_string());
        }
        if let Some(bits) = self.bits {
            add("--bit-depth", if bits > 8 { "16" } else { "8" }.into());
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
        for (option, n) in [
            ("--initial-frame", self.initial_frame),
            ("--final-frame", self.final_frame),
        ] {
            if let Some(n) = n {
                add(option, n.to_string());
            }
        }
        for (option, value) in &self.times {
            add(option, value.clone());
        }
        if let Some(output) = self.output()? {
            add("--output", output);
        }
        let flags = [
            (is_part, "--full-size"),
            (self.no_output, "--no-output"),
            (self.cyclic, "--cyclic"),
            (self.resume, "--resume"),
        ];
        words.extend(flags.iter().filter(|f| f.0).map(|f| f.1.to_owned()));
        if self.input == "-" && !formatted {
            words.extend(["--format".to_owned(), "pov".to_owned()]);
        }
        if !self.input.is_empty() {
            words.push(self.input.clone());
        }
        Ok(words)
    }

    /// Adaptive sampling that refines about the same pixels, about as far.
    ///
    /// POV-Ray compares the sum of the differences of three channels with its threshold, strahl the largest: a third. Its
    /// first method takes depth² samples more, its second up to (2ᵈᵉᵖᵗʰ + 1)²; strahl's passes add 4, 16, 64, 256.
    fn sampling(&self) -> String {
        let threshold = self.threshold.unwrap_or(0.3).max(0.0);
        if threshold >= 3.0 {
            return "center".into();
        }
        let passes = match (self.recursive, self.depth.unwrap_or(3)) {
            (true, depth) => depth.min(4),
            (false, 0..=2) => 1,
            (false, 3..=4) => 2,
            (false, _) => 3,
        };
        // Rounded, for people to read.
        let third = (threshold / 3.0 * 1e6).round() / 1e6;
        format!("adaptive:{third},{passes}")
    }

    /// The picture's name with the ending that its type asks for; `None` leaves it to strahl.
    fn output(&mut self) -> Result<Option<String>, String> {
        if self.output.as_deref() == Some("-") {
            return Err(
                "pictures are not written to the standard output; name a file: +Oscene.png".into(),
            );
        }
        let ending = match self.file_type {
            None | Some('N') => "png",
            Some('P') => "ppm",
            Some('H') => "hdr",
            Some('E') => "exr",
            Some(other) => {
                self.notes.push(format!(
                    "picture files of type {other} are not written: the picture will be a PNG"
                ));
                "png"
            }
        };
        let scene = Path::new(&self.input).file_stem().unwrap_or_default();
        let scene = scene.to_string_lossy().into_owned();
        let Some(output) = &self.output else {
            let named = self.file_type.is_some() && !scene.is_empty() && scene != "-";
            return Ok(named.then(|| format!("{scene}.{ending}")));
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
            (Some(e), _) if e == ending => output.clone(),
            (Some(_), None) if ImageFormat::from_path(path).is_ok() => output.clone(),
            // The ending belongs to a type that is not written.
            (Some("tga" | "bmp" | "jpg" | "jpeg"), Some('T' | 'C' | 'B' | 'J' | 'S')) => {
                path.with_extension(ending).to_string_lossy().into_owned()
            }
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

/// POV-Ray's idea of yes; anything else is no.
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

fn whole(value: &str, least: u32, most: u32) -> Result<u32, String> {
    let parsed = value.parse().ok().filter(|v| (least..=most).contains(v));
    parsed.ok_or_else(|| format!("expected a whole number from {least} to {most}, found `{value}`"))
}

/// A frame's number; -1 stands for none.
fn frame(value: &str) -> Result<Option<u32>, String> {
    match value {
        "-1" => Ok(None),
        value => whole(value, 0, 1 << 24).map(Some),
    }
}

fn file_name(value: &str) -> Result<String, String> {
    match value {
        "" => Err("expected a file or folder name right behind it, without a space".into()),
        name => Ok(name.to_owned()),
    }
}

fn declaration(value: &str) -> Result<String, String> {
    match value.split_once('=') {
        Some((name, _)) if !name.trim().is_empty() => Ok(value.to_owned()),
        _ => Err(format!("expected NAME=NUMBER, found `{value}`")),
    }
}

fn picture_type(value: &str) -> Result<char, String> {
    let letter = value.chars().next().map_or(' ', |c| c.to_ascii_uppercase());
    if "BCEHJNPST".contains(letter) && value.len() == 1 {
        return Ok(letter);
    }
    Err(format!(
        "unknown type of picture `{value}`: N is PNG, P PPM, H Radiance, E OpenEXR"
    ))
}
