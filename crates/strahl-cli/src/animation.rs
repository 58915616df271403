//! Frames and clocks of an animation, numbered and timed as in POV-Ray (reference manual, 3.2.1, and experiments).

use crate::args::AnimationArgs;
use crate::input::Moment;
use crate::report::Failure;
use std::path::{Path, PathBuf};
use strahl::sdl::Frame;

/// The frames of an animation.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Animation {
    /// The frames to render, in order; never empty.
    pub(crate) frames: Vec<u32>,
    /// First and last frame and their clocks, which scenes can read.
    first: u32,
    last: u32,
    clocks: (f64, f64),
}

/// The largest frame number. A larger one is certainly a typing error.
const MOST_FRAMES: u32 = 1_000_000;

impl Animation {
    /// The animation that the options ask for, or one frame of it; `None` for a single picture.
    pub(crate) fn new(args: &AnimationArgs, only: Option<u32>) -> Result<Option<Self>, Failure> {
        let Some(mut animation) = Self::of(args)? else {
            return Ok(None);
        };
        if let Some(frame) = only {
            if !animation.frames.contains(&frame) {
                return Err(Failure::new(format!("the animation has no frame {frame}")));
            }
            animation.frames = vec![frame];
        }
        Ok(Some(animation))
    }

    /// The animation of these frames, with the clocks of the options.
    pub(crate) fn range(args: &AnimationArgs, first: u32, last: u32) -> Result<Self, Failure> {
        let args = AnimationArgs {
            initial_frame: Some(first),
            final_frame: Some(last),
            ..args.clone()
        };
        Self::of(&args)?.ok_or_else(|| Failure::new("a film needs a frame above 0"))
    }

    /// All frames of the animation.
    fn of(args: &AnimationArgs) -> Result<Option<Self>, Failure> {
        let first = match (args.initial_frame, args.final_frame) {
            // As in POV-Ray, a last frame of 0 switches the animation off.
            (None | Some(0), None) | (_, Some(0)) => return Ok(None),
            (first, _) => first.unwrap_or(1),
        };
        let last = args.final_frame.unwrap_or(first);
        if last < first {
            return Err(Failure::new(format!(
                "the final frame, {last}, comes before the initial frame, {first}"
            )));
        }
        if last >= MOST_FRAMES {
            return Err(Failure::new(format!(
                "the final frame is {last}; the largest possible number is {MOST_FRAMES}"
            )));
        }
        let count = f64::from(last - first + 1);
        let begin = subset(args.subset_start_frame, first, count, first, "start")?;
        let end = match args.subset_end_frame {
            // 1.0 means all frames.
            Some(1.0) if first != 1 => last,
            end => subset(end, first, count, last, "end")?,
        };
        if begin > last || end > last || begin > end {
            return Err(Failure::new(format!(
                "there is nothing to render: the animation has the frames {first} to {last}, the subset is {begin} to {end}"
            )));
        }
        Ok(Some(Self {
            frames: (begin..=end).step_by(args.frame_step as usize).collect(),
            first,
            // The frame after the last one would be the first one again.
            last: last + u32::from(args.cyclic),
            clocks: (args.initial_clock, args.final_clock),
        }))
    }

    /// The clock and the frame variables of a frame.
    pub(crate) fn moment(&self, frame: u32) -> Moment {
        let (begin, end) = self.clocks;
        let steps = self.last - self.first;
        // A single frame has no step (where POV-Ray divides by zero).
        let delta = match steps {
            0 => 0.0,
            _ => (end - begin) / f64::from(steps),
        };
        let done = frame.saturating_sub(self.first);
        Moment {
            clock: begin + delta * f64::from(done),
            frame: Frame {
                animated: true,
                number: f64::from(frame),
                first: f64::from(self.first),
                last: f64::from(self.last),
                initial_clock: begin,
                final_clock: end,
                clock_delta: delta,
            },
        }
    }

    /// Digits of the numbers in the names of files.
    pub(crate) fn digits(&self) -> usize {
        self.last.to_string().len()
    }

    /// The file of a frame: the frame's number, as wide as that of the final frame, stands before the extension.
    pub(crate) fn file(&self, output: &Path, frame: u32) -> PathBuf {
        let width = self.digits();
        let stem = output.file_stem().unwrap_or_default().to_string_lossy();
        let ending = output.extension().unwrap_or_default().to_string_lossy();
        let dot = if ending.is_empty() { "" } else { "." };
        output.with_file_name(format!("{stem}{frame:0width$}{dot}{ending}"))
    }
}

