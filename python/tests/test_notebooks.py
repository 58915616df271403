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
