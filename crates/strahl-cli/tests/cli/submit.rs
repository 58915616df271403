//! `strahl submit`: job folders, their tasks and merges. The schedulers themselves are in `scripts/farm.sh`.

use super::{Path, fails, stderr, strahl};
use serde_json::Value;
use std::fs;
use std::process::Output;

const SCENE: &str = "\
#version 3.7;
global_settings { assumed_gamma 1 }
#include \"ball.inc\"
camera { location <0, 2, -6> look_at <0, 0.7, 0> }
light_source { <4, 8, -6> rgb 1 }
plane { y, 0 pigment { checker rgb 0.9 rgb 0.1 } finish { reflection 0.2 } }
sphere { <0, 1 + clock, 0>, R pigment { rgb <1, 0.5, 0> } }
";

fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    fs::create_dir(folder.path().join("lib")).expect("writable");
    fs::write(folder.path().join("scene.pov"), SCENE).expect("writable");
    fs::write(folder.path().join("lib/ball.inc"), "#declare R = 1;").expect("writable");
    folder
}

fn call(folder: &Path, words: &str) -> Output {
    let words: Vec<&str> = words.split_whitespace().collect();
    strahl(folder, &words)
}

fn run(folder: &Path, words: &str) -> String {
    let output = call(folder, words);
    assert!(output.status.success(), "{words}: {}", stderr(&output));
    String::from_utf8(output.stdout).expect("UTF-8")
}

fn failure(folder: &Path, words: &str) -> String {
    let output = call(folder, words);
    assert_eq!(
        output.status.code(),
        Some(1),
        "{words}: {}",
        stderr(&output)
    );
    stderr(&output)
}

fn json(bytes: &[u8]) -> Value {
    serde_json::from_slice(bytes).expect("JSON")
}

fn status(folder: &Path, job: &str) -> Value {
    json(run(folder, &format!("submit status {job} --json")).as_bytes())
}

const STILL: &str =
    "submit slurm scene.pov -o still.png +W100 +H70 +A0.2 -Llib --tiles 3 --dry-run --quiet";

#[test]
fn a_still_is_the_picture_of_one_process() {
    let folder = folder();
    let f = folder.path();
    run(f, STILL);
    let script = fs::read_to_string(f.join("still.job/render.sbatch")).unwrap();
    assert!(
        script.contains("SLURM_ARRAY_JOB_ID}_${SLURM_ARRAY_TASK_ID"),
        "{script}"
    );
    // The job needs nothing but its folder.
    run(
        f,
        "render scene.pov -o whole.png +W100 +H70 +A0.2 -Llib --quiet --stats whole.json",
    );
    fs::remove_file(f.join("lib/ball.inc")).unwrap();
    fs::rename(f.join("scene.pov"), f.join("gone.pov")).unwrap();
    for task in [3, 1] {
        run(f, &format!("submit task still.job --task {task}"));
    }
    let so_far = status(f, "still.job");
    assert_eq!(
        (&so_far["done"], &so_far["missing"][0]["name"]),
        (&2.into(), &"t2".into())
    );
    let problem = failure(f, "submit merge still.job");
    assert!(
        problem.contains("tile 2 of 3 is missing") && problem.contains("resume"),
        "{problem}"
    );
    assert!(!f.join("still.png").exists());
    assert!(run(f, "submit resume still.job --dry-run").contains("--array=2 "));
    run(f, "submit task still.job --task 2");
    run(f, "submit merge still.job");
    let outcome = json(&fs::read(f.join("still.job/result.json")).unwrap());
    let whole = json(&fs::read(f.join("whole.json")).unwrap());
    assert_eq!(outcome["pictures"][0]["sha256"], whole["image"]["sha256"]);
    assert!(run(f, "submit resume still.job").contains("all parts are done"));
    assert_eq!(status(f, "still.job")["merged"], Value::Bool(true));
}

