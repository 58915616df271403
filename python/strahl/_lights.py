"""Lights."""

from __future__ import annotations

from math import radians
from typing import Any, Literal, TypeAlias

from strahl import _strahl
from strahl._convert import ColorLike, Place, Vector, caller, integer, number, positive, vector
from strahl._convert import color as linear
from strahl._maps import Movable
from strahl._objects import Object

Falloff: TypeAlias = Literal["inverse-square"] | tuple[float, float] | None
"""How light gets weaker with distance: see `Light`."""

MOST = 1024
"""Most points along an edge of an area light."""


class Light(Movable):
    """A light source, made by `point_light`, `spot_light` and the like. It never changes; methods return new lights.

    All take: ``color``, its colour times its strength; ``falloff``, which is None (none: the classical model), ``"inverse-square"`` (the colour is then that at
    distance 1) or a pair (distance, power) as in POV-Ray; ``shadows`` and ``highlights``, whether it makes them; ``fogged``, whether fog attenuates it on its way; ``clearance``, the distance
    from the light within which objects cast no shadow; ``name`` for ray trees.
    """

    def __init__(self, core: _strahl.Light, place: Place) -> None:
        self._core = core
        self._place = place

    def _moved(self, by: _strahl.Map) -> Light:
        return Light(self._core.transformed(by), self._place)

    def area(
        self,
        axis_1: Vector,
        axis_2: Vector,
        size: tuple[int, int] = (9, 9),
        *,
        jitter: bool = False,
        circular: bool = False,
        orient: bool = False,
        adaptive: int | None = 1,
        illumination: bool = False,
        reach: float = 1.0,
    ) -> Light:
        """With a rectangle around its position instead of a point, which casts soft shadows: the axes are its edges, with a grid of ``size`` points.

        ``adaptive`` halves the grid so often in any case and then only where the shadow changes; None takes all points. ``jitter`` moves the points, ``circular`` makes an ellipse,
        ``orient`` turns the light towards each point. Each point also gives light of its own direction with ``illumination``. ``reach`` is the distance at which the points of parallel
        light are as far apart as the axes say.
        """
        across, along = (integer(count, "size", 1) for count in size)
        if max(across, along) > MOST:
            raise ValueError(f"size must be from 1 to {MOST} points along an edge, not {max(across, along)}")
        core = self._core.area(
            {
                "axis_1": vector(axis_1, "axis_1"),
                "axis_2": vector(axis_2, "axis_2"),
                "size": (across, along),
                "jitter": bool(jitter),
                "circular": bool(circular),
                "orient": bool(orient),
                "adaptive": None if adaptive is None else integer(adaptive, "adaptive", 0),
                "illumination": bool(illumination),
                "reach": positive(reach, "reach"),
            }
        )
        return Light(core, self._place)

    def through(self, mask: Object) -> Light:
        """Only where it passes through the surface of an object, which is invisible; what is beyond that casts no shadow."""
        return Light(self._core.through(mask._core), self._place)

    def with_body(self, body: Object) -> Object:
        """The light together with an object that shows where it is and casts no shadow: a lamp, to be added to a scene or moved as one."""
        return Object(_strahl.combined("union", [(self._core, self._place), body._core.lamp()], caller()))


def _light(kind: str, color: ColorLike, falloff: Falloff, shadows: bool, highlights: bool, fogged: bool, clearance: float, name: str | None, **numbers: Any) -> Light:
    fade = None
    if falloff is not None and falloff != "inverse-square":
        if isinstance(falloff, str) or len(falloff) != 2:
            raise ValueError(f"falloff must be None, 'inverse-square' or a pair, not {falloff!r}")
        fade = number(falloff[0], "distance"), number(falloff[1], "power")
    known = {
        "kind": kind,
        "position": (0.0, 0.0, 0.0),
        "direction": (0.0, 0.0, 0.0),
        "inner": 0.0,
        "outer": 0.0,
        "tightness": 0.0,
        "color": linear(color, "color"),
        "inverse_square": falloff == "inverse-square",
        "fade": fade,
        "shadows": bool(shadows),
        "highlights": bool(highlights),
        "fogged": bool(fogged),
        "clearance": number(clearance, "clearance"),
        "name": name,
    }
    return Light(_strahl.Light(known | numbers), caller())


