//! Renders random scenes with POV-Ray and strahl, and reduces those that differ to the smallest scene that still does.

mod compare;
mod dice;
mod grammar;
mod known;
mod node;
mod reduce;
mod render;
mod report;

use crate::arguments::Arguments;
use crate::compare_pov::picture::Shown;
use crate::compare_pov::programs::Programs;
use crate::parallel::in_parallel;
use anyhow::{Context, Result, bail};
use node::Node;
use render::{Verdict, judgement};
use std::collections::BTreeMap;
use std::path::PathBuf;
use std::time::{Duration, Instant};

/// The size of the pictures. They are small: many scenes find more than many pixels.
const SIZE: (u32, u32) = (32, 24);

/// The default time limit of a program for a scene, in seconds: a hundred times what a scene takes, because the machine may be busy.
const TIMEOUT: u64 = 60;

/// The largest number of scenes that a reduction tries.
const TRIES: usize = 1500;

/// A scene on which the programs disagree.
struct Finding {
    number: u64,
    verdict: Verdict,
    whole: String,
    smallest: String,
    /// POV-Ray's picture of the smallest scene, and strahl's.
    pictures: Option<(Shown, Shown)>,
    known: Option<&'static str>,
}

struct Options {
    seed: u64,
    first: u64,
    count: u64,
    jobs: usize,
    out: PathBuf,
    strahl: Option<PathBuf>,
    print: bool,
    timeout: Duration,
}

impl Options {
    fn new(args: &[&str]) -> Result<Self> {
        let mut options = Self {
            seed: 1,
            first: 0,
            count: 200,
            jobs: 8,
            out: PathBuf::from("target/differ"),
            strahl: None,
            print: false,
            timeout: Duration::from_secs(TIMEOUT),
        };
        let mut args = Arguments::new(args);
        while let Some(option) = args.option() {
            match option {
                "--seed" => options.seed = args.number()?,
                "--first" => options.first = args.number()?,
                "--count" => options.count = args.number()?,
                "--jobs" => options.jobs = args.number::<usize>()?.max(1),
                "--out" => options.out = PathBuf::from(args.value()?),
                "--strahl" => options.strahl = Some(PathBuf::from(args.value()?)),
                "--print" => options.print = true,
                "--timeout" => options.timeout = Duration::from_secs(args.number()?),
                other => bail!(
                    "unknown option {other}: differ takes --seed N --first N --count M --jobs J --out DIR \
                     --strahl BINARY --timeout SECONDS --print"
                ),
            }
        }
        Ok(options)
    }
}

/// `cargo xtask differ`
pub(crate) fn run(args: &[&str]) -> Result<()> {
    let options = Options::new(args)?;
    let numbers: Vec<u64> = (options.first..options.first + options.count).collect();
    if options.print {
        for number in numbers {
            print!("{}", grammar::scene(options.seed, number).text());
        }
        return Ok(());
    }
    let mut programs = Programs::new(SIZE, options.strahl.as_deref())?;
    programs.timeout = options.timeout;
    std::fs::create_dir_all(&options.out)
        .with_context(|| format!("cannot create {}", options.out.display()))?;
    let start = Instant::now();
    let verdicts = in_parallel(&numbers, options.jobs, |_, number| {
        render::judge(&programs, &grammar::scene(options.seed, *number).text())
    })?;
    let seconds = start.elapsed().as_secs_f64();
    totals(&numbers, &verdicts, seconds);

    let mut findings = vec![];
    for (number, verdict) in numbers.iter().zip(verdicts) {
        if verdict.is_finding() {
            let finding = examine(&options, &programs, *number, verdict)?;
            println!(
                "\n--- {number}: {}{}\n{}",
                report::describe(&finding.verdict),
                finding
                    .known
                    .map_or_else(String::new, |r| format!(" (known: {r})")),
                finding.smallest
            );
            report::save(&finding, &options.out)?;
            findings.push(finding);
        }
    }
    let unknown = findings.iter().filter(|f| f.known.is_none()).count();
    println!(
        "\n{} scenes differ, {unknown} of them without a known reason, grouped by the words of their smallest scenes:",
        findings.len()
    );
    print!("{}", report::groups(&findings));
    println!("scenes and pictures: {}", options.out.display());
    if unknown > 0 {
        bail!("{unknown} of {} scenes differ", numbers.len());
    }
    Ok(())
}

