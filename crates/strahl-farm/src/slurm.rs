//! Batch scripts for Slurm.

use crate::merge::ranges;
use std::path::Path;

/// What a job asks Slurm for.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct SlurmOptions {
    /// `--partition`.
    pub partition: Option<String>,
    /// `--time` of each task.
    pub time: Option<String>,
    /// `--mem` of each task.
    pub mem: Option<String>,
    /// `--cpus-per-task`.
    pub cpus: u32,
    /// Further options of sbatch, one a word.
    pub more: Vec<String>,
}

/// A text as one word of a shell.
pub fn quoted(text: &str) -> String {
    let plain = |c: char| c.is_ascii_alphanumeric() || "-_./=:,@%+".contains(c);
    match !text.is_empty() && text.chars().all(plain) {
        true => text.to_owned(),
        false => format!("'{}'", text.replace('\'', r"'\''")),
    }
}

/// The script of the array: one element renders one task.
pub fn render_script(options: &SlurmOptions, program: &Path, folder: &Path) -> String {
    let program = quoted(&program.display().to_string());
    let shown = quoted(&folder.display().to_string());
    let mut head = head(options, folder, "%A_%a.log");
    if let Some(time) = &options.time {
        head.push_str(&format!("#SBATCH --time={time}\n"));
    }
    format!(
        "{head}#SBATCH --cpus-per-task={cpus}
#SBATCH --requeue
render() {{
    {program} submit task {shown} --task \"$SLURM_ARRAY_TASK_ID\" --threads \"${{SLURM_CPUS_PER_TASK:-1}}\"
    code=$?
}}
render
# A task that was killed (no memory, a person, a broken node) is tried again here, then elsewhere, where Slurm lets it wait for two minutes first.
# One whose scene has an error is not tried again.
if [ \"$code\" -gt 128 ]; then
    echo \"strahl: the task was killed (code $code) and is tried again\"
    render
fi
# An element's SLURM_JOB_ID may be that of the whole array, so it is named by array and index.
if [ \"$code\" -gt 128 ] && [ \"${{SLURM_RESTART_COUNT:-0}}\" -lt 2 ]; then
    echo \"strahl: the task was killed again (code $code) and is put back into the queue\"
    scontrol requeue \"${{SLURM_ARRAY_JOB_ID}}_${{SLURM_ARRAY_TASK_ID}}\" && sleep 60
fi
exit \"$code\"
",
        cpus = options.cpus.max(1),
    )
}

/// The script that makes the pictures of the tiles.
pub fn merge_script(options: &SlurmOptions, program: &Path, folder: &Path) -> String {
    format!(
        "{head}#SBATCH --cpus-per-task=1
#SBATCH --requeue
{program} submit merge {shown}
",
        head = head(options, folder, "merge-%j.log"),
        program = quoted(&program.display().to_string()),
        shown = quoted(&folder.display().to_string()),
    )
}

/// Begins the line of a script that has the job folder.
const FOLDER: &str = "# Job folder: ";

/// The job folder that a script was written for.
pub fn folder_of(script: &str) -> Option<&Path> {
    script
        .lines()
        .find_map(|line| line.strip_prefix(FOLDER))
        .map(Path::new)
}

/// The lines that both scripts begin with.
fn head(options: &SlurmOptions, folder: &Path, log: &str) -> String {
    // Slurm takes the rest of the line as it is, blanks included, if it is quoted, and replaces `%j` and the like: of the log's name, not of the folder's.
    let folder_of_logs = folder.join("log").display().to_string().replace('%', "%%");
    let mut head = format!(
        "#!/bin/sh\n#SBATCH --job-name=strahl\n#SBATCH --output=\"{folder_of_logs}/{log}\"\n#SBATCH --open-mode=append\n"
    );
    let mut set = |name: &str, value: &Option<String>| {
        if let Some(value) = value {
            head.push_str(&format!("#SBATCH --{name}={value}\n"));
        }
    };
    set("partition", &options.partition);
    set("mem", &options.mem);
    for option in &options.more {
        head.push_str(&format!("#SBATCH {option}\n"));
    }
    head.push_str(&format!("{FOLDER}{}\n", folder.display()));
    head
}

/// The arguments of sbatch for tasks of the array.
pub fn render_command(folder: &Path, tasks: &[u32]) -> Vec<String> {
    vec![
        "--parsable".into(),
        format!("--array={}", ranges(tasks).replace(", ", ",")),
        folder.join("render.sbatch").display().to_string(),
    ]
}

/// The arguments of sbatch for the merge behind an array. It runs however the tasks have ended, and says what is missing: a merge that waits
/// for tasks that will never succeed would wait forever.
pub fn merge_command(folder: &Path, array: &str) -> Vec<String> {
    vec![
        "--parsable".into(),
        format!("--dependency=afterany:{array}"),
        "--kill-on-invalid-dep=yes".into(),
        folder.join("merge.sbatch").display().to_string(),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scripts_name_program_and_folder() {
        let options = SlurmOptions {
            partition: Some("long".into()),
            time: Some("10:00".into()),
            cpus: 4,
            ..SlurmOptions::default()
        };
        let script = render_script(
            &options,
            Path::new("/opt/my tools/strahl"),
            Path::new("/data/a's job"),
        );
        assert!(script.contains("'/opt/my tools/strahl' submit task '/data/a'\\''s job' --task"));
        assert!(
            script.contains("#SBATCH --time=10:00\n") && script.contains("--cpus-per-task=4\n")
        );
        assert!(script.starts_with("#!/bin/sh\n#SBATCH"));
        assert_eq!(folder_of(&script), Some(Path::new("/data/a's job")));
        let script = render_script(&options, Path::new("strahl"), Path::new("/data/%j.job"));
        assert!(script.contains("--output=\"/data/%%j.job/log/%A_%a.log\"\n"));
        assert!(script.contains("submit task /data/%j.job --task"));
        let merge = merge_script(&options, Path::new("strahl"), Path::new("/job"));
        assert!(merge.contains("strahl submit merge /job\n") && !merge.contains("--time"));
    }

    #[test]
    fn only_these_tasks_are_submitted() {
        let words = render_command(Path::new("/job"), &[1, 4, 5, 6]);
        assert_eq!(words[1], "--array=1,4-6");
        let words = merge_command(Path::new("/job"), "17");
        assert!(words.contains(&"--dependency=afterany:17".to_owned()));
    }
}
