"""Scenes: loading, building, rendering and asking."""

from __future__ import annotations

import json
import os
import sys
import time
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, cast, Literal

import numpy as np
import numpy.typing as npt

from strahl import _strahl
from strahl._convert import ColorLike, color, integer, number, real
from strahl._film import Film
from strahl._lights import Light
from strahl._looks import Background, Camera, background_of
from strahl._objects import Object
from strahl._rays import Hits
from strahl._tree import Explanation, read

Declared = float | str | Sequence[float]


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


class Comparison(list[dict[str, Any]]):
    """The rows of `Scene.compare`: a list of dictionaries, one for each accelerator."""

    def to_dataframe(self) -> Any:
        """A pandas.DataFrame with the accelerators as its index. It needs pandas."""
        import pandas  # type: ignore[import-not-found,import-untyped,unused-ignore]

        return pandas.DataFrame(self).set_index("accelerator")


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
    data = text.encode() if isinstance(text, str) else bytes(text)
    return Scene._of(_strahl.parse(data, name, reading))


class Scene:
    """Objects, lights, a camera and a background. It grows by `add`; pictures and answers are always those of the scene as it is.

    The first picture or question compiles the scene, which later ones use again until something is added. A scene may be used from several Python
    threads at once. Every method takes ``threads``, the number of threads to compute with (one per processor unless given, and at most that).
    """

    def __init__(
        self,
        *things: Object | Light | Camera | Background | Scene | Iterable[Any],
        background: Background | ColorLike | None = None,
        ambient: ColorLike | None = None,
    ) -> None:
        self._core = _strahl.Scene()
        if background is not None:
            self._core.set_background(background_of(background)._core)
        if ambient is not None:
            self._core.set_ambient(color(ambient, "ambient"))
        self.add(*things)

    @classmethod
    def _of(cls, core: _strahl.Scene) -> Scene:
        self = cls.__new__(cls)
        self._core = core
        return self

    def add(self, *things: Object | Light | Camera | Background | Scene | Iterable[Any]) -> Scene:
        """Adds objects and lights; a camera or background takes the place of the one before. Returns the scene itself.

        Of another scene everything is added, but its camera, background and ambient light only where this scene has none.
        """
        for thing in things:
            if isinstance(thing, Object):
                self._core.add_object(thing._core)
            elif isinstance(thing, Light):
                self._core.add_light(thing._core, thing._place)
            elif isinstance(thing, Camera):
                self._core.set_camera(thing._core)
            elif isinstance(thing, Background):
                self._core.set_background(thing._core)
            elif isinstance(thing, Scene):
                self._core.add_scene(thing._core.copy() if thing is self else thing._core)
            elif isinstance(thing, Iterable) and not isinstance(thing, (str, bytes)):
                self.add(*thing)
            else:
                raise TypeError(f"a scene consists of objects, lights, a camera and a background, not {type(thing).__name__}")
        return self

    def copy(self) -> Scene:
        """A scene with the same contents that grows independently."""
        return Scene._of(self._core.copy())

    @property
    def camera(self) -> Camera | None:
        """The scene's camera; None if it has none, and pictures frame the objects."""
        core = self._core.camera()
        return None if core is None else Camera(core)

    @property
    def size(self) -> tuple[int, int]:
        """Width and height of a picture that has no size of its own."""
        return self._core.size()

    @property
    def bounds(self) -> npt.NDArray[np.float64] | None:
        """(2, 3) float64: smallest and largest coordinates of everything bounded; None if there is nothing."""
        bounds = self._core.bounds()
        return None if bounds is None else np.array(bounds)

    def stats(self, *, threads: int | None = None) -> dict[str, int]:
        """Sizes of the compiled scene: objects, primitives, elements, lights, bytes, ..."""
        return self._core.stats(threads)

    def object_name(self, number: int) -> str:
        """Kind and name of the object with a number, as arrays of `Film` and `Hits` have them."""
        name, kind, _ = self._object(number)
        return f'{kind} "{name}"' if name else kind

    def object_source(self, number: int) -> str | None:
        """The place that made the object, as ``file:line`` or ``file:line:column``."""
        return self._object(number)[2]

    def _object(self, number: int) -> tuple[str | None, str, str | None]:
        info = self._core.object_info(integer(number, "number", 0))
        if info is None:
            raise IndexError(f"the scene has no object {number}")
        return info

    def _view(
        self,
        width: int | None,
        height: int | None,
        sampling: str,
        depth: int | None,
        adc_bailout: float | None,
        shading: str | None,
        camera: Camera | None,
        seed: int,
        threads: int | None,
        accelerator: str | None = None,
    ) -> dict[str, Any]:
        size: tuple[int, int] | None = None
        if width is not None or height is not None:
            own = self.size
            # One of them alone keeps the ratio.
            if height is None and width is not None:
                height = max(1, round(integer(width, "width", 1) * own[1] / own[0]))
            if width is None and height is not None:
                width = max(1, round(integer(height, "height", 1) * own[0] / own[1]))
            size = integer(width, "width", 1), integer(height, "height", 1)
        return {
            "size": size,
            "sampling": sampling,
            "seed": integer(seed, "seed", 0),
            "depth": None if depth is None else integer(depth, "depth", 1),
            "adc_bailout": None if adc_bailout is None else number(adc_bailout, "adc_bailout"),
            "shading": shading,
            "camera": None if camera is None else camera._core,
            "threads": _threads(threads),
            "accelerator": accelerator,
        }

    def render(
        self,
        width: int | None = None,
        height: int | None = None,
        *,
        sampling: str = "adaptive",
        depth: int | None = None,
        camera: Camera | None = None,
        region: tuple[int, int, int, int] | None = None,
        layers: bool = False,
        alpha: bool = False,
        shading: str | None = None,
        adc_bailout: float | None = None,
        seed: int = 0,
        threads: int | None = None,
        progress: bool | Callable[[Progress], object] | None = None,
        preview: bool = False,
    ) -> Film:
        """Renders a picture. It has the bits of the one that ``strahl render`` makes with the same settings.

        ``width`` and ``height`` are in pixels; one alone keeps the ratio of the scene's size. ``sampling`` is ``"adaptive"`` (more rays where neighbours differ, also
        ``"adaptive:THRESHOLD,DEPTH"``), ``"center"`` (one ray per pixel), ``"3x3"`` and the like, ``"corners"`` or ``"recursive"``. ``depth`` is the deepest level of the ray tree. ``camera`` takes the
        place of the scene's. ``region`` is x, y, width and height of the part to render. ``layers`` fills depth, normals and so on, ``alpha`` the
        alpha channel. ``shading`` overrides all shading models, also with ``"normals"``, ``"depth"``, ``"object-id"``, ``"uv"``.

        ``progress`` is a function that gets a `Progress`, True for a line on the standard error, or False; by default there is a line on terminals and in
        notebooks, for renders that take longer than a second. ``preview`` shows the picture in a notebook while it is made, from coarse to fine.

        Other Python threads run meanwhile. Ctrl-C ends it with KeyboardInterrupt. Raises `SceneError` if the scene has errors, and ValueError for impossible
        settings or a picture that doesn't fit into memory.
        """
        view = self._view(width, height, sampling, depth, adc_bailout, shading, camera, seed, threads)
        output = _output(region=_region(region), layers=layers, alpha=alpha, coarse_first=preview)
        tick, finish = _ticker(progress)
        show = _Preview() if preview else None

        def step(number: int, steps: int, done: int, of: int) -> bool:
            if tick is not None and of > 0:
                tick(Progress(number, steps, done, of))
            return show is not None and show.is_due()

        # Compiled here, so that the time of the picture is its own.
        self._core.stats(_threads(threads))
        start = time.perf_counter()
        try:
            if show is None:
                core = self._core.render(view, output, step)
            else:
                shown = show
                picture_size = view["size"] or self.size
                core = self._core.render(view, output, step, lambda pixels: shown.show(pixels, picture_size))
        finally:
            finish()
        film = Film(core, time.perf_counter() - start)
        if show is not None:
            show.final(film)
        return film

    def explain(
        self,
        x: int,
        y: int,
        width: int | None = None,
        height: int | None = None,
        *,
        sampling: str = "adaptive",
        depth: int | None = None,
        camera: Camera | None = None,
        shading: str | None = None,
        adc_bailout: float | None = None,
        seed: int = 0,
        threads: int | None = None,
    ) -> Explanation:
        """The ray trees of the pixel in column ``x`` and row ``y`` of the picture that `render` makes with the same arguments, with all their numbers.

        Raises ValueError if there is no such pixel.
        """
        view = self._view(width, height, sampling, depth, adc_bailout, shading, camera, seed, threads)
        return read(json.loads(self._core.explain(integer(x, "x", 0), integer(y, "y", 0), view)))

    def intersect(
        self,
        origins: npt.ArrayLike,
        directions: npt.ArrayLike,
        t_min: float = 0.0,
        t_max: float = float("inf"),
        *,
        threads: int | None = None,
    ) -> Hits:
        """The nearest hit of each ray with t_min < t <= t_max, as rays of the camera see the scene.

        ``origins`` and ``directions`` have the shape (..., 3) and are broadcast against each other, so that one origin may serve many directions. Directions need not
        have length 1: `Hits.t` counts in their lengths. Rays with a NaN or infinite number or without direction hit nothing. float64 arrays in C
        order are read as they are.
        """
        first, second, shape = _rays(origins, directions)
        core = self._core.intersect(first, second, _range(t_min, t_max), _threads(threads))
        return Hits(core, shape)

    def occluded(
        self,
        origins: npt.ArrayLike,
        directions: npt.ArrayLike,
        t_min: float = 0.0,
        t_max: float = float("inf"),
        *,
        threads: int | None = None,
    ) -> npt.NDArray[np.bool_]:
        """(...) bool: whether an opaque surface is on each ray with t_min < t <= t_max, as rays to lights see the scene: glass does not count.

        For directions that reach from a point to a light, ``t_max=1`` asks whether the light is seen. Arguments are those of `intersect`.
        """
        first, second, shape = _rays(origins, directions)
        return self._core.occluded(first, second, _range(t_min, t_max), _threads(threads)).reshape(shape)

    def inside(self, points: npt.ArrayLike, *, threads: int | None = None) -> npt.NDArray[np.int32]:
        """(...) int32: the number of the solid around each point (..., 3), of several the last one in the order of the scene; -1 is outside of all.

        Half-spaces and combinations are solids; meshes and other surfaces have no inside. NaN is outside.
        """
        numbers = real(points, "points")
        if numbers.shape[-1:] != (3,):
            raise ValueError(f"points must have the shape (..., 3), not {numbers.shape}")
        flat = np.ascontiguousarray(numbers).reshape(-1, 3)
        return self._core.inside(flat, _threads(threads)).reshape(numbers.shape[:-1])

    def heatmap(
        self,
        width: int | None = None,
        height: int | None = None,
        *,
        metric: Literal["tests", "steps", "rays", "depth", "time"] = "tests",
        sampling: str = "center",
        depth: int | None = None,
        camera: Camera | None = None,
        accelerator: str | None = None,
        threads: int | None = None,
    ) -> npt.NDArray[np.float64]:
        """(h, w) float64: the cost of each pixel. ``metric`` is objects ``"tests"``, nodes or cells (``"steps"``), ``"rays"``, the ``"depth"`` of the tree or ``"time"`` in microseconds."""
        column = "nanoseconds" if metric == "time" else metric
        view = self._view(width, height, sampling, depth, None, None, camera, 0, threads, accelerator)
        core = self._core.render(view, _output(costs=True))
        costs = core.costs() or {}
        if column not in costs:
            raise ValueError(f"there is no metric {metric!r}; the metrics are tests, steps, rays, depth and time")
        values = costs[column].astype(np.float64).reshape(core.region[3], core.region[2])
        return values / 1000 if metric == "time" else values

    def compare(
        self,
        accelerators: Sequence[str] = ("bvh", "bvh2", "grid", "octree"),
        width: int | None = None,
        height: int | None = None,
        *,
        sampling: str = "center",
        depth: int | None = None,
        camera: Camera | None = None,
        threads: int | None = None,
    ) -> Comparison:
        """Renders with one accelerator after the other. Returns a row for each: accelerator, build_s, trace_s, rays, hits, steps_per_ray, tests_per_ray, bytes, nodes,
        references and sha256, which are all the same. `Comparison.to_dataframe` makes a table for pandas."""
        table = Comparison()
        for name in accelerators:
            view = self._view(width, height, sampling, depth, None, None, camera, 0, threads, name)
            numbers, sha256 = self._core.measure(view)
            table.append({"accelerator": name, **numbers, "sha256": sha256})
        return table

    def __repr__(self) -> str:
        objects, lights = self._core.counts()
        return f"<strahl.Scene with {objects} objects and {lights} lights>"


