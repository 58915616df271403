//! `--max-memory`: the limit on memory, and the error when it is reached.

use crate::{interrupt, terminal, work};
use std::str::FromStr;
use std::sync::OnceLock;
use strahl::memory::{Bounded, Refusal};
use sysinfo::System;

/// A limit on memory as given by the user.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum MemoryLimit {
    None,
    Bytes(u64),
    /// A fraction of the machine's memory, or of a container's limit.
    Part(f64),
}

/// The smallest limit: with less, not even the error message could be printed.
const LEAST: u64 = 16 << 20;

impl FromStr for MemoryLimit {
    type Err = String;

    fn from_str(s: &str) -> Result<Self, String> {
        let wrong = || format!("expected a size such as 500M, 8G or 50%, or `none`, found `{s}`");
        let lower = s.trim().to_ascii_lowercase();
        if lower == "none" {
            return Ok(Self::None);
        }
        let digits = lower.find(|c: char| c != '.' && !c.is_ascii_digit());
        let (number, unit) = lower.split_at(digits.unwrap_or(lower.len()));
        let number: f64 = number.parse().map_err(|_| wrong())?;
        let scale = match unit.trim() {
            "%" if number > 0.0 && number <= 100.0 => return Ok(Self::Part(number / 100.0)),
            "" | "b" => 1.0,
            "k" | "kb" | "kib" => 1024.0,
            "m" | "mb" | "mib" => 1024.0 * 1024.0,
            "g" | "gb" | "gib" => 1024.0 * 1024.0 * 1024.0,
            "t" | "tb" | "tib" => 1024.0 * 1024.0 * 1024.0 * 1024.0,
            _ => return Err(wrong()),
        };
        let bytes = (number * scale) as u64;
        if bytes < LEAST {
            return Err(format!("{s} is too little: strahl needs at least 16M"));
        }
        Ok(Self::Bytes(bytes))
    }
}

/// Limits the memory of the program.
pub(crate) fn bound(memory: &Bounded, limit: MemoryLimit) {
    match limit {
        MemoryLimit::None => memory.limit(usize::MAX, end),
        MemoryLimit::Bytes(bytes) => memory.limit(saturated(bytes), end),
        MemoryLimit::Part(part) => {
            // Only the first one counts: a program is bound once.
            let _ = PART.set(part);
            memory.limit_later(saturated(LEAST), part_of_machine, end);
        }
    }
}

/// The part of the machine's memory that may be used.
static PART: OnceLock<f64> = OnceLock::new();

/// That part in bytes. It takes a quarter of a millisecond, because several files are read; with less than `LEAST` in use nobody asks.
fn part_of_machine() -> usize {
    let part = PART.get().copied().unwrap_or(1.0);
    saturated(machine().map_or(u64::MAX, |all| (all as f64 * part) as u64))
}

fn saturated(bytes: u64) -> usize {
    usize::try_from(bytes).unwrap_or(usize::MAX)
}

/// The memory of the machine, or of the container.
fn machine() -> Option<u64> {
    let mut system = System::new();
    system.refresh_memory();
    let container = system.cgroup_limits().map_or(u64::MAX, |c| c.total_memory);
    let all = system.total_memory().min(container);
    (all > 0).then_some(all.max(LEAST))
}

/// Ends the program because it may use no more memory. The thread that calls this can't continue.
fn end(refusal: Refusal) -> ! {
    if interrupt::ends() {
        terminal::last_line(&message(&refusal));
        interrupt::end(1);
    }
    interrupt::wait()
}

fn message(refusal: &Refusal) -> String {
    let doing = work::at_once().map_or(String::new(), |what| format!(" while {what}"));
    let used = size(refusal.used);
    let asked = size(refusal.asked);
    if refusal.used.saturating_add(refusal.asked) <= refusal.limit {
        return format!(
            "error: the system has no more memory{doing}: {used} are in use, and {asked} more are needed"
        );
    }
    format!(
        "error: out of memory{doing}: {used} are in use, {asked} more are needed, and {} are allowed\n  \
         = help: `--max-memory` raises the limit (its default is 90% of the machine's memory)",
        size(refusal.limit)
    )
}

/// A number of bytes for people, such as `1.5 GiB`.
pub(crate) fn size(bytes: usize) -> String {
    const UNITS: [&str; 5] = ["B", "KiB", "MiB", "GiB", "TiB"];
    let (mut value, mut unit) = (bytes as f64, 0);
    while value >= 1024.0 && unit + 1 < UNITS.len() {
        value /= 1024.0;
        unit += 1;
    }
    match unit {
        0 => format!("{bytes} B"),
        _ => format!("{value:.1} {}", UNITS[unit]),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn limits_are_sizes_or_parts() {
        let limit = |s: &str| s.parse::<MemoryLimit>();
        assert_eq!(limit("500M"), Ok(MemoryLimit::Bytes(500 << 20)));
        assert_eq!(limit("1.5 GiB"), Ok(MemoryLimit::Bytes(3 << 29)));
        assert_eq!(limit("50%"), Ok(MemoryLimit::Part(0.5)));
        assert_eq!(limit("none"), Ok(MemoryLimit::None));
        for bad in [
            "", "M", "-1G", "0", "1k", "120%", "0%", "5 apples", "1e999G",
        ] {
            assert!(limit(bad).is_err(), "{bad}");
        }
    }

    #[test]
    fn the_machine_has_memory() {
        assert!(machine().is_some_and(|bytes| bytes > LEAST));
    }
}
