use crate::args::Cli;
use crate::output::bytes;
use crate::report::Failure;
use clap::CommandFactory;
use clap_complete::Shell;

/// `strahl completions`: prints the completion script of a shell.
pub(crate) fn run(shell: Shell) -> Result<(), Failure> {
    let mut script = vec![];
    clap_complete::generate(shell, &mut Cli::command(), "strahl", &mut script);
    bytes(&script)
}
