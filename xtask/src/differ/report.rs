use super::Finding;
use super::render::{Verdict, plain};
use crate::compare_pov::picture;
use anyhow::Result;
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;
use std::path::Path;

/// Words that every scene contains.
const FRAME: [&str; 8] = [
    "camera",
    "location",
    "look_at",
    "light_source",
    "rgb",
    "pigment",
    "x",
    "y",
];

/// The signature of a finding: the words of its smallest scene, or strahl's message.
pub(super) fn signature(verdict: &Verdict, smallest: &str) -> String {
    if let Verdict::OursFails(message) = verdict {
        return plain(message);
    }
    let words: BTreeSet<&str> = smallest
        .split(|c: char| !c.is_alphanumeric() && c != '_' && c != '#')
        .filter(|w| w.starts_with(|c: char| c.is_alphabetic() || c == '#'))
        .filter(|w| !FRAME.contains(w))
        .collect();
    words.into_iter().collect::<Vec<_>>().join(" ")
}

/// Describes a finding: how different the pictures are, or which program fails.
pub(super) fn describe(verdict: &Verdict) -> String {
    match verdict {
        Verdict::Same => "same".to_owned(),
        Verdict::Differs(far) => format!(
            "{:.1} % of the pixels, mean {:.1}/255",
            100.0 * far.share,
            far.mean
        ),
        Verdict::OursFails(message) => format!("strahl: {message}"),
        Verdict::TheirsFails(message) => format!("POV-Ray: {message}"),
        Verdict::Stopped(program) => format!("{program} was stopped"),
        Verdict::BothFail(message) => format!("both fail, POV-Ray: {message}"),
    }
}

/// All findings by signature, the most frequent first.
pub(super) fn groups(findings: &[Finding]) -> String {
    let mut groups: BTreeMap<String, Vec<&Finding>> = BTreeMap::new();
    for finding in findings {
        let key = match finding.known {
            Some(reason) => format!("known: {reason}"),
            None => signature(&finding.verdict, &finding.smallest),
        };
        groups.entry(key).or_default().push(finding);
    }
    let mut groups: Vec<_> = groups.into_iter().collect();
    groups.sort_by_key(|(_, members)| std::cmp::Reverse(members.len()));
    let mut out = String::new();
    for (key, members) in groups {
        let numbers: Vec<String> = members.iter().map(|f| f.number.to_string()).collect();
        let _ = writeln!(out, "{:4} {key}: {}", members.len(), numbers.join(" "));
    }
    out
}

/// Writes the smallest scene, the whole scene, and both pictures with their difference.
pub(super) fn save(finding: &Finding, folder: &Path) -> Result<()> {
    let name = |ending: &str| folder.join(format!("{:05}{ending}", finding.number));
    std::fs::write(name(".pov"), &finding.whole)?;
    std::fs::write(name("-small.pov"), &finding.smallest)?;
    if let Some((a, b)) = &finding.pictures {
        picture::write(a, &name("-povray.png"))?;
        picture::write(b, &name("-strahl.png"))?;
        picture::write_difference(a, b, &name("-difference.png"))?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_and_the_frame_are_not_in_a_signature() {
        let scene =
            "camera { location <0, 1, -4> look_at 0 }\nsphere { 0, 1 pigment { agate scale 2e3 } }";
        let far = Verdict::Same;
        assert_eq!(signature(&far, scene), "agate scale sphere");
        let fails = Verdict::OursFails("error: expected 3 (a.pov:1:2)".to_owned());
        assert_eq!(signature(&fails, scene), "error: expected ");
    }

    #[test]
    fn groups_are_sorted_by_size() {
        let finding = |number, smallest: &str| Finding {
            number,
            verdict: Verdict::Same,
            whole: String::new(),
            smallest: smallest.to_owned(),
            pictures: None,
            known: None,
        };
        let all = [
            finding(1, "torus { 1, 2 }"),
            finding(2, "box { 0, 1 }"),
            finding(3, "box { 0, 3 }"),
        ];
        assert_eq!(groups(&all), "   2 box: 2 3\n   1 torus: 1\n");
    }
}