/// Looks for the reason of a difference, and if none is known for the smallest scene that differs in the same way.
fn examine(
    options: &Options,
    programs: &Programs,
    number: u64,
    verdict: Verdict,
) -> Result<Finding> {
    let scene = grammar::scene(options.seed, number);
    let nudged = judgement(programs, &nudged_text(&scene))?;
    let (whole, known) = if !nudged.verdict.is_finding() && nudged.verdict.is_known() {
        let reason = "rounding decides: it goes away if all coordinates change by 0.0001";
        (judgement(programs, &scene.text())?, Some(reason))
    } else if !nudged.verdict.is_finding() {
        // The programs don't take such numbers here.
        let smallest = smallest(options, programs, &scene, Node::text, &verdict)?;
        (judgement(programs, &smallest)?, None)
    } else if nudged.shown_alone(programs)? {
        (nudged, Some(ALONE))
    } else {
        let smallest = smallest(options, programs, &scene, nudged_text, &nudged.verdict)?;
        (judgement(programs, &smallest)?, None)
    };
    let known = match known.or_else(|| known::reason(&whole.text)) {
        None if whole.shown_alone(programs)? => Some(ALONE),
        known => known,
    };
    Ok(Finding {
        number,
        verdict: whole.verdict,
        whole: scene.text(),
        known,
        smallest: whole.text,
        pictures: whole.pictures,
    })
}

const ALONE: &str = "POV-Ray shows the same as strahl if it renders the pixels alone";

fn nudged_text(scene: &Node) -> String {
    scene.nudged().text()
}

/// The smallest scene that differs in the same way.
fn smallest(
    options: &Options,
    programs: &Programs,
    scene: &Node,
    write: fn(&Node) -> String,
    verdict: &Verdict,
) -> Result<String> {
    let mut failed = None;
    let is_known = |text: &str| known::reason(text).is_some();
    let smallest = reduce::reduce(scene, options.jobs, TRIES, write, is_known, |texts| {
        let all = in_parallel(texts, options.jobs, |_, text| render::judge(programs, text));
        match all {
            Ok(all) => all.iter().map(|now| now.is_like(verdict)).collect(),
            Err(error) => {
                failed.get_or_insert(error);
                vec![false; texts.len()]
            }
        }
    });
    match failed {
        Some(error) => Err(error),
        None => Ok(write(&smallest)),
    }
}

fn totals(numbers: &[u64], verdicts: &[Verdict], seconds: f64) {
    let mut counts: BTreeMap<&str, usize> = BTreeMap::new();
    let mut theirs: BTreeMap<String, Vec<u64>> = BTreeMap::new();
    let mut stopped: BTreeMap<&str, Vec<u64>> = BTreeMap::new();
    let mut found = vec![];
    for (number, verdict) in numbers.iter().zip(verdicts) {
        let kind = match verdict {
            Verdict::Same => "look the same",
            Verdict::Differs(_) => "differ",
            Verdict::OursFails(_) => "fail in strahl only",
            Verdict::Stopped(_) => "exceed the time limit",
            Verdict::TheirsFails(message) => {
                let message = render::plain(message);
                theirs.entry(message).or_default().push(*number);
                "fail in POV-Ray only"
            }
            Verdict::BothFail(message) => {
                let message = render::plain(message);
                theirs.entry(message).or_default().push(*number);
                "fail in both"
            }
        };
        if let Verdict::Stopped(program) = verdict {
            stopped.entry(program).or_default().push(*number);
        }
        if verdict.is_finding() {
            found.push(*number);
        }
        *counts.entry(kind).or_default() += 1;
    }
    println!("{} scenes in {seconds:.0} s:", numbers.len());
    for (kind, count) in counts {
        println!("{count:6} {kind}");
    }
    println!("  looked at one by one below: {found:?}");
    for (program, numbers) in stopped {
        println!("  {program} was stopped: {numbers:?}");
    }
    for (message, numbers) in theirs {
        println!(
            "  POV-Ray ({} times, {:?}): {message}",
            numbers.len(),
            numbers[0]
        );
    }
}
