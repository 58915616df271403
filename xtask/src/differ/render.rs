use super::compare::{Distance, agree_at, distance, some_that_differ};
use crate::compare_pov::picture::{self, Shown};
use crate::compare_pov::programs::{Outcome, Programs, povray_reason, strahl_reason};
use anyhow::Result;
use std::path::Path;

/// The result of comparing the two programs on a scene.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Verdict {
    /// The same picture, except for shifted edges and rounding.
    Same,
    /// Different pictures.
    Differs(Distance),
    /// Only strahl fails, with this message.
    OursFails(String),
    /// Only POV-Ray fails, with this message.
    TheirsFails(String),
    /// Both fail; this is POV-Ray's message.
    BothFail(String),
    /// The time limit ended this program: nothing is known about the scene.
    Stopped(&'static str),
}

impl Verdict {
    pub(super) fn is_finding(&self) -> bool {
        matches!(self, Self::Differs(_) | Self::OursFails(_))
    }

    /// Whether both programs have rendered the scene.
    pub(super) fn is_known(&self) -> bool {
        matches!(self, Self::Same | Self::Differs(_))
    }

    /// Whether both are the same finding.
    pub(super) fn is_like(&self, before: &Self) -> bool {
        match (self, before) {
            (Self::Differs(now), Self::Differs(before)) => now.is_like(before),
            (Self::OursFails(now), Self::OursFails(before)) => plain(now) == plain(before),
            _ => false,
        }
    }
}

/// A message without its place, names and numbers.
pub(super) fn plain(message: &str) -> String {
    let text = message.split(" (").next().unwrap_or_default();
    text.chars().filter(|c| !c.is_ascii_digit()).collect()
}

/// Renders a scene with both programs.
pub(super) fn judge(programs: &Programs, text: &str) -> Result<Verdict> {
    let folder = tempfile::tempdir()?;
    Ok(judge_in(programs, text, folder.path())?.0)
}

/// A scene that both programs have been given.
pub(super) struct Judgement {
    pub(super) text: String,
    pub(super) verdict: Verdict,
    /// POV-Ray's picture and strahl's, if both have rendered it.
    pub(super) pictures: Option<(Shown, Shown)>,
}

/// The number of pixels that POV-Ray is asked to render alone.
const ALONE: usize = 12;

impl Judgement {
    /// Whether POV-Ray shows the same colours as strahl where the pictures differ if it renders nothing but the pixel: then its picture
    /// depends on the pixels before (it remembers, for one, the object that cast the last shadow).
    pub(super) fn shown_alone(&self, programs: &Programs) -> Result<bool> {
        let Some((theirs, ours)) = &self.pictures else {
            return Ok(false);
        };
        let folder = tempfile::tempdir()?;
        let (scene, picture) = (
            folder.path().join("scene.pov"),
            folder.path().join("pixel.png"),
        );
        std::fs::write(&scene, &self.text)?;
        let pixels = some_that_differ(theirs, ours, ALONE);
        for pixel in &pixels {
            let outcome = programs.run_povray_on(&scene, folder.path(), &picture, Some(*pixel))?;
            if !outcome.rendered || !agree_at(&picture::read(&picture)?, ours, *pixel) {
                return Ok(false);
            }
        }
        Ok(!pixels.is_empty())
    }
}

/// Renders a scene with both programs and keeps the pictures.
pub(super) fn judgement(programs: &Programs, text: &str) -> Result<Judgement> {
    let folder = tempfile::tempdir()?;
    let (verdict, pictures) = judge_in(programs, text, folder.path())?;
    Ok(Judgement {
        text: text.to_owned(),
        verdict,
        pictures,
    })
}

/// Renders a scene in a folder, where the pictures stay: `scene.pov`, `povray.png`, `strahl.png`.
fn judge_in(
    programs: &Programs,
    text: &str,
    folder: &Path,
) -> Result<(Verdict, Option<(Shown, Shown)>)> {
    let scene = folder.join("scene.pov");
    std::fs::write(&scene, text)?;
    let (theirs, ours) = (folder.join("povray.png"), folder.join("strahl.png"));
    let strahl = programs.run_strahl(&scene, folder, &ours)?;
    let povray = programs.run_povray(&scene, folder, &theirs)?;
    if let Some(verdict) = failure(&povray, &strahl) {
        return Ok((verdict, None));
    }
    let (a, b) = (picture::read(&theirs)?, picture::read(&ours)?);
    let verdict = match distance(&a, &b) {
        Some(far) if far.counts() => Verdict::Differs(far),
        Some(_) => Verdict::Same,
        None => Verdict::OursFails("another size".to_owned()),
    };
    Ok((verdict, Some((a, b))))
}

/// The verdict if not both programs have rendered the scene.
fn failure(povray: &Outcome, strahl: &Outcome) -> Option<Verdict> {
    let stopped = [("POV-Ray", povray), ("strahl", strahl)];
    if let Some((program, _)) = stopped.iter().find(|(_, outcome)| outcome.stopped) {
        return Some(Verdict::Stopped(program));
    }
    match (povray.rendered, strahl.rendered) {
        (true, true) => None,
        (true, false) => Some(Verdict::OursFails(strahl_reason(&strahl.reason))),
        (false, true) => Some(Verdict::TheirsFails(povray_reason(&povray.reason))),
        (false, false) => Some(Verdict::BothFail(povray_reason(&povray.reason))),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn findings_are_alike_by_kind_and_message() {
        let fails = |text: &str| Verdict::OursFails(text.to_owned());
        let a = fails("error: no inside (scene.pov:3:5)");
        assert!(a.is_like(&fails("error: no inside (scene.pov:12:1)")));
        assert!(!a.is_like(&fails("error: unknown word (scene.pov:3:5)")));
        assert!(!a.is_like(&Verdict::Same));
        assert!(a.is_finding() && !Verdict::TheirsFails(String::new()).is_finding());
    }

    #[test]
    fn a_program_that_is_stopped_is_not_a_finding() {
        let outcome = |rendered: bool, stopped: bool| Outcome {
            rendered,
            stopped,
            seconds: 1.0,
            reason: "error: of some kind".to_owned(),
            lacks: std::collections::BTreeSet::new(),
        };
        assert_eq!(failure(&outcome(true, false), &outcome(true, false)), None);
        let fails = failure(&outcome(true, false), &outcome(false, false)).unwrap();
        assert!(fails.is_finding());
        let verdict = failure(&outcome(true, false), &outcome(false, true)).unwrap();
        assert_eq!(verdict, Verdict::Stopped("strahl"));
        assert!(!verdict.is_finding());
        assert!(!verdict.is_like(&verdict));
    }
}
