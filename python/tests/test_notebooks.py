"""The notebooks run, and are stored without what they printed."""

from __future__ import annotations

import json
import os
from pathlib import Path
from typing import Any

import pytest
from conftest import ROOT

NOTEBOOKS = sorted((ROOT / "python/notebooks").glob("*.ipynb"))


def _client() -> Any:
    """What runs notebooks, and the packages that they import."""
    try:
        import ase  # type: ignore[import-not-found,import-untyped,unused-ignore]  # noqa: F401
        import ipykernel  # type: ignore[import-not-found,import-untyped,unused-ignore]  # noqa: F401
        import nbclient  # type: ignore[import-not-found,import-untyped,unused-ignore]
        import nbformat  # type: ignore[import-not-found,import-untyped,unused-ignore]
        import pandas  # type: ignore[import-not-found,import-untyped,unused-ignore]  # noqa: F401
    except ImportError as error:
        if os.environ.get("STRAHL_REQUIRE_TOOLS") == "1":
            raise
        pytest.skip(f"{error}: notebooks need nbclient, ipykernel, ase and pandas")
    return nbclient, nbformat


CELL = '''
import strahl
from strahl import _progress

shown = []

class Recorder(_progress.Output):
    def put(self, thing, **options):
        shown.append(thing)
        super().put(thing, **options)

_progress.Output = Recorder
scene = strahl.parse("""
    light_source { <5, 9, -8>, 1 area_light 3 * x, 3 * y, 9, 9 }
    plane { y, -2 pigment { rgb 1 } }
    sphere { 0, 1 pigment { rgbf 0.9 } finish { reflection 0.4 } }
    camera { location <0, 1, -6> look_at 0 }
""")
film = scene.render(200, 150, progress=True, preview=True)
assert strahl.sphere().source == "In[1]:19", strahl.sphere().source
assert any("<progress" in thing.get("text/html", "") for thing in shown if isinstance(thing, dict)), shown
assert film.sha256 == scene.render(200, 150, progress=False).sha256
'''


@pytest.mark.filterwarnings("default")
def test_progress_and_previews_are_shown_in_notebooks(tmp_path: Path) -> None:
    nbclient, nbformat = _client()
    notebook = nbformat.v4.new_notebook(cells=[nbformat.v4.new_code_cell(CELL)])
    nbclient.NotebookClient(notebook, timeout=300, resources={"metadata": {"path": str(tmp_path)}}).execute()
    outputs = notebook.cells[0].outputs
    assert [output.output_type for output in outputs] == ["display_data"] * 2
    # The bar is gone, and the preview has become the picture.
    kinds = [{kind for kind in output.data if kind != "text/plain"} for output in outputs]
    assert {"image/png"} in kinds and {"text/html"} in kinds
    assert [output.data["text/html"] for output in outputs if "text/html" in output.data] == [""]


def test_there_are_notebooks_without_outputs() -> None:
    assert len(NOTEBOOKS) == 6
    for path in NOTEBOOKS:
        cells = json.loads(path.read_text())["cells"]
        assert all(not cell.get("outputs") and cell.get("execution_count") is None for cell in cells), path


@pytest.mark.filterwarnings("default")
@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_notebooks_run(path: Path, tmp_path: Path) -> None:
    nbclient, nbformat = _client()
    notebook = nbformat.read(path, as_version=4)
    client = nbclient.NotebookClient(notebook, timeout=300, resources={"metadata": {"path": str(tmp_path)}})
    client.execute()
    pictures = [output for cell in notebook.cells for output in cell.get("outputs", []) if {"image/png", "image/gif"} & set(output.get("data", {}))]
    assert pictures
