"""Builds the package by maturin, after a look for Rust: without it maturin would fetch a whole toolchain, or fail with a long message."""

from __future__ import annotations

import os
import shutil
import sys
from pathlib import Path
from typing import Any

import maturin  # type: ignore[import-not-found,unused-ignore]

MISSING = """\
strahl is compiled by Rust, and the program `cargo` is not on the PATH.
Install Rust (https://rustup.rs), open a new terminal and run the same command again.
"""


def _find_cargo() -> None:
    """Rust's installer puts its programs where only new terminals look."""
    if shutil.which("cargo"):
        return
    home = Path(os.environ.get("CARGO_HOME") or Path.home() / ".cargo") / "bin"
    if not shutil.which("cargo", path=str(home)):
        sys.exit(MISSING)
    os.environ["PATH"] = str(home) + os.pathsep + os.environ.get("PATH", "")


def get_requires_for_build_wheel(config_settings: Any = None) -> list[str]:
    """The first hook that pip calls."""
    _find_cargo()
    required: list[str] = maturin.get_requires_for_build_wheel(config_settings)
    return required


get_requires_for_build_editable = get_requires_for_build_wheel
get_requires_for_build_sdist = get_requires_for_build_wheel


def prepare_metadata_for_build_wheel(metadata_directory: str, config_settings: Any = None) -> Any:
    """See PEP 517."""
    _find_cargo()
    return maturin.prepare_metadata_for_build_wheel(metadata_directory, config_settings)


prepare_metadata_for_build_editable = prepare_metadata_for_build_wheel


def build_wheel(wheel_directory: str, config_settings: Any = None, metadata_directory: str | None = None) -> Any:
    """See PEP 517."""
    _find_cargo()
    return maturin.build_wheel(wheel_directory, config_settings, metadata_directory)


def build_editable(wheel_directory: str, config_settings: Any = None, metadata_directory: str | None = None) -> Any:
    """See PEP 660."""
    _find_cargo()
    return maturin.build_editable(wheel_directory, config_settings, metadata_directory)


def build_sdist(sdist_directory: str, config_settings: Any = None) -> Any:
    """See PEP 517."""
    _find_cargo()
    return maturin.build_sdist(sdist_directory, config_settings)