/// A frame given by its number or as a fraction of all frames.
///
/// POV-Ray uses floor(fraction x count) as the number, without adding the initial frame; the result here is the same if the
/// initial frame is 1, and is what the user meant otherwise.
fn subset(
    given: Option<f64>,
    first: u32,
    count: f64,
    default: u32,
    which: &str,
) -> Result<u32, Failure> {
    let Some(given) = given else {
        return Ok(default);
    };
    let number = if given < 1.0 {
        let offset = f64::from(first) - 1.0;
        (offset + (given * count).floor()).max(f64::from(first))
    } else {
        given
    };
    if !(0.0..=f64::from(MOST_FRAMES)).contains(&given) || number.fract() != 0.0 {
        return Err(Failure::new(format!(
            "the subset's {which} frame must be a frame's number or a fraction from 0.0 to 1.0, not {given}"
        )));
    }
    Ok((number as u32).max(first))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::args::{Cli, Command};
    use clap::Parser;

    fn animation(words: &str) -> Result<Option<Animation>, Failure> {
        let words = ["strahl", "render"]
            .into_iter()
            .chain(words.split_whitespace());
        let Command::Render(args) = Cli::try_parse_from(words).unwrap().command else {
            panic!("it is `render`");
        };
        Animation::new(&args.animation, None)
    }

    fn clocks(words: &str) -> Vec<(u32, f64)> {
        let animation = animation(words).unwrap().unwrap();
        let frames = animation.frames.iter();
        frames.map(|f| (*f, animation.moment(*f).clock)).collect()
    }

    #[test]
    fn clocks_are_spread_over_the_frames() {
        assert_eq!(clocks("--final-frame 3"), [(1, 0.0), (2, 0.5), (3, 1.0)]);
        let negative = clocks("--final-frame 2 --initial-clock -.5 --final-clock -2.5e-1");
        assert_eq!(negative, [(1, -0.5), (2, -0.25)]);
        let cyclic = clocks("--final-frame 4 --cyclic");
        assert_eq!(cyclic, [(1, 0.0), (2, 0.25), (3, 0.5), (4, 0.75)]);
        let part = "--initial-frame 5 --final-frame 13 --subset-start-frame 7 --subset-end-frame 9 \
                    --initial-clock 2 --final-clock 4";
        assert_eq!(clocks(part), [(7, 2.5), (8, 2.75), (9, 3.0)]);
        assert_eq!(
            clocks("--final-frame 9 --frame-step 4"),
            [(1, 0.0), (5, 0.5), (9, 1.0)]
        );
        assert_eq!(clocks("--initial-frame 3 --initial-clock 7"), [(3, 7.0)]);
    }

    #[test]
    fn scenes_see_the_whole_animation() {
        let moment = animation("--final-frame 3 --cyclic")
            .unwrap()
            .unwrap()
            .moment(2);
        let expected = Frame {
            animated: true,
            number: 2.0,
            first: 1.0,
            last: 4.0,
            initial_clock: 0.0,
            final_clock: 1.0,
            clock_delta: 1.0 / 3.0,
        };
        assert_eq!(moment.frame, expected);
    }

    /// The numbers are those of POV-Ray 3.7.
    #[test]
    fn subsets_may_be_parts() {
        let frames = |words: &str| animation(words).unwrap().unwrap().frames;
        let ten = |words: &str| frames(&format!("--final-frame 10 {words}"));
        assert_eq!(
            ten("--subset-start-frame 0.25 --subset-end-frame 0.667"),
            [2, 3, 4, 5, 6]
        );
        assert_eq!(ten("--subset-end-frame 0.2"), [1, 2]);
        assert_eq!(ten("--subset-start-frame 0.99"), [9, 10]);
        assert_eq!(ten("--subset-end-frame 1"), [1]);
        assert_eq!(ten("--subset-start-frame 0.1 --subset-end-frame 0.1"), [1]);
        assert_eq!(
            frames("--initial-frame 0 --final-frame 2 --subset-end-frame 0.7"),
            [0, 1]
        );
    }

    #[test]
    fn files_are_numbered_as_wide_as_the_last() {
        let name = |words: &str, frame| {
            let animation = animation(words).unwrap().unwrap();
            animation.file(Path::new("out/a.b.png"), frame)
        };
        assert_eq!(name("--final-frame 3", 2), Path::new("out/a.b2.png"));
        assert_eq!(name("--final-frame 102", 7), Path::new("out/a.b007.png"));
        // The frame that closes a cyclic animation counts as a frame.
        assert_eq!(
            name("--final-frame 9 --cyclic", 9),
            Path::new("out/a.b09.png")
        );
    }

    #[test]
    fn impossible_animations_are_refused() {
        assert_eq!(animation("").unwrap(), None);
        assert_eq!(animation("--final-frame 0").unwrap(), None);
        assert_eq!(animation("--initial-frame 0").unwrap(), None);
        for bad in [
            "--initial-frame 5 --final-frame 2",
            "--final-frame 4000000000",
            "--final-frame 9 --subset-start-frame 10",
            "--final-frame 9 --subset-start-frame 5 --subset-end-frame 4",
            "--final-frame 9 --subset-start-frame 2.5",
            "--final-frame 9 --subset-start-frame nan",
        ] {
            assert!(animation(bad).is_err(), "{bad}");
        }
    }
}
