//! POV-Ray's switches, such as `+W640`, `-D`, `+A0.3`: each is an abbreviation of settings.

use super::ini;
use super::settings::Settings;

/// The meaning of a switch.
#[derive(Clone, Copy)]
enum Meaning {
    /// The rest of the word is the value of this key.
    Value(&'static str),
    /// `+` switches this key on, `-` off.
    Flag(&'static str),
    /// Both: `+` or `-` switches the first key, the rest, if any, is the value of the second.
    FlagAndValue(&'static str, &'static str),
    /// With a name, the messages of this key go to a file; without one, it concerns the console.
    Stream(&'static str),
    /// Type and bit depth of the picture file.
    FileType,
    /// Has no influence on the picture.
    Nothing,
}

use Meaning::{FileType, Flag, FlagAndValue, Nothing, Stream, Value};

/// All switches; the longest one that a word begins with counts.
const SWITCHES: &[(&str, Meaning)] = &[
    ("A", FlagAndValue("Antialias", "Antialias_Threshold")),
    ("AG", Value("Antialias_Gamma")),
    ("AM", Value("Sampling_Method")),
    ("B", Nothing),
    ("BM", Nothing),
    ("BS", Nothing),
    ("C", Flag("Continue_Trace")),
    ("D", Nothing),
    ("EC", Value("End_Column")),
    ("EF", Value("Subset_End_Frame")),
    ("EP", Nothing),
    ("ER", Value("End_Row")),
    ("F", FileType),
    ("GA", Stream("All_File")),
    ("GD", Stream("Debug_File")),
    ("GF", Stream("Fatal_File")),
    ("GI", Value("Create_Ini")),
    ("GP", Nothing),
    ("GR", Stream("Render_File")),
    ("GS", Stream("Statistic_File")),
    ("GW", Stream("Warning_File")),
    ("H", Value("Height")),
    ("HI", Value("Include_Header")),
    ("HR", Nothing),
    ("I", Value("Input_File_Name")),
    ("J", Nothing),
    ("K", Value("Clock")),
    ("KC", Flag("Cyclic_Animation")),
    ("KF", Value("Final_Clock")),
    ("KFF", Value("Final_Frame")),
    ("KFI", Value("Initial_Frame")),
    ("KI", Value("Initial_Clock")),
    ("L", Value("Library_Path")),
    ("MB", Nothing),
    ("MI", Nothing),
    ("MV", Value("Version")),
    ("O", Value("Output_File_Name")),
    ("P", Nothing),
    ("Q", Value("Quality")),
    ("R", Value("Antialias_Depth")),
    ("RF", Nothing),
    ("RFI", Flag("Radiosity_From_File")),
    ("RFO", Flag("Radiosity_To_File")),
    ("RP", Nothing),
    ("RS", Nothing),
    ("RTR", Flag("Real_Time_Raytracing")),
    ("RVP", Nothing),
    ("SC", Value("Start_Column")),
    ("SF", Value("Subset_Start_Frame")),
    ("SP", Nothing),
    ("SR", Value("Start_Row")),
    ("STP", Value("Frame_Step")),
    ("SU", Nothing),
    ("TH", FlagAndValue("Dither", "Dither_Method")),
    ("UA", Flag("Output_Alpha")),
    ("UD", Nothing),
    ("UF", Flag("Field_Render")),
    ("UL", Nothing),
    ("UO", Nothing),
    ("UR", Nothing),
    ("UV", Nothing),
    ("V", Nothing),
    ("W", Value("Width")),
    ("WL", Nothing),
    ("WT", Value("Work_Threads")),
    ("X", Nothing),
];

/// Applies a switch.
pub(super) fn apply(word: &str, settings: &mut Settings) -> Result<(), String> {
    let on = word.starts_with('+');
    let body = word.get(1..).unwrap_or_default();
    let begins = |name: &str| {
        let start = body.get(..name.len());
        start.is_some_and(|s| s.eq_ignore_ascii_case(name))
    };
    let found = SWITCHES.iter().filter(|(name, _)| begins(name));
    let Some((name, meaning)) = found.max_by_key(|(name, _)| name.len()) else {
        return Err(format!(
            "unknown switch `{word}`: it is neither an option of strahl (see `strahl render --help`) nor a switch of POV-Ray"
        ));
    };
    let rest = ini::unquoted(body.get(name.len()..).unwrap_or_default());
    let state = if on { "on" } else { "off" };
    let result = match *meaning {
        Value(key) => settings.set(key, rest),
        Flag(key) => settings.set(key, state),
        FlagAndValue(flag, value) => settings.set(flag, state).and_then(|()| match rest {
            "" => Ok(()),
            rest => settings.set(value, rest),
        }),
        Stream(key) => match (on, rest) {
            (_, "") | (false, _) => Ok(()),
            (true, file) => settings.set(key, file),
        },
        FileType => settings
            .set("Output_to_File", state)
            .and_then(|()| file_type(rest, settings)),
        Nothing => Ok(()),
    };
    result.map_err(|problem| format!("{word}: {problem}"))
}

/// Applies the letter and what follows it: the number of bits, as in `N16`, the quality of JPEG, as in `J90`, or `G` for grey values, as in
/// `NG`.
fn file_type(rest: &str, settings: &mut Settings) -> Result<(), String> {
    let mut letters = rest.chars();
    let Some(letter) = letters.next() else {
        return Ok(());
    };
    settings.set("Output_File_Type", &letter.to_string())?;
    match (letter.to_ascii_uppercase(), letters.as_str()) {
        (_, "") => Ok(()),
        ('N' | 'P', "G" | "g") => settings.set("Grayscale_Output", "on"),
        ('J', quality) => settings.set("Compression", quality),
        (_, bits) => settings.set("Bits_Per_Color", bits),
    }
}