#[test]
fn truncated_and_foreign_tiles_are_rendered_again() {
    let folder = folder();
    let f = folder.path();
    run(f, STILL);
    for task in 1..=3 {
        run(f, &format!("submit task still.job --task {task}"));
    }
    // An earlier job in the same folder with other settings, one of whose tiles comes late.
    fs::rename(f.join("still.job"), f.join("old.job")).unwrap();
    run(f, &STILL.replace("+A0.2", "-A"));
    for tile in ["t1", "t2", "t3"] {
        let name = |job: &str| f.join(format!("{job}.job/tiles/{tile}.exr"));
        fs::copy(name("old"), name("still")).unwrap();
    }
    let problem = failure(f, "submit merge still.job");
    assert_eq!(problem.matches("of another job").count(), 3, "{problem}");
    assert_eq!(status(f, "still.job")["done"], 0);
    for task in 1..=3 {
        let said = run(f, &format!("submit task still.job --task {task}"));
        assert!(said.contains("rendered again"), "{said}");
    }
    assert!(run(f, "submit task still.job --task 1").contains("complete already"));
    let tile = f.join("still.job/tiles/t3.exr");
    let bytes = fs::read(&tile).unwrap();
    fs::write(&tile, &bytes[..bytes.len() / 2]).unwrap();
    assert!(run(f, "submit resume still.job --dry-run").contains("--array=3 "));
    assert!(failure(f, "submit merge still.job").contains("t3.exr"));
    run(f, "submit task still.job --task 3");
    run(f, "submit merge still.job");
}

#[test]
fn a_film_has_the_frames_of_one_process() {
    let folder = folder();
    let f = folder.path();
    fs::write(
        f.join("film.ini"),
        "Input_File_Name=scene.pov\nWidth=64\nHeight=48\nInitial_Frame=0\nFinal_Frame=11\nFinal_Clock=2\nCyclic_Animation=on\nLibrary_Path=lib\n",
    )
    .unwrap();
    run(
        f,
        "submit slurm film.ini -o film.png --chunk 5 --frames 0-10 --dry-run --quiet",
    );
    for task in 1..=3 {
        run(f, &format!("submit task film.job --task {task}"));
    }
    run(f, "submit merge film.job");
    run(f, "film.ini -o one.png --quiet");
    for frame in 0..=10 {
        let read = |stem: &str| fs::read(f.join(format!("{stem}{frame:02}.png"))).unwrap();
        // The metadata name the scene, whose place differs.
        let pixels = |bytes: Vec<u8>| {
            let at = bytes
                .windows(4)
                .position(|w| w == b"IDAT")
                .expect("a picture");
            bytes[at..].to_vec()
        };
        assert!(pixels(read("film")) == pixels(read("one")), "{frame}");
    }
    assert!(!f.join("film11.png").exists());
}

/// Another build of the same version may render other bits.
#[test]
fn jobs_of_another_build_are_not_rendered() {
    let folder = folder();
    let f = folder.path();
    run(f, STILL);
    let own = run(f, "--version");
    let (version, build) = own.trim().split_once('+').expect("a build");
    assert!(version.starts_with("strahl ") && build.len() == 16, "{own}");
    let manifest = f.join("still.job/job.json");
    let text = fs::read_to_string(&manifest).unwrap();
    let other = text.replace(build, "0123456789abcdef");
    assert_ne!(text, other);
    fs::write(&manifest, other).unwrap();
    let problem = failure(f, "submit task still.job --task 1");
    assert!(
        problem.contains("was submitted by strahl") && problem.contains("0123456789abcdef"),
        "{problem}"
    );
}

/// A task with several tiles reads the scene once.
#[test]
fn tiles_of_one_task_are_those_of_several() {
    let folder = folder();
    let f = folder.path();
    run(f, STILL);
    run(f, &format!("{STILL} --chunk 3 --job all.job"));
    run(f, "submit task all.job --task 1");
    for task in 1..=3 {
        run(f, &format!("submit task still.job --task {task}"));
    }
    let hash = |job: &str| {
        run(f, &format!("submit merge {job}"));
        json(&fs::read(f.join(job).join("result.json")).unwrap())["pictures"][0]["sha256"].clone()
    };
    assert_eq!(hash("all.job"), hash("still.job"));
}

