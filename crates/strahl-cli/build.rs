//! Gives the program a fingerprint of its sources, by which tiles of two builds of one version are told apart.
//!
//! It is a hash of the sources, not of the executable: machines of several kinds render the same bits from the same sources, and may share a
//! picture.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

/// Folders of a crate that are no part of the program.
const LEFT_OUT: [&str; 4] = ["tests", "benches", "examples", "target"];

fn main() -> io::Result<()> {
    let own = PathBuf::from(std::env::var_os("CARGO_MANIFEST_DIR").unwrap_or_default());
    let root = own.join("../..");
    let mut files = vec![];
    // Outside the repository there is only a published version, which never changes.
    if root.join("crates/strahl-cli/build.rs").is_file() {
        collect(&root.join("crates"), &mut files)?;
        files.push(root.join("Cargo.lock"));
    }
    let mut hash = Fnv::new();
    files.sort();
    for file in &files {
        println!("cargo::rerun-if-changed={}", file.display());
        let name = file.strip_prefix(&root).unwrap_or(file);
        for part in name.components() {
            hash.add(part.as_os_str().as_encoded_bytes());
            hash.add(b"/");
        }
        // Git may have changed the ends of lines.
        let bytes = fs::read(file)?;
        for line in bytes.split(|byte| *byte == b'\r') {
            hash.add(line);
        }
        hash.add(b"\0");
    }
    let version = std::env::var("CARGO_PKG_VERSION").unwrap_or_default();
    let build = match files.is_empty() {
        true => version,
        false => format!("{version}+{:016x}", hash.0),
    };
    link_at_a_fixed_address();
    println!("cargo::rerun-if-changed=build.rs");
    println!("cargo::rustc-env=STRAHL_BUILD={build}");
    Ok(())
}

/// Links the program at a fixed address where that is known to work: 19,000 addresses need not be written when it starts, which takes a third of a
/// millisecond (docs/src/decisions.md).
fn link_at_a_fixed_address() {
    let target = |name: &str| std::env::var(format!("CARGO_CFG_TARGET_{name}")).unwrap_or_default();
    let known = target("OS") == "linux" && target("ENV") == "gnu" && target("ARCH") == "x86_64";
    // Tests are built without optimisation; debuggers and sanitizers expect the usual form.
    if known && std::env::var("PROFILE").is_ok_and(|profile| profile == "release") {
        println!("cargo::rustc-link-arg-bins=-no-pie");
    }
}

/// All files below a folder that are part of the program.
fn collect(folder: &Path, files: &mut Vec<PathBuf>) -> io::Result<()> {
    for entry in fs::read_dir(folder)? {
        let entry = entry?;
        let (path, name) = (entry.path(), entry.file_name());
        if !entry.file_type()?.is_dir() {
            files.push(path);
        } else if !LEFT_OUT.iter().any(|left_out| name == *left_out) {
            collect(&path, files)?;
        }
    }
    Ok(())
}

/// The hash FNV-1a of 64 bits: enough to tell builds apart that nobody has made to look alike.
struct Fnv(u64);

impl Fnv {
    const fn new() -> Self {
        Self(0xcbf2_9ce4_8422_2325)
    }

    fn add(&mut self, bytes: &[u8]) {
        for byte in bytes {
            self.0 = (self.0 ^ u64::from(*byte)).wrapping_mul(0x0100_0000_01b3);
        }
    }
}
