//! Job templates of Open Job Description (specification 2023-09), as AWS Deadline Cloud and `openjd run` take them.

use crate::job::Job;
use serde_json::{Value, json};

/// The folder for pictures in the job folder, unless the parameter Pictures names another one.
pub const PICTURES: &str = "pictures";

/// The template of a job whose manifest lies in the same folder: a step with the parameters Frame and Tile, and the merge behind it.
///
/// A path in `name` would have to be a raw parameter, since paths are mapped from machine to machine; the name is a plain text here. Frames
/// come in chunks, which the scheduler makes longer where frames are short.
pub fn template(job: &Job, name: &str) -> Value {
    let mut spaces = vec![];
    let mut args = vec![
        json!("submit"),
        json!("task"),
        json!("{{Param.JobFolder}}"),
        json!("--openjd"),
    ];
    let numbers: Vec<u32> = job.frames.iter().filter_map(|frame| frame.number).collect();
    if !numbers.is_empty() {
        spaces.push(json!({
            "name": "Frame",
            "type": "CHUNK[INT]",
            "range": "{{Param.Frames}}",
            "chunks": {
                "defaultTaskCount": 1,
                "targetRuntimeSeconds": 60,
                "rangeConstraint": "CONTIGUOUS",
            },
        }));
        args.extend([json!("--frames"), json!("{{Task.Param.Frame}}")]);
    }
    if numbers.is_empty() || job.tiles.len() > 1 {
        spaces.push(json!({
            "name": "Tile",
            "type": "INT",
            "range": format!("1-{}", job.tiles.len()),
        }));
        args.extend([json!("--tile"), json!("{{Task.Param.Tile}}")]);
    }
    let mut parameters = vec![
        json!({
            "name": "JobFolder",
            "type": "PATH",
            "objectType": "DIRECTORY",
            "dataFlow": "INOUT",
            "default": ".",
            "description": "The folder of this template, with the scene, the manifest and the tiles",
        }),
        json!({
            "name": "Pictures",
            "type": "PATH",
            "objectType": "DIRECTORY",
            "dataFlow": "OUT",
            // Defaults are within the folder of the template.
            "default": PICTURES,
            "description": "The folder for the pictures",
        }),
        json!({
            "name": "Strahl",
            "type": "STRING",
            "default": "strahl",
            "description": "The program on the machines",
        }),
    ];
    if !numbers.is_empty() {
        parameters.push(json!({
            "name": "Frames",
            "type": "STRING",
            "default": frames(&numbers),
            "description": "The frames to render",
        }));
    }
    let run = |args: Vec<Value>| json!({ "actions": { "onRun": { "command": "{{Param.Strahl}}", "args": args } } });
    let mut template = json!({
        "specificationVersion": "jobtemplate-2023-09",
        "name": name,
        "description": "A picture or film of strahl, in parts",
        "parameterDefinitions": parameters,
        "steps": [
            {
                "name": "Render",
                "parameterSpace": { "taskParameterDefinitions": spaces },
                "script": run(args),
            },
            {
                "name": "Merge",
                "dependencies": [{ "dependsOn": "Render" }],
                "script": run(vec![
                    json!("submit"),
                    json!("merge"),
                    json!("{{Param.JobFolder}}"),
                    json!("--openjd"),
                    json!("--pictures"),
                    json!("{{Param.Pictures}}"),
                ]),
            },
        ],
    });
    if !numbers.is_empty() {
        // Only chunks of frames need it, and not every scheduler has it.
        template["extensions"] = json!(["TASK_CHUNKING"]);
    }
    template
}

/// Numbers as a range expression: `1-10,12-20:2`.
fn frames(numbers: &[u32]) -> String {
    let step = match numbers {
        [a, b, ..] => b.saturating_sub(*a).max(1),
        _ => 1,
    };
    let even = numbers
        .windows(2)
        .all(|pair| pair[1].checked_sub(pair[0]) == Some(step));
    match (numbers, even) {
        ([one], _) => one.to_string(),
        ([first, .., last], true) if step == 1 => format!("{first}-{last}"),
        ([first, .., last], true) => format!("{first}-{last}:{step}"),
        _ => crate::merge::ranges(numbers).replace(", ", ","),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::job::JobFrame;

    #[test]
    fn frames_are_range_expressions() {
        assert_eq!(frames(&[7]), "7");
        assert_eq!(frames(&[1, 2, 3]), "1-3");
        assert_eq!(frames(&[1, 3, 5]), "1-5:2");
        assert_eq!(frames(&[1, 2, 5]), "1-2,5");
    }

    #[test]
    fn stills_have_tiles_and_films_have_frames() {
        let mut job = Job::new("strahl");
        job.tiles = vec!["0,0,4x4".into(), "4,0,4x4".into()];
        let spaces = |job: &Job| {
            let all = template(job, "a")["steps"][0]["parameterSpace"]["taskParameterDefinitions"]
                .clone();
            let names = all.as_array().unwrap().iter();
            names
                .map(|s| s["name"].as_str().unwrap().to_owned())
                .collect::<Vec<_>>()
        };
        job.frames = vec![JobFrame {
            number: None,
            scene: String::new(),
        }];
        assert_eq!(spaces(&job), ["Tile"]);
        assert_eq!(template(&job, "a").get("extensions"), None);
        job.frames = (1..5)
            .map(|n| JobFrame {
                number: Some(n),
                scene: String::new(),
            })
            .collect();
        assert_eq!(spaces(&job), ["Frame", "Tile"]);
        assert_eq!(template(&job, "a")["extensions"], json!(["TASK_CHUNKING"]));
        job.tiles.pop();
        assert_eq!(spaces(&job), ["Frame"]);
    }
}
