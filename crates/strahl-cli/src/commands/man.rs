use crate::args::Cli;
use crate::output::bytes;
use crate::report::Failure;
use clap::CommandFactory;

/// `strahl man`: prints the manual page of the program or of a command, which may be one of a command's own: `submit slurm`.
pub(crate) fn run(words: &[String]) -> Result<(), Failure> {
    let mut page = Cli::command();
    page.build();
    for word in words {
        let found = page.find_subcommand(word).cloned();
        page = found.ok_or_else(|| {
            let names: Vec<&str> = page.get_subcommands().map(|c| c.get_name()).collect();
            Failure::new(match names.is_empty() {
                true => format!("`{}` has no commands of its own", page.get_name()),
                false => format!(
                    "there is no command `{word}`; the commands are {}",
                    names.join(", ")
                ),
            })
        })?;
    }
    if !words.is_empty() {
        // `build` has put the program's name into the usage line; this is the title of the page.
        let title: &'static str = Box::leak(format!("strahl-{}", words.join("-")).into_boxed_str());
        page = page.name(title).version(env!("CARGO_PKG_VERSION"));
    }
    let mut text = vec![];
    let man = clap_mangen::Man::new(page);
    man.render(&mut text).map_err(Failure::new)?;
    bytes(&text)
}
