//! The destination of a picture: a file or the standard output.

use crate::animation::Animation;
use crate::args::RenderArgs;
use crate::input::Input;
use crate::interrupt::{Interruptible, pressed};
use crate::output::{self, is_standard};
use crate::report::Failure;
use std::io::{self, IsTerminal};
use std::path::{Path, PathBuf};
use strahl::formats::image::{
    FormatInfo, ImageError, ImageFormat, Picture, WriteOptions, encode_picture, formats, write_file,
};

/// The destination of a picture and its format.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Target {
    File(PathBuf, ImageFormat),
    /// The standard output; the pictures of an animation follow each other.
    Stream(ImageFormat),
}

/// The files that statistics and profile go to. (A profile without a file is a table on the terminal.)
fn report_files(args: &RenderArgs) -> impl Iterator<Item = &Path> {
    let profile = args.profile.iter().flatten();
    args.stats.iter().chain(profile).map(PathBuf::as_path)
}

impl Target {
    /// The destination of `render`'s picture.
    pub(crate) fn of(args: &RenderArgs) -> Result<Self, Failure> {
        let format = args.picture_format;
        let own = || {
            let of_tile = args.tile.and_then(|_| ImageFormat::from_name("exr"));
            let format = format.or(of_tile).unwrap_or(formats()[0].format);
            let place = match args.tile {
                Some(tile) => format!("-{}of{}", tile.number, tile.count),
                None => String::new(),
            };
            let name = format!(
                "{}{place}.{}",
                scene_name(args)?,
                format.info().extensions[0]
            );
            Ok((PathBuf::from(name), format))
        };
        let Some(output) = &args.output else {
            let (name, format) = own()?;
            return Ok(Self::File(name, format));
        };
        if output.as_os_str() == "-" {
            return Ok(Self::Stream(format.unwrap_or(formats()[0].format)));
        }
        let text = output.to_string_lossy();
        if output.is_dir() || text.ends_with(['/', std::path::MAIN_SEPARATOR]) {
            let (name, format) = own()?;
            return Ok(Self::File(output.join(name), format));
        }
        let format = match format {
            Some(format) => format,
            None => ImageFormat::from_path(output).map_err(Failure::new)?,
        };
        Ok(Self::File(output.clone(), format))
    }

    /// The destination of a picture that is not `render`'s.
    pub(crate) fn named(output: &Path, format: Option<ImageFormat>) -> Result<Self, Failure> {
        if output.as_os_str() == "-" {
            return Ok(Self::Stream(format.unwrap_or(formats()[0].format)));
        }
        let format = match format {
            Some(format) => format,
            None => ImageFormat::from_path(output).map_err(Failure::new)?,
        };
        check_folder(output)?;
        Ok(Self::File(output.to_owned(), format))
    }

    pub(crate) fn format(&self) -> ImageFormat {
        match self {
            Self::File(_, format) | Self::Stream(format) => *format,
        }
    }

    /// The file; `None` for the standard output.
    pub(crate) fn file(&self) -> Option<&Path> {
        match self {
            Self::File(file, _) => Some(file),
            Self::Stream(_) => None,
        }
    }

    /// The name shown to the user.
    pub(crate) fn shown(&self) -> String {
        match self {
            Self::File(file, _) => file.display().to_string(),
            Self::Stream(_) => "standard output".to_owned(),
        }
    }

    /// The destination of a frame of an animation.
    pub(crate) fn of_frame(&self, animation: &Animation, frame: u32) -> Self {
        match self {
            Self::File(file, format) => Self::File(animation.file(file, frame), *format),
            Self::Stream(format) => Self::Stream(*format),
        }
    }

    /// Checks before rendering whether the picture can be written.
    pub(crate) fn check(&self, args: &RenderArgs, animated: bool) -> Result<(), Failure> {
        let shown = self.shown();
        if args.layers && !self.format().info().layers {
            return Err(Failure::new(format!(
                "--layers needs a format with layers ({}), but the picture is {shown}",
                endings(|info| info.layers)
            )));
        }
        if args.tile.is_some() && self.file().is_none_or(|_| !self.format().info().layers) {
            return Err(Failure::new(format!(
                "--tile writes an EXR file, which keeps all bits, but the picture is {shown}: end its name in .exr"
            )));
        }
        self.check_grayscale(args.grayscale)?;
        if args.alpha && !self.format().info().alpha {
            return Err(Failure::new(format!(
                "--alpha needs a format with an alpha channel ({}), but the picture is {shown}",
                endings(|info| info.alpha)
            )));
        }
        for (option, is_given) in [
            ("--stats", args.stats.is_some()),
            ("--profile", args.profile.is_some()),
        ] {
            if animated && is_given {
                return Err(Failure::new(format!(
                    "{option} works for a single picture: render the frames one by one with --subset-start-frame and \
                     --subset-end-frame, or leave it out",
                )));
            }
        }
        let named = || report_files(args);
        let streams = named().filter(|file| is_standard(file)).count();
        if streams > 1 {
            return Err(Failure::new(
                "statistics and profile can't both go to the standard output: name a file for one of them",
            ));
        }
        match self {
            Self::Stream(_) if !args.no_output && io::stdout().is_terminal() => {
                return Err(Failure::new(
                    "a picture can't be printed on a terminal: pipe it to a program, as in `strahl render scene.pov -o - | display`",
                ));
            }
            Self::Stream(_) if streams > 0 => {
                return Err(Failure::new(
                    "picture and statistics or profile can't both go to the standard output: name a file for one of them",
                ));
            }
            Self::Stream(_) | Self::File(..) => {}
        }
        let picture = self.file().filter(|_| !args.no_output);
        let files: Vec<&Path> = named().filter(|file| !is_standard(file)).collect();
        check_distinct(&picture.into_iter().chain(files.clone()).collect::<Vec<_>>())?;
        for file in self.file().into_iter().chain(files) {
            check_folder(file)?;
        }
        Ok(())
    }

