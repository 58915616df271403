use strahl_scene::{Diagnostic, Severity};

/// A result whose error is already placed; boxed, because it is rare and large.
pub(crate) type Fallible<T> = Result<T, Box<Diagnostic>>;

/// Most errors, and most warnings, that are shown one by one.
const MOST_SHOWN: usize = 20;

/// Collects what a reader has to say, without flooding: a cap on each severity, and counters for what happens to many
/// elements alike.
#[derive(Debug, Default)]
pub(crate) struct Report {
    shown: Vec<Diagnostic>,
    errors: usize,
    warnings: usize,
    /// Repeated warnings, by key: a reader has a handful of them.
    counted: Vec<Counted>,
}

#[derive(Debug)]
struct Counted {
    key: &'static str,
    first: Diagnostic,
    count: u64,
}

impl Report {
    /// Adds an error; beyond the cap it is only counted and not even made.
    pub(crate) fn error(&mut self, make: impl FnOnce() -> Diagnostic) {
        self.errors += 1;
        if self.errors <= MOST_SHOWN {
            self.shown.push(make());
        }
    }

    /// Adds a warning, like [`Report::error`].
    pub(crate) fn warning(&mut self, make: impl FnOnce() -> Diagnostic) {
        self.warnings += 1;
        if self.warnings <= MOST_SHOWN {
            self.shown.push(make());
        }
    }

    /// Adds a warning that may come up a million times: the first stands for all of its `key`, with their number.
    pub(crate) fn count(&mut self, key: &'static str, make: impl FnOnce() -> Diagnostic) {
        match self.counted.iter_mut().find(|c| c.key == key) {
            Some(counted) => counted.count += 1,
            None => self.counted.push(Counted {
                key,
                first: make(),
                count: 1,
            }),
        }
    }

    /// Adds what was said about what comes next.
    pub(crate) fn append(&mut self, other: Self) {
        let room = |n: usize| MOST_SHOWN.saturating_sub(n);
        let mut room = (room(self.errors), room(self.warnings));
        self.shown.extend(other.shown.into_iter().filter(|d| {
            let room = if d.is_error() {
                &mut room.0
            } else {
                &mut room.1
            };
            let shown = *room > 0;
            *room = room.saturating_sub(1);
            shown
        }));
        self.errors += other.errors;
        self.warnings += other.warnings;
        for counted in other.counted {
            match self.counted.iter_mut().find(|c| c.key == counted.key) {
                Some(known) => known.count += counted.count,
                None => self.counted.push(counted),
            }
        }
    }

    /// Whether there was an error so far.
    pub(crate) fn has_errors(&self) -> bool {
        self.errors > 0
    }

    /// Whether there are so many errors that reading on is of no use.
    pub(crate) fn is_hopeless(&self) -> bool {
        self.errors >= 10_000
    }

    /// Whether there was an error, and all that is to be shown: errors first come first, then what was counted.
    pub(crate) fn finish(self) -> (bool, Vec<Diagnostic>) {
        let mut all = self.shown;
        for Counted {
            mut first, count, ..
        } in self.counted
        {
            if count > 1 {
                first.message = format!("{} ({count} times, this is the first)", first.message);
            }
            all.push(first);
        }
        let rest = |count: usize| count.saturating_sub(MOST_SHOWN);
        let more =
            |n: usize, what: &str| format!("and {n} more {what}{}", if n == 1 { "" } else { "s" });
        if rest(self.warnings) > 0 {
            all.push(Diagnostic::warning(more(rest(self.warnings), "warning")));
        }
        // What prevents the picture is read first.
        all.sort_by_key(|d| d.severity != Severity::Error);
        if rest(self.errors) > 0 {
            let at = all.iter().position(|d| !d.is_error()).unwrap_or(all.len());
            all.insert(at, Diagnostic::error(more(rest(self.errors), "error")));
        }
        (self.errors > 0, all)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn errors_are_capped_and_come_first() {
        let mut report = Report::default();
        report.warning(|| Diagnostic::warning("first a warning"));
        for i in 0..25 {
            report.error(|| Diagnostic::error(format!("error {i}")));
        }
        let (failed, all) = report.finish();
        assert!(failed);
        assert_eq!(all.len(), 22);
        assert_eq!(all[0].message, "error 0");
        assert_eq!(all[20].message, "and 5 more errors");
        assert_eq!(all[21].message, "first a warning");
    }

    #[test]
    fn reports_are_as_if_written_one_after_the_other() {
        let say = |report: &mut Report, from: usize, to: usize| {
            for i in from..to {
                report.error(|| Diagnostic::error(format!("error {i}")));
                report.warning(|| Diagnostic::warning(format!("warning {i}")));
                report.count(["even", "odd"][i % 2], || {
                    Diagnostic::warning(format!("number {i}"))
                });
            }
        };
        for middle in [0, 1, 7, 20, 23, 30] {
            let (mut one, mut first, mut second) =
                (Report::default(), Report::default(), Report::default());
            say(&mut one, 0, 30);
            say(&mut first, 0, middle);
            say(&mut second, middle, 30);
            first.append(second);
            assert_eq!(first.finish(), one.finish(), "{middle}");
        }
    }

    #[test]
    fn repeated_warnings_are_counted() {
        let mut report = Report::default();
        for _ in 0..3 {
            report.count("flat", || Diagnostic::warning("the polygon is flat"));
        }
        report.count("thin", || Diagnostic::warning("the polygon is thin"));
        let (failed, all) = report.finish();
        assert!(!failed);
        assert_eq!(
            all[0].message,
            "the polygon is flat (3 times, this is the first)"
        );
        assert_eq!(all[1].message, "the polygon is thin");
    }
}