/// The scripts of a job name its folder, so tasks of a moved one would look for it in vain.
#[test]
fn jobs_that_were_moved_are_not_submitted() {
    let folder = folder();
    let f = folder.path();
    run(f, STILL);
    fs::rename(f.join("still.job"), f.join("a moved job")).unwrap();
    let moved = f.join("a moved job").display().to_string();
    let output = strahl(f, &["submit", "resume", &moved, "--dry-run"]);
    assert_eq!(output.status.code(), Some(1));
    assert!(stderr(&output).contains("was moved"), "{}", stderr(&output));
    // What works without the scheduler still does.
    for task in ["1", "2", "3"] {
        let output = strahl(f, &["submit", "task", &moved, "--task", task]);
        assert!(output.status.success(), "{}", stderr(&output));
    }
    let output = strahl(f, &["submit", "merge", &moved]);
    assert!(output.status.success(), "{}", stderr(&output));
    let output = strahl(f, &["submit", "resume", &moved]);
    let said = String::from_utf8(output.stdout).unwrap();
    assert!(said.contains(&format!("merge '{moved}'")), "{said}");
}

/// `status` reads the headers of tiles only; `resume` reads all, as the merge does.
#[test]
fn a_tile_with_changed_values_is_submitted_again() {
    let folder = folder();
    let f = folder.path();
    run(f, STILL);
    for task in 1..=3 {
        run(f, &format!("submit task still.job --task {task}"));
    }
    let tile = f.join("still.job/tiles/t2.exr");
    let mut bytes = fs::read(&tile).unwrap();
    let middle = bytes.len() / 2;
    bytes[middle] ^= 0xff;
    fs::write(&tile, bytes).unwrap();
    assert_eq!(status(f, "still.job")["done"], 3);
    assert!(failure(f, "submit merge still.job").contains("t2.exr"));
    assert!(run(f, "submit resume still.job --dry-run").contains("--array=2 "));
}

#[test]
fn changed_scenes_are_noticed_without_a_bundle() {
    let folder = folder();
    let f = folder.path();
    run(f, &format!("{STILL} --no-bundle"));
    run(f, "submit task still.job --task 1");
    fs::write(f.join("lib/ball.inc"), "#declare R = 0.9;").unwrap();
    let problem = failure(f, "submit task still.job --task 2");
    assert!(
        problem.contains("has changed since the job was submitted"),
        "{problem}"
    );
    let failed = &status(f, "still.job")["failed"][0];
    assert!(
        failed["why"].as_str().unwrap().contains("has changed"),
        "{failed}"
    );
}

/// The first frame is read twice, for its hash and for the look.
#[test]
fn messages_of_frames_are_printed_once() {
    let folder = folder();
    let f = folder.path();
    let scene = "#debug concat(\"frame \", str(frame_number, 0, 0), \";\\n\") sphere { 0, 1 }";
    fs::write(f.join("said.pov"), scene).unwrap();
    let submit = "submit slurm said.pov -o s.png --frames 1-3 --size 64x64 --tiles 2 --dry-run";
    let said = stderr(&call(f, submit));
    for frame in ["frame 1;", "frame 2;", "frame 3;"] {
        assert_eq!(said.matches(frame).count(), 1, "{said}");
    }
}

#[test]
fn scenes_with_effects_are_told() {
    let folder = folder();
    let f = folder.path();
    fs::write(
        f.join("effects.pov"),
        "#fopen F \"out.txt\" write #write(F, \"1\") #fclose F sphere { now * 0, 1 }",
    )
    .unwrap();
    let said = stderr(&call(
        f,
        "submit slurm effects.pov -o e.png --size 64x64 --dry-run",
    ));
    assert!(
        said.contains("writes files (out.txt)") && said.contains("reads the time"),
        "{said}"
    );
    run(f, "submit task e.job --task 1");
    assert!(!f.join("effects.out").exists() && !f.join("e.job/scene/effects.out").exists());
}

