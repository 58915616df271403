//! What can be chosen about a structure: `NAME:PARAMETER=VALUE,PARAMETER=VALUE`.

use std::fmt;

/// A parameter as the help and the error messages describe it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Parameter {
    /// Its name.
    pub name: &'static str,
    /// What it may be, as `centre|cost` or `NUMBER`; empty for one that is only named.
    pub values: &'static str,
    /// What it does.
    pub about: &'static str,
}

impl fmt::Display for Parameter {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name)?;
        match self.values {
            "" => Ok(()),
            values => write!(f, "={values}"),
        }
    }
}

/// The parameters of one kind of structure.
pub trait Parameters: Copy + PartialEq + fmt::Debug + 'static {
    /// What holds if nothing is said.
    const DEFAULT: Self;

    /// The parameters there are.
    const ALL: &'static [Parameter];

    /// Sets one; `None` if that is no value for it. Only names of [`Parameters::ALL`] are asked for; `value` is empty if
    /// none was given.
    fn set(&mut self, name: &str, value: &str) -> Option<()>;

    /// The value of one, as [`Parameters::set`] takes it; `None` for one that is only named, and is not.
    fn value(&self, name: &str) -> Option<String>;

    /// Whether all this can be had here.
    ///
    /// # Errors
    /// Why not, in words.
    fn check(&self) -> Result<(), String> {
        Ok(())
    }
}

/// There is nothing to choose.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct NoParameters;

impl Parameters for NoParameters {
    const DEFAULT: Self = Self;
    const ALL: &'static [Parameter] = &[];

    fn set(&mut self, _: &str, _: &str) -> Option<()> {
        None
    }

    fn value(&self, _: &str) -> Option<String> {
        None
    }
}

/// Reads `PARAMETER=VALUE,...`; the error says what is wrong and what there is.
pub(crate) fn parse<P: Parameters>(kind: &str, text: &str) -> Result<P, String> {
    let mut parameters = P::DEFAULT;
    for item in text.split(',').map(str::trim).filter(|i| !i.is_empty()) {
        let (name, value) = item.split_once('=').unwrap_or((item, ""));
        let (name, value) = (name.trim(), value.trim());
        let Some(parameter) = P::ALL.iter().find(|p| p.name == name) else {
            let all: Vec<String> = P::ALL.iter().map(Parameter::to_string).collect();
            return Err(match all.as_slice() {
                [] => format!("`{kind}` has no parameters, found `{name}`"),
                all => format!(
                    "`{kind}` has no parameter `{name}`; there are: {}",
                    all.join(", ")
                ),
            });
        };
        let fits = !(parameter.values.is_empty() && item.contains('='));
        if !fits || parameters.set(name, value).is_none() {
            return Err(format!(
                "expected `{parameter}` for `{kind}`, found `{item}`"
            ));
        }
    }
    parameters.check()?;
    Ok(parameters)
}

/// Writes what differs from the defaults, as [`parse`] reads it.
pub(crate) fn write<P: Parameters>(p: &P, f: &mut fmt::Formatter<'_>) -> fmt::Result {
    let mut separator = ':';
    for parameter in P::ALL {
        let value = p.value(parameter.name);
        if value == P::DEFAULT.value(parameter.name) {
            continue;
        }
        let Some(value) = value else { continue };
        write!(f, "{separator}{}", parameter.name)?;
        if !parameter.values.is_empty() {
            write!(f, "={value}")?;
        }
        separator = ',';
    }
    Ok(())
}

/// A choice by name: makes the enum with its names.
macro_rules! choice {
    ($(#[$doc:meta])* $name:ident { $($(#[$variant_doc:meta])* $text:literal $variant:ident,)+ }) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub enum $name {
            $($(#[$variant_doc])* $variant,)+
        }

        impl $name {
            /// All of them.
            pub const ALL: &[Self] = &[$(Self::$variant,)+];

            /// The name on the command line.
            pub const fn name(self) -> &'static str {
                match self { $(Self::$variant => $text,)+ }
            }

            /// The one of a name.
            pub(crate) fn of_name(name: &str) -> Option<Self> {
                Self::ALL.iter().copied().find(|c| c.name() == name)
            }
        }
    };
}
pub(crate) use choice;
