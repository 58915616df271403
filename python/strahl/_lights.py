"""Lights."""

from __future__ import annotations

from math import radians
from typing import Any

from strahl import _strahl
from strahl._convert import ColorLike, Place, Vector, caller, integer, number, vector
from strahl._convert import color as linear


class Light:
    """A light source, made by `point_light`, `spot_light` and the like.

    All take: ``color``, its colour times its strength; ``falloff``, which is None (none: the classical model), ``"inverse-square"`` (the colour is then that at
    distance 1) or a pair (distance, power) as in POV-Ray; ``shadows`` and ``highlights``, whether it makes them; ``name`` for ray trees.
    """

    def __init__(self, core: _strahl.Light, place: Place) -> None:
        self._core = core
        self._place = place


def _light(kind: str, falloff: str | tuple[float, float] | None, **numbers: Any) -> Light:
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
        "inverse_square": falloff == "inverse-square",
        "fade": fade,
        "area": None,
    }
    return Light(_strahl.Light(known | numbers), caller())


def point_light(
    position: Vector,
    color: ColorLike = 1.0,
    *,
    falloff: str | tuple[float, float] | None = None,
    shadows: bool = True,
    highlights: bool = True,
    name: str | None = None,
) -> Light:
    """A light that shines from a point into all directions."""
    return _light(
        "point",
        falloff,
        position=vector(position, "position"),
        color=linear(color, "color"),
        shadows=shadows,
        highlights=highlights,
        name=name,
    )


def directional_light(
    direction: Vector,
    color: ColorLike = 1.0,
    *,
    shadows: bool = True,
    highlights: bool = True,
    name: str | None = None,
) -> Light:
    """Parallel light from infinitely far away; ``direction`` is that in which it travels."""
    return _light(
        "directional",
        None,
        direction=vector(direction, "direction"),
        color=linear(color, "color"),
        shadows=shadows,
        highlights=highlights,
        name=name,
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
    falloff: str | tuple[float, float] | None = None,
    shadows: bool = True,
    highlights: bool = True,
    name: str | None = None,
) -> Light:
    """A light that shines from a point into a cone: full within ``inner`` degrees of the axis, none beyond ``outer``."""
    return _light(
        "spot",
        falloff,
        position=vector(position, "position"),
        direction=_towards(position, target),
        inner=radians(number(inner, "inner")),
        outer=radians(number(outer, "outer")),
        tightness=number(tightness, "tightness"),
        color=linear(color, "color"),
        shadows=shadows,
        highlights=highlights,
        name=name,
    )


def parallel_light(
    position: Vector,
    target: Vector,
    color: ColorLike = 1.0,
    *,
    falloff: str | tuple[float, float] | None = None,
    shadows: bool = True,
    highlights: bool = True,
    name: str | None = None,
) -> Light:
    """Parallel light from the plane through a point that faces the target."""
    return _light(
        "parallel",
        falloff,
        position=vector(position, "position"),
        direction=_towards(position, target),
        color=linear(color, "color"),
        shadows=shadows,
        highlights=highlights,
        name=name,
    )


def beam_light(
    position: Vector,
    target: Vector,
    color: ColorLike = 1.0,
    *,
    inner: float = 0.75,
    outer: float = 1.0,
    tightness: float = 0.0,
    falloff: str | tuple[float, float] | None = None,
    shadows: bool = True,
    highlights: bool = True,
    name: str | None = None,
) -> Light:
    """Parallel light within a cylinder: full up to ``inner`` units from the axis, none beyond ``outer``."""
    return _light(
        "beam",
        falloff,
        position=vector(position, "position"),
        direction=_towards(position, target),
        inner=number(inner, "inner"),
        outer=number(outer, "outer"),
        tightness=number(tightness, "tightness"),
        color=linear(color, "color"),
        shadows=shadows,
        highlights=highlights,
        name=name,
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
    falloff: str | tuple[float, float] | None = None,
    shadows: bool = True,
    highlights: bool = True,
    name: str | None = None,
) -> Light:
    """A rectangle with a grid of ``size`` points that casts soft shadows; ``position`` is its centre, the axes are its edges.

    ``adaptive`` halves the grid so often in any case and then only where the shadow changes; None takes all points. ``jitter`` moves the points,
    ``circular`` makes an ellipse, ``orient`` turns the light towards each point.
    """
    return _light(
        "point",
        falloff,
        position=vector(position, "position"),
        color=linear(color, "color"),
        shadows=shadows,
        highlights=highlights,
        name=name,
        area={
            "axis_1": vector(axis_1, "axis_1"),
            "axis_2": vector(axis_2, "axis_2"),
            "size": (integer(size[0], "size", 1), integer(size[1], "size", 1)),
            "jitter": jitter,
            "circular": circular,
            "orient": orient,
            "adaptive": adaptive,
        },
    )
