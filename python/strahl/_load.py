"""Scenes from files and texts."""

from __future__ import annotations

import os
import sys
from collections.abc import Callable, Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any, cast

import numpy as np

from strahl import _strahl
from strahl._convert import integer, number
from strahl._scene import Scene

Declared = float | str | Sequence[float]


def _fonts() -> list[str]:
    home = Path.home()
    if sys.platform == "darwin":
        return [str(home / "Library/Fonts"), "/Library/Fonts", "/System/Library/Fonts"]
    if sys.platform == "win32":
        return [os.path.join(os.environ.get("WINDIR", r"C:\Windows"), "Fonts")]
    own = [str(home / ".local/share/fonts"), str(home / ".fonts")]
    return [*own, "/usr/local/share/fonts", "/usr/share/fonts"]


def _reading(
    format: str | None,
    declare: Mapping[str, Declared] | None,
    clock: float | None,
    size: tuple[int, int] | None,
    library: Iterable[str | os.PathLike[str]],
    version: float | None,
    header: str | None,
    limits: Mapping[str, int] | None,
    studio: bool,
    messages: Callable[[str], object] | None,
) -> dict[str, Any]:
    if isinstance(library, (str, os.PathLike)):
        library = [library]
    values: list[tuple[str, Any]] = []
    for name, value in (declare or {}).items():
        if isinstance(value, str) or np.ndim(value) == 0:
            values.append((name, value))
        else:
            values.append((name, [float(part) for part in cast(Sequence[float], value)]))
    return {
        "format": format,
        "declare": values,
        "clock": None if clock is None else number(clock, "clock"),
        "size": _size(size),
        "library": [".", *(os.fspath(folder) for folder in library)],
        "fonts": _fonts(),
        "version": version,
        "header": header,
        "limits": list((limits or {}).items()),
        "studio": studio,
        "messages": messages,
    }


def _size(size: tuple[int, int] | None) -> tuple[int, int] | None:
    if size is None:
        return None
    width, height = size
    return integer(width, "width", 1), integer(height, "height", 1)


def load(
    path: str | os.PathLike[str],
    *,
    declare: Mapping[str, Declared] | None = None,
    clock: float | None = None,
    size: tuple[int, int] | None = None,
    format: str | None = None,
    library: Iterable[str | os.PathLike[str]] = (),
    version: float | None = None,
    header: str | None = None,
    limits: Mapping[str, int] | None = None,
    studio: bool = True,
    messages: Callable[[str], object] | None = None,
) -> Scene:
    """Loads a scene file: POV-Ray's language, NFF, glTF, OBJ, PLY, STL; the name or ``format`` says which.

    ``declare`` gives names and values (numbers, strings, vectors of 2 to 5 numbers) that are known before the scene begins, ``clock`` the time of an
    animation. ``size`` is what the scene sees as image_width and image_height, and the size of pictures unless they have one. ``library`` are
    folders for include files, ``header`` a file that is included first, ``version`` the version of the language, ``limits`` those of
    ``strahl --limit``. Meshes get a ground, a camera and lights unless ``studio`` is false. ``messages`` is called with the output of #debug.
    Files that a scene writes stay in memory.

    Raises `SceneError` with all errors; warnings are issued as `SceneWarning`.
    """
    reading = _reading(format, declare, clock, size, library, version, header, limits, studio, messages)
    return Scene._of(_strahl.load(os.fspath(path), reading))


def parse(
    text: str | bytes,
    *,
    name: str = "text",
    declare: Mapping[str, Declared] | None = None,
    clock: float | None = None,
    size: tuple[int, int] | None = None,
    format: str | None = None,
    library: Iterable[str | os.PathLike[str]] = (),
    version: float | None = None,
    header: str | None = None,
    limits: Mapping[str, int] | None = None,
    studio: bool = True,
    messages: Callable[[str], object] | None = None,
) -> Scene:
    """Reads a scene from a text, in POV-Ray's language unless ``format`` names another; ``name`` stands for the file in messages. See `load`."""
    reading = _reading(format, declare, clock, size, library, version, header, limits, studio, messages)
    if not isinstance(text, (str, bytes, bytearray, memoryview)):
        raise TypeError(f"a scene is a str or bytes, not {type(text).__name__}")
    data = text.encode() if isinstance(text, str) else bytes(text)
    return Scene._of(_strahl.parse(data, name, reading))
