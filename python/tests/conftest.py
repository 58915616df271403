"""What all tests use."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

import strahl

ROOT = Path(__file__).resolve().parents[2]


@pytest.fixture
def ball() -> strahl.Scene:
    """A sphere of radius 1 at the origin, a light and a camera."""
    return strahl.Scene(
        strahl.sphere(name="ball"),
        strahl.point_light((4, 8, 6)),
        strahl.Camera.perspective((0, 0, 7)),
    )


@pytest.fixture
def slow() -> strahl.Scene:
    """A scene whose pictures take minutes."""
    text = """
        light_source { <5, 9, -8>, 1 area_light x, y, 33, 33 }
        #for (I, 1, 300)
          sphere { <mod(I, 20) - 10, div(I, 20) - 7, 0>, 0.49 texture { pigment { rgbf 0.9 } finish { reflection 0.4 } } interior { ior 1.5 } }
        #end
        camera { location -20 * z look_at 0 }
    """
    return strahl.parse(text)


@pytest.fixture(scope="session")
def program() -> str:
    """The program `strahl`, whose pictures are compared: STRAHL_PROGRAM names it."""
    path = os.environ.get("STRAHL_PROGRAM")
    if path is None:
        pytest.skip("STRAHL_PROGRAM does not name the program")
    return path