def _threads(threads: int | None) -> int | None:
    return None if threads is None else integer(threads, "threads", 1)


def _region(region: tuple[int, int, int, int] | None) -> tuple[int, int, int, int] | None:
    if region is None:
        return None
    x, y, width, height = region
    return (
        integer(x, "region", 0),
        integer(y, "region", 0),
        integer(width, "region", 1),
        integer(height, "region", 1),
    )


def _output(
    *,
    region: tuple[int, int, int, int] | None = None,
    layers: bool = False,
    alpha: bool = False,
    costs: bool = False,
    coarse_first: bool = False,
) -> dict[str, Any]:
    return {
        "region": region,
        "layers": layers,
        "alpha": alpha,
        "costs": costs,
        "coarse_first": coarse_first,
    }


def _range(t_min: float, t_max: float) -> tuple[float, float]:
    low, high = float(t_min), float(t_max)
    if np.isnan(low) or np.isnan(high):
        raise ValueError("t_min and t_max must be numbers, not NaN")
    return low, high


def _rays(origins: Any, directions: Any) -> tuple[npt.NDArray[np.float64], npt.NDArray[np.float64], tuple[int, ...]]:
    """Contiguous rows (n, 3) of both, and the shape of the answers."""
    first, second = real(origins, "origins"), real(directions, "directions")
    for array, name in ((first, "origins"), (second, "directions")):
        if array.shape[-1:] != (3,):
            raise ValueError(f"{name} must have the shape (..., 3), not {array.shape}")
    try:
        shape = np.broadcast_shapes(first.shape, second.shape)
    except ValueError:
        raise ValueError(f"origins {first.shape} and directions {second.shape} do not fit together") from None
    first = np.ascontiguousarray(np.broadcast_to(first, shape)).reshape(-1, 3)
    second = np.ascontiguousarray(np.broadcast_to(second, shape)).reshape(-1, 3)
    return first, second, shape[:-1]