#[test]
fn templates_of_open_job_description_have_frames_and_tiles() {
    let folder = folder();
    let f = folder.path();
    run(
        f,
        "submit openjd scene.pov -o film.png +W64 +H48 -Llib --frames 1-4 --tiles 2 --quiet",
    );
    let template = json(&fs::read(f.join("film.job/template.json")).unwrap());
    assert_eq!(template["extensions"][0], "TASK_CHUNKING");
    // Stills have no chunks, so they need no extension, which some queues lack.
    run(
        f,
        "submit openjd scene.pov -o still.png +W64 +H48 -Llib --quiet",
    );
    let still = json(&fs::read(f.join("still.job/template.json")).unwrap());
    assert_eq!(still.get("extensions"), None);
    assert_eq!(
        template["steps"][1]["dependencies"][0]["dependsOn"],
        "Render"
    );
    for (frames, tile) in [("1-2", 1), ("3-4", 1), ("1-4", 2)] {
        let said = run(
            f,
            &format!("submit task film.job --openjd --frames {frames} --tile {tile}"),
        );
        assert!(said.contains("openjd_progress: 100.0"), "{said}");
    }
    run(f, "submit merge film.job --openjd --pictures .");
    assert!(f.join("film4.png").is_file());
    fs::remove_file(f.join("film.job/tiles/f2-t1.exr")).unwrap();
    let output = call(f, "submit merge film.job --openjd --pictures .");
    let said = String::from_utf8_lossy(&output.stdout);
    assert!(
        said.contains("openjd_fail: frame 2: tile 1 of 2 is missing"),
        "{said}"
    );
    assert!(run(f, "submit resume film.job").contains("openjd run"));
}

/// The help listed options that `submit` refuses.
#[test]
fn the_help_of_submit_shows_what_jobs_take() {
    let folder = folder();
    let f = folder.path();
    for engine in ["slurm", "openjd"] {
        let help = run(f, &format!("submit {engine} --help"));
        assert!(
            help.contains("--size <WxH>") && help.contains("[SCENE]"),
            "{help}"
        );
        assert!(
            !help.contains("standard output") && !help.contains("demo scene"),
            "{help}"
        );
        for (option, value) in [
            ("--stats", "=s.json"),
            ("--profile", ""),
            ("--no-output", ""),
            ("--tile", "=1/2"),
            ("--region", "=0,0,4x4"),
            ("--region", "=0,0,4x4 --full-size"),
            ("--resume", ""),
            ("--allow-write", "=lib"),
        ] {
            let shown = |line: &str| line.split_whitespace().next() == Some(option);
            assert!(!help.lines().any(shown), "{option}: {help}");
            let words =
                format!("submit {engine} scene.pov -o a.png -Llib --dry-run {option}{value}");
            let words: Vec<&str> = words.split_whitespace().collect();
            fails(f, &words, 1, &[option, "no meaning for a job"]);
        }
    }
}

#[test]
fn jobs_that_cannot_be_are_told() {
    let folder = folder();
    let f = folder.path();
    let cases = [
        ("submit slurm none.pov -o a.png --dry-run", 1, "none.pov"),
        (
            "submit slurm scene.pov -o a.png -Llib --stats s.json --dry-run",
            1,
            "--stats",
        ),
        ("submit slurm -o a.png --dry-run", 1, "scene file"),
        (
            "submit slurm scene.pov -o a.png -Llib +W64 +H64 --tiles 5 --dry-run",
            1,
            "4 at most",
        ),
        (
            "submit slurm scene.pov -o a.png -Llib --movie m.mp4 --dry-run",
            1,
            "--frames",
        ),
        (
            "submit slurm scene.pov -o a.png -Llib --frames 4-1",
            2,
            "--frames",
        ),
        (
            "submit slurm scene.pov -o a.png -Llib --frames 1-5 --frame-step 2 --movie m.mp4 --dry-run",
            1,
            "consecutive",
        ),
        ("submit status lib", 1, "not a job folder"),
        ("submit task lib --task 1", 1, "not a job folder"),
    ];
    for (words, code, part) in cases {
        let words: Vec<&str> = words.split_whitespace().collect();
        fails(f, &words, code, &[part]);
    }
    run(f, STILL);
    let words: Vec<&str> = STILL.split_whitespace().collect();
    fails(f, &words, 1, &["exists already", "resume"]);
    fails(
        f,
        &["submit", "task", "still.job", "--task", "9"],
        1,
        &["the job has 3 tasks"],
    );
}
