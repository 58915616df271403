"""The examples of the guide and of both READMEs run."""

from __future__ import annotations

import re
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from conftest import ROOT


def _examples(path: Path) -> list[str]:
    return re.findall(r"^```python\n(.*?)^```", path.read_text(encoding="utf-8"), re.M | re.S)


@pytest.mark.parametrize("name", ["README.md", "python/README.md"])
def test_the_example_of_the_readme_makes_a_picture(name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    (example,) = _examples(ROOT / name)
    exec(example.replace("640", "64").replace("480", "48").replace("(320, 240)", "(32, 24, 64, 48)"), {})
    assert [path.suffix for path in tmp_path.iterdir()] == [".png"]


def test_the_examples_of_the_guide_run(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("pandas")
    monkeypatch.chdir(tmp_path)
    (tmp_path / "scene.pov").write_text("sphere { AXIS, RADIUS + clock } light_source { 9, 1 } camera { location -9 * z }")
    vertices = np.array([[0, 0, 0], [3, 0, 0], [0, 3, 0], [0, 0, 3]], np.float32)
    directions = np.random.default_rng(1).normal(size=(20, 3))
    names = {
        "vertices": vertices,
        "faces": np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]], np.uint32),
        "normals": vertices - 0.5,
        "centers": directions,
        "radii": np.full(20, 0.1),
        "colors": np.abs(directions),
        "heights": np.eye(8),
        "density": np.exp(-np.add.outer(np.add.outer(np.arange(5.0), np.arange(6.0)), np.arange(7.0))),
        "thing": SimpleNamespace(vertices=vertices, faces=[[0, 1, 2]]),
        "atoms": SimpleNamespace(positions=directions, numbers=np.full(20, 6)),
        "origins": np.full(3, 5.0),
        "directions": directions,
        "points": directions,
        "light": np.array([4.0, 8.0, 6.0]),
    }
    examples = _examples(ROOT / "docs/src/python.md")
    assert len(examples) > 6
    for example in examples:
        # Explained pixels stay where they are, in a picture of a tenth of the size.
        small = re.sub(r"\b(320|240|640|480)\b", lambda number: str(int(number[0]) // 10), example)
        exec(small.replace("strahl.from_ase(atoms)", "strahl.from_ase(atoms, radii=radii, colors=colors)").replace("tree.to_networkx()", ""), names)
    assert (tmp_path / "glass.png").exists()
