//! POV-Ray's settings, under their names in the manual.

/// Keys that strahl implements.
pub(super) const KEYS: &[&str] = &[
    "Antialias",
    "Antialias_Depth",
    "Antialias_Gamma",
    "Antialias_Threshold",
    "Bits_Per_Color",
    "Clock",
    "Compression",
    "Continue_Trace",
    "Create_Ini",
    "Cyclic_Animation",
    "Declare",
    "End_Column",
    "End_Row",
    "File_Gamma",
    "Final_Clock",
    "Final_Frame",
    "Frame_Step",
    "Grayscale_Output",
    "Height",
    "Include_Header",
    "Include_Ini",
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

/// Keys whose value is a number.
pub(super) const NUMBERS: &[&str] = &[
    "Antialias_Depth",
    "Antialias_Gamma",
    "Antialias_Threshold",
    "Bits_Per_Color",
    "Clock",
    "Compression",
    "End_Column",
    "End_Row",
    "Final_Clock",
    "Final_Frame",
    "Frame_Step",
    "Height",
    "Initial_Clock",
    "Initial_Frame",
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

/// Keys that concern displays, the amount of messages, memory or speed, or that only matter together with others: accepted
/// without effect.
pub(super) const IGNORED: &[&str] = &[
    "All_Console",
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
    "Debug_Console",
    "Display",
    "Display_Gamma",
    "Dither_Method",
    "Draw_Vistas",
    "Fatal_Console",
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
    "Radiosity_Vain_Pretrace",
    "Remove_Bounds",
    "Render_Block_Size",
    "Render_Block_Step",
    "Render_Console",
    "Render_Pattern",
    "Split_Unions",
    "Statistic_Console",
    "Test_Abort",
    "Test_Abort_Count",
    "Verbose",
    "Video_Mode",
    "Vista_Buffer",
    "Warning_Console",
    "Warning_Level",
];

/// Histograms told the time that parts of a picture took, up to POV-Ray 3.6; version 3.7 ignores their settings, too.
const HISTOGRAMS: &str =
    "histograms are not written; `strahl heatmap` shows where a picture is costly";

/// Keys that strahl does not implement, with the note that the user gets.
pub(super) const LEFT_OUT: &[(&str, &str)] = &[
    ("All_File", "messages are not written to files"),
    ("Create_Histogram", HISTOGRAMS),
    ("Debug_File", "messages are not written to files"),
    ("Dither", "pictures are not dithered"),
    ("Fatal_File", "messages are not written to files"),
    (
        "Field_Render",
        "fields are not rendered: the picture has all rows",
    ),
    ("Histogram_Grid_Size", HISTOGRAMS),
    ("Histogram_Name", HISTOGRAMS),
    ("Histogram_Type", HISTOGRAMS),
    ("Radiosity_From_File", "radiosity is not supported"),
    ("Radiosity_To_File", "radiosity is not supported"),
    (
        "Real_Time_Raytracing",
        "pictures are not shown in real time: they are written as usual",
    ),
    ("Render_File", "messages are not written to files"),
    (
        "Statistic_File",
        "messages are not written to files; `--stats FILE` writes statistics",
    ),
    ("Warning_File", "messages are not written to files"),
];

/// Keys that run programs.
pub(super) const COMMANDS: &[&str] = &[
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

pub(super) fn spelled(key: &str) -> Option<&'static str> {
    let left_out = LEFT_OUT.iter().map(|(key, _)| key);
    let mut all = KEYS.iter().chain(IGNORED).chain(COMMANDS).chain(left_out);
    all.find(|k| k.eq_ignore_ascii_case(key)).copied()
}

/// Whether POV-Ray has a setting of this name.
pub(super) fn is_key(key: &str) -> bool {
    spelled(key).is_some()
}