class _Preview:
    """Shows a picture in a notebook while it is made."""

    def __init__(self) -> None:
        try:
            from IPython.display import DisplayHandle  # type: ignore[import-not-found,unused-ignore]
        except ImportError:
            raise ImportError("preview=True needs IPython") from None
        self._handle: Any = DisplayHandle()  # type: ignore[no-untyped-call,unused-ignore]
        self._shown = False
        self._last = time.perf_counter()

    def is_due(self) -> bool:
        return time.perf_counter() - self._last > 0.5

    def show(self, pixels: npt.NDArray[np.float32], size: tuple[int, int]) -> None:
        from IPython.display import Image

        width, height = size
        data = _strahl.encode_png(np.ascontiguousarray(pixels).reshape(-1, 3), width, height)
        self._put(Image(data=data, format="png"))  # type: ignore[no-untyped-call,unused-ignore]
        self._last = time.perf_counter()

    def final(self, film: Film) -> None:
        self._put(film)

    def _put(self, thing: Any) -> None:
        if self._shown:
            self._handle.update(thing)
        else:
            self._handle.display(thing)
            self._shown = True


def _ticker(
    progress: bool | Callable[[Progress], object] | None,
) -> tuple[Callable[[Progress], object] | None, Callable[[], None]]:
    """What to call with the progress, and what to call in the end."""
    if callable(progress):
        return progress, lambda: None
    if progress is False or (progress is None and not _is_watched()):
        return None, lambda: None
    line = _Line(0.0 if progress else 1.0)
    return line.tick, line.finish


def _is_watched() -> bool:
    if "ipykernel" in sys.modules:
        return True
    stream = sys.stderr
    return stream is not None and stream.isatty()


class _Line:
    """A line of progress on the standard error."""

    WIDTH = 30

    def __init__(self, quiet: float) -> None:
        self._start = time.perf_counter()
        self._quiet = quiet
        self._length = 0

    def tick(self, progress: Progress) -> None:
        passed = time.perf_counter() - self._start
        if passed < self._quiet:
            return
        full = int(progress.fraction * self.WIDTH)
        bar = "#" * full + "." * (self.WIDTH - full)
        text = f"pass {progress.step + 1}/{progress.steps} [{bar}] {progress.fraction:4.0%} {passed:.0f} s"
        print("\r" + text.ljust(self._length), end="", file=sys.stderr, flush=True)
        self._length = len(text)

    def finish(self) -> None:
        if self._length:
            print("\r" + " " * self._length + "\r", end="", file=sys.stderr, flush=True)