def point_light(
    position: Vector,
    color: ColorLike = 1.0,
    *,
    falloff: Falloff = None,
    shadows: bool = True,
    highlights: bool = True,
    fogged: bool = False,
    clearance: float = 0.0,
    name: str | None = None,
) -> Light:
    """A light that shines from a point into all directions."""
    return _light(
        "point", color, falloff, shadows, highlights, fogged, clearance, name,
        position=vector(position, "position"),
    )


def directional_light(
    direction: Vector,
    color: ColorLike = 1.0,
    *,
    shadows: bool = True,
    highlights: bool = True,
    fogged: bool = False,
    clearance: float = 0.0,
    name: str | None = None,
) -> Light:
    """Parallel light from infinitely far away; ``direction`` is that in which it travels."""
    return _light(
        "directional", color, None, shadows, highlights, fogged, clearance, name,
        direction=vector(direction, "direction"),
    )


def _towards(position: Vector, target: Vector) -> tuple[float, float, float]:
    (x, y, z), (u, v, w) = vector(position, "position"), vector(target, "target")
    return u - x, v - y, w - z


def spot_light(
    position: Vector,
    target: Vector,
    color: ColorLike = 1.0,
    *,
    inner: float = 20.0,
    outer: float = 25.0,
    tightness: float = 0.0,
    falloff: Falloff = None,
    shadows: bool = True,
    highlights: bool = True,
    fogged: bool = False,
    clearance: float = 0.0,
    name: str | None = None,
) -> Light:
    """A light that shines from a point into a cone: full within ``inner`` degrees of the axis, none beyond ``outer``."""
    return _light(
        "spot", color, falloff, shadows, highlights, fogged, clearance, name,
        position=vector(position, "position"),
        direction=_towards(position, target),
        inner=radians(number(inner, "inner")),
        outer=radians(number(outer, "outer")),
        tightness=number(tightness, "tightness"),
    )


def parallel_light(
    position: Vector,
    target: Vector,
    color: ColorLike = 1.0,
    *,
    falloff: Falloff = None,
    shadows: bool = True,
    highlights: bool = True,
    fogged: bool = False,
    clearance: float = 0.0,
    name: str | None = None,
) -> Light:
    """Parallel light from the plane through a point that faces the target."""
    return _light(
        "parallel", color, falloff, shadows, highlights, fogged, clearance, name,
        position=vector(position, "position"),
        direction=_towards(position, target),
    )


def beam_light(
    position: Vector,
    target: Vector,
    color: ColorLike = 1.0,
    *,
    inner: float = 0.75,
    outer: float = 1.0,
    tightness: float = 0.0,
    falloff: Falloff = None,
    shadows: bool = True,
    highlights: bool = True,
    fogged: bool = False,
    clearance: float = 0.0,
    name: str | None = None,
) -> Light:
    """Parallel light within a cylinder: full up to ``inner`` units from the axis, none beyond ``outer``."""
    return _light(
        "beam", color, falloff, shadows, highlights, fogged, clearance, name,
        position=vector(position, "position"),
        direction=_towards(position, target),
        inner=number(inner, "inner"),
        outer=number(outer, "outer"),
        tightness=number(tightness, "tightness"),
    )


def area_light(
    position: Vector,
    axis_1: Vector,
    axis_2: Vector,
    color: ColorLike = 1.0,
    *,
    size: tuple[int, int] = (9, 9),
    jitter: bool = False,
    circular: bool = False,
    orient: bool = False,
    adaptive: int | None = 1,
    illumination: bool = False,
    falloff: Falloff = None,
    shadows: bool = True,
    highlights: bool = True,
    fogged: bool = False,
    clearance: float = 0.0,
    name: str | None = None,
) -> Light:
    """A rectangle with a grid of ``size`` points that casts soft shadows; ``position`` is its centre, the axes are its edges.

    The other arguments are those of `Light.area`, which makes area lights of other kinds.
    """
    light = _light(
        "point", color, falloff, shadows, highlights, fogged, clearance, name,
        position=vector(position, "position"),
    )
    return light.area(
        axis_1, axis_2, size, jitter=jitter, circular=circular, orient=orient, adaptive=adaptive, illumination=illumination
    )
