"""Exceptions and warnings."""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from dataclasses import dataclass


@dataclass(frozen=True)
class Diagnostic:
    """A message about a scene: what was found, what was expected, where, and what to do."""

    severity: str
    """``"error"`` or ``"warning"``."""
    message: str
    """What is wrong, as a sentence without a full stop."""
    file: str | None
    """The file, or the name that stands for it."""
    line: int | None
    """Line, counted from 1."""
    column: int | None
    """Column in characters, counted from 1."""
    hints: list[str]
    """What to do about it."""
    trace: list[str]
    """The macros and include files around the place, innermost first."""
    text: str
    """All of it, with the line of the scene and a caret under the place."""

    def __str__(self) -> str:
        return self.text


class SceneError(ValueError):
    """A scene has errors. ``str()`` shows all of them, with file, line and caret."""

    diagnostics: tuple[Diagnostic, ...]
    """All errors, and the warnings that were found before them."""

    def __init__(self, diagnostics: Sequence[Diagnostic]) -> None:
        super().__init__("\n".join(str(diagnostic) for diagnostic in diagnostics))
        self.diagnostics = tuple(diagnostics)

    def __reduce__(self) -> tuple[type[SceneError], tuple[tuple[Diagnostic, ...]]]:
        return SceneError, (self.diagnostics,)


class SceneWarning(UserWarning):
    """A scene is rendered as requested, but something deserves attention."""

    diagnostic: Diagnostic
    """What, and where."""

    def __init__(self, diagnostic: Diagnostic) -> None:
        super().__init__(str(diagnostic))
        self.diagnostic = diagnostic


class InternalError(RuntimeError):
    """A bug in strahl. Other scenes and pictures are not affected."""


def issue(diagnostic: Diagnostic) -> None:
    """Issues a warning at the line that called the package."""
    warnings.warn(SceneWarning(diagnostic), stacklevel=_level())


def _level() -> int:
    """Level of the first frame outside of the package, as `warnings.warn` counts in `issue`."""
    import sys

    level, frame = 1, sys._getframe(1)
    while frame.f_back is not None and frame.f_globals.get("__name__", "").startswith("strahl."):
        level, frame = level + 1, frame.f_back
    return level
