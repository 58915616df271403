//! Builds of the program with a recorded profile (profile-guided optimisation): the compiler then knows which branches are usual, what to inline, and
//! which code hardly runs. `scripts/install` builds with the profile that is kept in the repository; `cargo xtask record` records it.

use anyhow::{Context, Result, bail};
use std::path::{Path, PathBuf};
use std::process::Command;

/// The recorded profile, below the root of the repository.
const PROFILE: &str = "xtask/profile/linux-x86_64.profdata";

/// The path of the recorded profile. It suits one system, because the names of functions depend on the compiler and on what it compiles for.
pub(crate) fn profile() -> Result<PathBuf> {
    if !cfg!(all(target_os = "linux", target_arch = "x86_64")) {
        bail!(
            "profiles are recorded and used on Linux with x86-64 only; `bench scenes --plain` measures a build without one"
        );
    }
    Ok(std::path::absolute(PROFILE)?)
}

/// Builds the program in a folder for build outputs, with a flag for the compiler besides those of `.cargo/config.toml`; returns the program's path.
pub(crate) fn build(target: &Path, flag: &str) -> Result<PathBuf> {
    for name in ["RUSTFLAGS", "CARGO_ENCODED_RUSTFLAGS"] {
        if std::env::var_os(name).is_some() {
            bail!("{name} is set and would replace the compiler's flags: unset it");
        }
    }
    let flags = serde_json::to_string(&[flag])?;
    let status = Command::new("cargo")
        .args(["build", "--release", "--locked", "--package", "strahl-cli"])
        .arg("--target-dir")
        .arg(target)
        .args([
            "--config",
            &format!("target.'cfg(all())'.rustflags={flags}"),
        ])
        .status()
        .context("cannot run cargo")?;
    if !status.success() {
        bail!("strahl does not build with {flag}");
    }
    Ok(target.join("release/strahl"))
}

/// Builds the program as `scripts/install` does; returns its path.
pub(crate) fn build_with_profile() -> Result<PathBuf> {
    let profile = profile()?;
    build(
        &outputs()?.join("profiled"),
        &format!("-Cprofile-use={}", profile.display()),
    )
}

/// The folder of build outputs that this program lies in.
pub(crate) fn outputs() -> Result<PathBuf> {
    let own = std::env::current_exe()?;
    let folder = own.ancestors().nth(2);
    Ok(folder
        .context("xtask is not in a folder of target/")?
        .to_owned())
}