    /// Checks that the format stores grey values, if they are asked for.
    pub(crate) fn check_grayscale(&self, is_asked: bool) -> Result<(), Failure> {
        if is_asked && !self.format().info().grayscale {
            return Err(Failure::new(format!(
                "--grayscale needs a format with grey pictures ({}), but the picture is {}",
                endings(|info| info.grayscale),
                self.shown()
            )));
        }
        Ok(())
    }

    /// The scene of `render`, which the picture must not overwrite.
    pub(crate) fn input<'a>(&self, args: &'a RenderArgs) -> Result<Input<'a>, Failure> {
        let scene = args.scene.as_deref();
        let input = Input::new(scene, args.format, &args.pov, args.picture.size)?
            .at_quality(args.picture.quality);
        self.spares(&input, args)?;
        Ok(input)
    }

    /// Checks that the picture does not overwrite the scene itself, which would be a typing error.
    fn spares(&self, input: &Input<'_>, args: &RenderArgs) -> Result<(), Failure> {
        let mut files = self.file().into_iter().chain(report_files(args));
        files.try_for_each(|file| spare(input, file))
    }

    /// Writes a picture. Ctrl-C ends this too, and leaves no partial file.
    pub(crate) fn write(
        &self,
        picture: &Picture<'_>,
        options: &WriteOptions,
    ) -> Result<(), Failure> {
        let format = self.format();
        let failed = |error| match pressed() {
            true => Failure::Interrupted,
            false => Failure::new(error),
        };
        match self {
            Self::File(file, _) => write_file(file, |writer| {
                encode_picture(&mut Interruptible(writer), format, picture, options).map_err(
                    |error| match error {
                        ImageError::Write { source, .. } => source,
                        other => io::Error::other(other),
                    },
                )
            })
            .map_err(failed),
            Self::Stream(_) => {
                let mut bytes = vec![];
                encode_picture(&mut Interruptible(&mut bytes), format, picture, options)
                    .map_err(failed)?;
                output::bytes(&bytes)
            }
        }
    }
}

/// The scene's name without folder and extensions.
fn scene_name(args: &RenderArgs) -> Result<String, Failure> {
    let Some(scene) = &args.scene else {
        return Ok("demo".to_owned());
    };
    let name = scene.file_name().filter(|name| *name != "-");
    let Some(name) = name.and_then(|n| n.to_str()) else {
        return Err(Failure::new("the picture has no name: add -o PICTURE"));
    };
    let stem = name.strip_suffix(".gz").unwrap_or(name);
    let stem = stem.rsplit_once('.').map_or(stem, |(stem, _)| stem);
    Ok(stem.to_owned())
}

/// Checks that a file is not the scene itself.
pub(crate) fn spare(input: &Input<'_>, file: &Path) -> Result<(), Failure> {
    let real = |path: &Path| path.canonicalize().ok();
    let scene = input.path().and_then(real);
    match scene.is_some() && real(file) == scene {
        true => Err(Failure::new(format!(
            "{} is the scene itself, which must not be overwritten",
            file.display()
        ))),
        false => Ok(()),
    }
}

/// Checks that files to be written are different ones: the last would replace the others.
pub(crate) fn check_distinct(files: &[&Path]) -> Result<(), Failure> {
    // Devices such as /dev/null take more than one.
    let is_device = |file: &&Path| file.exists() && !file.is_file();
    let files: Vec<&Path> = files.iter().copied().filter(|f| !is_device(f)).collect();
    for (number, file) in files.iter().enumerate() {
        let place = place(file);
        if files[..number]
            .iter()
            .any(|other| self::place(other) == place)
        {
            return Err(Failure::new(format!(
                "{} is named twice: picture, statistics and profile need a file each",
                file.display()
            )));
        }
    }
    Ok(())
}

/// Where a file is, or will be.
fn place(file: &Path) -> PathBuf {
    if let Ok(place) = file.canonicalize() {
        return place;
    }
    let folder = match file.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    };
    let name = file.file_name().unwrap_or_default();
    folder
        .canonicalize()
        .map_or_else(|_| file.to_owned(), |folder| folder.join(name))
}

/// The endings of the formats that can do something, such as `.png, .exr`.
fn endings(able: impl Fn(&FormatInfo) -> bool) -> String {
    let able = formats().iter().filter(|info| able(info));
    let all: Vec<String> = able
        .map(|info| format!(".{}", info.extensions[0]))
        .collect();
    all.join(", ")
}

/// Checks that a file's folder exists, which is cheaper before the render than after it.
pub(crate) fn check_folder(file: &Path) -> Result<(), Failure> {
    match file.parent() {
        Some(folder) if !folder.as_os_str().is_empty() && !folder.is_dir() => {
            Err(Failure::new(format!(
                "cannot write {}: there is no folder {}",
                file.display(),
                folder.display()
            )))
        }
        _ => Ok(()),
    }
}
