use crate::Portable;
#[cfg(target_arch = "x86_64")]
use crate::{Avx2, Avx512, Sse4};
use std::{fmt, str::FromStr, sync::LazyLock};

/// A set of instructions that kernels are compiled for. Each level includes those before it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[non_exhaustive]
pub enum Level {
    /// The instructions that every processor of the target has: SSE2 on x86-64, NEON on AArch64.
    Portable,
    /// SSE 4.1.
    Sse4,
    /// AVX2 and FMA.
    Avx2,
    /// AVX-512 F, VL, DQ, BW.
    Avx512,
}

impl Level {
    /// All levels, the lowest first.
    pub const ALL: &[Self] = &[Self::Portable, Self::Sse4, Self::Avx2, Self::Avx512];

    /// The name on the command line.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Portable => "scalar",
            Self::Sse4 => "sse4",
            Self::Avx2 => "avx2",
            Self::Avx512 => "avx512",
        }
    }
}

impl fmt::Display for Level {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// There is no level of that name.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct UnknownLevel(String);

impl fmt::Display for UnknownLevel {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let names: Vec<&str> = Level::ALL.iter().map(|l| l.name()).collect();
        let names = names.join(", ");
        write!(f, "unknown SIMD level `{}`; there are: {names}", self.0)
    }
}

impl std::error::Error for UnknownLevel {}

impl FromStr for Level {
    type Err = UnknownLevel;

    fn from_str(s: &str) -> Result<Self, Self::Err> {
        let found = Self::ALL.iter().copied().find(|l| l.name() == s);
        found.ok_or_else(|| UnknownLevel(s.to_owned()))
    }
}

/// A level that this processor has, with the proof. The argument of [`dispatch!`](crate::dispatch).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Simd {
    /// See [`Level::Portable`].
    Portable(Portable),
    /// See [`Level::Sse4`].
    #[cfg(target_arch = "x86_64")]
    Sse4(Sse4),
    /// See [`Level::Avx2`].
    #[cfg(target_arch = "x86_64")]
    Avx2(Avx2),
    /// See [`Level::Avx512`].
    #[cfg(target_arch = "x86_64")]
    Avx512(Avx512),
}

impl Simd {
    /// The highest level this processor has.
    pub fn detect() -> Self {
        let mut all = Level::ALL.iter().rev();
        let found = all.find_map(|level| Self::of(*level));
        found.unwrap_or(Self::Portable(Portable))
    }

    /// The same, detected once.
    #[inline]
    pub fn best() -> Self {
        static BEST: LazyLock<Simd> = LazyLock::new(Simd::detect);
        *BEST
    }

    /// A certain level, or `None` if this processor does not have it.
    pub fn of(level: Level) -> Option<Self> {
        match level {
            Level::Portable => Some(Self::Portable(Portable)),
            #[cfg(target_arch = "x86_64")]
            Level::Sse4 => Sse4::detect().map(Self::Sse4),
            #[cfg(target_arch = "x86_64")]
            Level::Avx2 => Avx2::detect().map(Self::Avx2),
            #[cfg(target_arch = "x86_64")]
            Level::Avx512 => Avx512::detect().map(Self::Avx512),
            #[cfg(not(target_arch = "x86_64"))]
            _ => None,
        }
    }

    /// All levels this processor has, the lowest first.
    pub fn available() -> Vec<Self> {
        Level::ALL.iter().filter_map(|l| Self::of(*l)).collect()
    }

    /// Which level this is.
    pub const fn level(self) -> Level {
        match self {
            Self::Portable(_) => Level::Portable,
            #[cfg(target_arch = "x86_64")]
            Self::Sse4(_) => Level::Sse4,
            #[cfg(target_arch = "x86_64")]
            Self::Avx2(_) => Level::Avx2,
            #[cfg(target_arch = "x86_64")]
            Self::Avx512(_) => Level::Avx512,
        }
    }
}
