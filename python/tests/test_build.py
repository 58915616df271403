"""The build of the package: it looks for Rust, and has the licences."""

from __future__ import annotations

import os
import runpy
import sys
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
from conftest import ROOT


@pytest.fixture
def backend(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> dict[str, Any]:
    """The build backend on a machine without programs, with a maturin that asks for nothing."""
    monkeypatch.setitem(sys.modules, "maturin", SimpleNamespace(get_requires_for_build_wheel=lambda _: []))
    monkeypatch.setenv("PATH", str(tmp_path / "empty"))
    monkeypatch.setenv("CARGO_HOME", str(tmp_path / "cargo"))
    return runpy.run_path(str(ROOT / "python/tools/build_backend.py"))


def test_without_rust_a_message_says_what_to_do(backend: dict[str, Any]) -> None:
    with pytest.raises(SystemExit, match="`cargo` is not on the PATH.*\n.*https://rustup.rs"):
        backend["get_requires_for_build_wheel"]()


def test_rust_is_found_where_rustup_puts_it(backend: dict[str, Any], tmp_path: Path) -> None:
    folder = tmp_path / "cargo" / "bin"
    folder.mkdir(parents=True)
    program = folder / ("cargo.exe" if sys.platform == "win32" else "cargo")
    program.write_text("")
    program.chmod(0o755)
    assert backend["get_requires_for_build_wheel"]() == []
    assert os.environ["PATH"].split(os.pathsep)[0] == str(folder)


@pytest.mark.parametrize("name", ["LICENSE-APACHE", "LICENSE-MIT"])
def test_the_package_has_the_licences_of_the_project(name: str) -> None:
    assert (ROOT / "python" / name).read_bytes() == (ROOT / name).read_bytes()
