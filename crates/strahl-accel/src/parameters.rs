//! Parameters of structures: `NAME:PARAMETER=VALUE,PARAMETER=VALUE`.

use std::fmt;

/// A parameter, for help texts and error messages.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Parameter {
    /// Its name.
    pub name: &'static str,
    /// Its possible values, as `centre|cost` or `NUMBER`; empty for a flag.
    pub values: &'static str,
    /// Its meaning.
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
    /// The default values.
    const DEFAULT: Self;

    /// All parameters.
    const ALL: &'static [Parameter];

    /// Sets one; `None` if the value is invalid. Called only with names of [`Parameters::ALL`]; `value` is empty if none was
    /// given.
    fn set(&mut self, name: &str, value: &str) -> Option<()>;

    /// The value of one, as [`Parameters::set`] takes it; `None` for a flag that is not set.
    fn value(&self, name: &str) -> Option<String>;

    /// Checks that the values work together on this machine.
    ///
    /// # Errors
    /// The problem, in words.
    fn check(&self) -> Result<(), String> {
        Ok(())
    }
}

/// No parameters.
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

/// Parses `PARAMETER=VALUE,...`; the error says what is wrong and which parameters there are.
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

/// Writes the parameters that differ from the defaults, in the form that [`parse`] reads.
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

/// Makes an enum whose variants have names.
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

            /// The variant with this name.
            pub(crate) fn of_name(name: &str) -> Option<Self> {
                Self::ALL.iter().copied().find(|c| c.name() == name)
            }
        }
    };
}
pub(crate) use choice;
