//! The arguments of a command.

use anyhow::{Context, Result};
use std::str::FromStr;

/// Options with their values, and operands, read one by one.
pub(crate) struct Arguments<'a> {
    rest: std::slice::Iter<'a, &'a str>,
    /// The option read last.
    option: &'a str,
}

impl<'a> Arguments<'a> {
    pub(crate) fn new(args: &'a [&'a str]) -> Self {
        Self {
            rest: args.iter(),
            option: "",
        }
    }

    /// The next option or operand.
    pub(crate) fn option(&mut self) -> Option<&'a str> {
        self.option = self.rest.next()?;
        Some(self.option)
    }

    /// The value of the option read last.
    pub(crate) fn value(&mut self) -> Result<&'a str> {
        let value = self.rest.next().copied();
        value.with_context(|| format!("{} needs a value", self.option))
    }

    /// The value of the option read last, as a number.
    pub(crate) fn number<T: FromStr>(&mut self) -> Result<T> {
        let value = self.value()?;
        let number = value.parse().ok();
        number.with_context(|| format!("{} needs a number, found `{value}`", self.option))
    }
}

#[cfg(test)]
mod tests {
    use super::Arguments;

    #[test]
    fn values_and_numbers_belong_to_options() {
        let mut args = Arguments::new(&["--runs", "3", "folder", "--jobs", "two", "--out"]);
        assert_eq!(args.option(), Some("--runs"));
        assert_eq!(args.number::<u32>().unwrap(), 3);
        assert_eq!(args.option(), Some("folder"));
        assert_eq!(args.option(), Some("--jobs"));
        let error = args.number::<u32>().unwrap_err().to_string();
        assert_eq!(error, "--jobs needs a number, found `two`");
        assert_eq!(args.option(), Some("--out"));
        assert!(args.value().unwrap_err().to_string().contains("--out"));
        assert_eq!(args.option(), None);
    }
}
