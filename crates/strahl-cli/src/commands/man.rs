use crate::args::Cli;
use crate::output::bytes;
use crate::report::Failure;
use clap::CommandFactory;

/// `strahl man`: prints the manual page of the program or of a command.
pub(crate) fn run(command: Option<&str>) -> Result<(), Failure> {
    let mut all = Cli::command();
    all.build();
    let page = match command {
        None => all,
        Some(name) => {
            let names: Vec<String> = all
                .get_subcommands()
                .map(|c| c.get_name().to_owned())
                .collect();
            let found = all.find_subcommand(name).cloned();
            let found = found.ok_or_else(|| {
                Failure::new(format!(
                    "there is no command `{name}`; the commands are {}",
                    names.join(", ")
                ))
            })?;
            // `build` has put the program's name into the usage line; this is the title of the page.
            let title: &'static str = Box::leak(format!("strahl-{name}").into_boxed_str());
            found.name(title).version(env!("CARGO_PKG_VERSION"))
        }
    };
    let mut text = vec![];
    let man = clap_mangen::Man::new(page);
    man.render(&mut text).map_err(Failure::new)?;
    bytes(&text)
}
