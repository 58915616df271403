"""How far a render is: for functions, terminals and notebooks."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable
from dataclasses import dataclass
from html import escape
from typing import Any, Protocol

import numpy as np
import numpy.typing as npt

from strahl import _strahl
from strahl._film import Film


@dataclass(frozen=True)
class Progress:
    """How far a render is: what a progress function gets, at most twenty times a second."""

    step: int
    """Number of the pass, from 0."""
    steps: int
    """Number of passes."""
    done: int
    """Parts of this pass that are done."""
    of: int
    """Parts of this pass."""

    @property
    def fraction(self) -> float:
        """How much of this pass is done, from 0 to 1."""
        return self.done / self.of if self.of else 0.0


class Shown(Protocol):
    """A line that shows how far a render is."""

    def tick(self, progress: Progress) -> object:
        """Takes notice of a step."""

    def finish(self) -> None:
        """Takes the line away."""


class _Function:
    """Hands the steps to a function of the user's."""

    def __init__(self, function: Callable[[Progress], object]) -> None:
        self._function = function

    def tick(self, progress: Progress) -> object:
        return self._function(progress)

    def finish(self) -> None:
        """There is nothing to take away."""


def shown(progress: bool | Callable[[Progress], object] | None) -> Shown | None:
    """Where to show the progress: as asked for, and by default in notebooks and on terminals after the first second."""
    if callable(progress):
        return _Function(progress)
    if progress is False:
        return None
    quiet = 0.0 if progress else 1.0
    if in_notebook():
        return _Bar(quiet)
    stream = sys.stderr
    if progress or (stream is not None and stream.isatty()):
        return _Line(quiet)
    return None


def in_notebook() -> bool:
    """Whether the program runs in a notebook: a kernel of IPython's that shows more than text."""
    if "ipykernel" not in sys.modules:
        return False
    from IPython import get_ipython  # type: ignore[attr-defined,import-not-found,unused-ignore]

    return hasattr(get_ipython(), "kernel")  # type: ignore[no-untyped-call,unused-ignore]


class _Clock:
    """The words beside a bar, and when they are due."""

    def __init__(self, quiet: float, interval: float) -> None:
        now = time.perf_counter()
        self._start, self._due, self._interval = now, now + quiet, interval
        self._pass, self._pass_start = 0, now

    def words(self, progress: Progress) -> str | None:
        """What to write, or None if it is too early."""
        now = time.perf_counter()
        if progress.step != self._pass:
            self._pass, self._pass_start = progress.step, now
        if now < self._due:
            return None
        self._due = now + self._interval
        passed = now - self._pass_start
        left = passed * (1 / progress.fraction - 1) if progress.fraction else float("nan")
        return f"{progress.done}/{progress.of} [{_minutes(now - self._start)}<{_minutes(left)}]"


def _minutes(seconds: float) -> str:
    if not seconds < 360_000:
        return "?"
    minutes, second = divmod(int(seconds), 60)
    hours, minute = divmod(minutes, 60)
    return f"{hours}:{minute:02}:{second:02}" if hours else f"{minute:02}:{second:02}"


class _Line:
    """A line on the standard error: the pass, a bar, parts, the time so far and the time that this pass still takes."""

    WIDTH = 30

    def __init__(self, quiet: float) -> None:
        self._clock = _Clock(quiet, 0.0)
        self._length = 0
        encoding = (getattr(sys.stderr, "encoding", None) or "ascii").lower()
        self._full, self._empty = ("█", " ") if encoding.startswith("utf") else ("#", ".")

    def tick(self, progress: Progress) -> None:
        words = self._clock.words(progress)
        if words is None:
            return
        full = int(progress.fraction * self.WIDTH)
        bar = self._full * full + self._empty * (self.WIDTH - full)
        text = f"pass {progress.step + 1}/{progress.steps} {progress.fraction:4.0%}|{bar}| {words}"
        print("\r" + text.ljust(self._length), end="", file=sys.stderr, flush=True)
        self._length = max(self._length, len(text))

    def finish(self) -> None:
        if self._length:
            print("\r" + " " * self._length + "\r", end="", file=sys.stderr, flush=True)


class _Bar:
    """The same in a notebook."""

    def __init__(self, quiet: float) -> None:
        self._clock = _Clock(quiet, 0.2)
        self._output = Output()

    def tick(self, progress: Progress) -> None:
        words = self._clock.words(progress)
        if words is None:
            return
        text = f"pass {progress.step + 1}/{progress.steps} {progress.fraction:4.0%}"
        bar = f'<progress max="1" value="{progress.fraction:.4f}" style="width: 20em; vertical-align: middle"></progress>'
        html = f'<span style="font-family: monospace; white-space: pre">{escape(text)} {bar} {escape(words)}</span>'
        self._output.put({"text/html": html, "text/plain": f"{text} {words}"}, raw=True)

    def finish(self) -> None:
        self._output.clear()


class Output:
    """A place in the output of a notebook's cell. Raises ImportError without IPython."""

    def __init__(self) -> None:
        from IPython.display import DisplayHandle  # type: ignore[import-not-found,unused-ignore]

        self._handle: Any = DisplayHandle()  # type: ignore[no-untyped-call,unused-ignore]
        self._used = False

    def put(self, thing: Any, **options: Any) -> None:
        """Shows a thing instead of the one before."""
        if self._used:
            self._handle.update(thing, **options)
        else:
            self._handle.display(thing, **options)
            self._used = True

    def clear(self) -> None:
        """Takes it away."""
        if self._used:
            self._handle.update({"text/html": "", "text/plain": ""}, raw=True)


class Preview:
    """Shows a picture in a notebook while it is made."""

    def __init__(self, size: tuple[int, int]) -> None:
        try:
            self._output = Output()
        except ImportError:
            raise ImportError("preview=True needs IPython") from None
        self._size = size
        self._last = time.perf_counter()

    def is_due(self) -> bool:
        """Whether the last picture is old enough for a new one."""
        return time.perf_counter() - self._last > 0.5

    def show(self, pixels: npt.NDArray[np.float32]) -> None:
        """Shows linear colours, three numbers for each pixel."""
        width, height = self._size
        data = _strahl.encode_png(np.ascontiguousarray(pixels).reshape(-1, 3), width, height)
        self._output.put({"image/png": data, "text/plain": f"a picture of {width}x{height} in the making"}, raw=True)
        self._last = time.perf_counter()

    def final(self, film: Film) -> None:
        """Shows the finished picture."""
        self._output.put(film)
