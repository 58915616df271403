"""Scenes: building, rendering and asking."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable, Sequence
from math import prod
from typing import Any, Literal, TypeAlias

import numpy as np
import numpy.typing as npt

from strahl import _strahl
from strahl._air import Fog, Rainbow
from strahl._cameras import Camera
from strahl._convert import ColorLike, color, integer, number, real
from strahl._costs import Comparison, HeatMap
from strahl._film import Film
from strahl._lights import Light
from strahl._looks import Background, background_of
from strahl._objects import Object
from strahl._progress import Preview, Progress, shown
from strahl._rays import Hits
from strahl._reader import read
from strahl._tree import Explanation


class Scene:
    """Objects, lights, fogs, rainbows, a camera and a background. It grows by `add`; pictures and answers are always those of the scene as it is.

    The first picture or question compiles the scene, which later ones use again until something is added. A scene may be used from several Python
    threads at once. Every method takes ``threads``, the number of threads to compute with (one per processor unless given, and at most that).
    """

    def __init__(
        self,
        *things: Thing | Iterable[Any],
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

    def add(self, *things: Thing | Iterable[Any]) -> Scene:
        """Adds objects, lights, fogs and rainbows; a camera or background takes the place of the one before. Returns the scene itself.

        Of another scene everything is added, but its camera, background and ambient light only where this scene has none.
        """
        for thing in things:
            if isinstance(thing, Object):
                self._core.add_object(thing._core)
            elif isinstance(thing, Light):
                self._core.add_light(thing._core, thing._place)
            elif isinstance(thing, Fog):
                self._core.add_fog(thing._core)
            elif isinstance(thing, Rainbow):
                self._core.add_rainbow(thing._core)
            elif isinstance(thing, Camera):
                self._core.set_camera(thing._core)
            elif isinstance(thing, Background):
                self._core.set_background(thing._core)
            elif isinstance(thing, Scene):
                self._core.add_scene(thing._core.copy() if thing is self else thing._core)
            elif isinstance(thing, Iterable) and not isinstance(thing, (str, bytes)):
                self.add(*thing)
            else:
                raise TypeError(f"a scene consists of objects, lights, fogs, rainbows, a camera and a background, not {type(thing).__name__}")
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
    def quality(self) -> int:
        """How much pictures show, from 0 to 9, as ``--quality`` of `strahl render` has it; 9 is everything. A changed scene is compiled again."""
        return self._core.quality()

    @quality.setter
    def quality(self, level: int) -> None:
        if integer(level, "quality", 0) > 9:
            raise ValueError(f"quality must be at most 9, not {level}")
        self._core.set_quality(level)

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

        ``progress`` is a function that gets a `Progress`, True for a bar in the notebook or on the standard error, or False; by default there is a bar in notebooks and on
        terminals, for renders that take longer than a second. ``preview`` shows the picture in a notebook while it is made, from coarse to fine.

        Other Python threads run meanwhile. Ctrl-C ends it with KeyboardInterrupt. Raises `SceneError` if the scene has errors, and ValueError for impossible
        settings or a picture that doesn't fit into memory.
        """
        view = self._view(width, height, sampling, depth, adc_bailout, shading, camera, seed, threads)
        output = _output(region=_region(region), layers=layers, alpha=alpha, coarse_first=preview)
        line = shown(progress)
        picture = Preview(region[2:] if region else view["size"] or self.size) if preview else None

        def step(number: int, steps: int, done: int, of: int) -> bool:
            if line is not None and of > 0:
                line.tick(Progress(number, steps, done, of))
            return picture is not None and picture.is_due()

        # Compiled here, so that the time of the picture is its own.
        self._core.stats(_threads(threads))
        start = time.perf_counter()
        try:
            core = self._core.render(view, output, step, None if picture is None else picture.show)
        finally:
            if line is not None:
                line.finish()
        film = Film(core, time.perf_counter() - start)
        if picture is not None:
            picture.final(film)
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
        return read(self._core.explain(integer(x, "x", 0), integer(y, "y", 0), view))

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
        core = self._core.intersect(first, second, prod(shape), _range(t_min, t_max), _threads(threads))
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
        return self._core.occluded(first, second, prod(shape), _range(t_min, t_max), _threads(threads)).reshape(shape)

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
    ) -> HeatMap:
        """(h, w) float64: the cost of each pixel. ``metric`` is objects ``"tests"``, nodes or cells (``"steps"``), ``"rays"``, the ``"depth"`` of the tree or ``"time"``
        in microseconds. `HeatMap.to_dataframe` makes a table for pandas."""
        if metric not in _METRICS:
            raise ValueError(f"there is no metric {metric!r}; the metrics are {', '.join(_METRICS)}")
        view = self._view(width, height, sampling, depth, None, None, camera, 0, threads, accelerator)
        core = self._core.render(view, _output(costs=True))
        costs = core.costs() or {}
        columns: dict[str, npt.NDArray[Any]] = {name: costs[name] for name in _METRICS[:-1]}
        columns["time"] = costs["nanoseconds"] / 1000
        return HeatMap._of(metric, {name: values.reshape(core.region[3], core.region[2]) for name, values in columns.items()})

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
        """Renders with one accelerator after the other. Returns a row for each: accelerator, build_s, trace_s, steps_per_ray, tests_per_ray, rays, hits, bytes, nodes,
        references and sha256, which are all the same. `Comparison.to_dataframe` makes a table for pandas."""
        table = Comparison()
        for name in accelerators:
            view = self._view(width, height, sampling, depth, None, None, camera, 0, threads, name)
            numbers, sha256 = self._core.measure(view)
            counts = {column: int(numbers[column]) for column in ("rays", "hits", "bytes", "nodes", "references")}
            times = {column: numbers[column] for column in ("build_s", "trace_s", "steps_per_ray", "tests_per_ray")}
            table.append({"accelerator": name, **times, **counts, "sha256": sha256})
        return table

    def __repr__(self) -> str:
        objects, lights = self._core.counts()
        return f"<strahl.Scene with {objects} objects and {lights} lights>"


Thing: TypeAlias = Object | Light | Fog | Rainbow | Camera | Background | Scene
"""What a scene consists of."""

_METRICS = ("tests", "steps", "rays", "depth", "time")


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
    """Contiguous rows (n, 3) of both, or (1, 3) where one row serves all rays, and the shape of the answers."""
    first, second = real(origins, "origins"), real(directions, "directions")
    for array, name in ((first, "origins"), (second, "directions")):
        if array.shape[-1:] != (3,):
            raise ValueError(f"{name} must have the shape (..., 3), not {array.shape}")
    try:
        shape = np.broadcast_shapes(first.shape, second.shape)
    except ValueError:
        raise ValueError(f"origins {first.shape} and directions {second.shape} do not fit together") from None

    def rows(array: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
        whole = array if array.size == 3 else np.broadcast_to(array, shape)
        return np.ascontiguousarray(whole).reshape(-1, 3)

    return rows(first), rows(second), shape[:-1]
