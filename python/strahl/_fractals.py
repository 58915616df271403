"""Fractals and formulas: shapes of which there is no list of numbers."""

from __future__ import annotations

import os
from collections.abc import Mapping
from math import radians
from typing import Any, Literal

from strahl import _strahl
from strahl._convert import Vector, caller, integer, number, positive, real, vector
from strahl._load import Declared, parse
from strahl._looks import Look
from strahl._objects import Object, with_look


def julia(
    parameter: Vector,
    function: str = "sqr",
    *,
    algebra: Literal["quaternion", "hypercomplex"] = "quaternion",
    exponent: complex = 2,
    max_iteration: int = 20,
    precision: float = 20.0,
    slice: Vector = (0, 0, 0, 1),
    distance: float = 0.0,
    material: Look | None = None,
    name: str | None = None,
) -> Object:
    """A slice of a Julia set in four dimensions, as POV-Ray's ``julia_fractal``: the points whose orbit under ``function`` plus ``parameter`` (4 numbers) stays near the origin.

    Functions of quaternions are ``"sqr"`` and ``"cube"``; of hypercomplex numbers also ``"exp"``, ``"reciprocal"``, ``"sin"``, ``"asin"``, ``"sinh"``, ... ``"ln"`` and ``"pwr"`` with an ``exponent``. ``slice`` is
    the normal of the three-dimensional space and ``distance`` its distance from the origin. Parts thinner than 1 / (50 ``precision``) may be missed.
    """
    power = complex(exponent)
    core = _strahl.julia(
        {
            "parameter": _four(parameter, "parameter"),
            "algebra": algebra,
            "function": function,
            "exponent": (number(power.real, "exponent"), number(power.imag, "exponent")),
            "max_iteration": integer(max_iteration, "max_iteration", 1),
            "precision": positive(precision, "precision"),
            "slice": _four(slice, "slice"),
            "distance": number(distance, "distance"),
        },
        caller(),
    )
    return with_look(core, material, name)


def mandelbulb(
    power: int = 8,
    *,
    julia: Vector | None = None,
    max_iteration: int = 10,
    precision: float = 20.0,
    material: Look | None = None,
    name: str | None = None,
) -> Object:
    """The Mandelbulb of a ``power`` from 2 to 16: a solid about the origin, of radius 1.3 and less. ``julia`` is the constant of a Julia set instead.

    It is the set after ``max_iteration`` powers; parts thinner than 1 / (50 ``precision``) may be missed.
    """
    constant = None if julia is None else vector(julia, "julia")
    core = _strahl.mandelbulb(
        integer(power, "power", 2), constant, integer(max_iteration, "max_iteration", 1), positive(precision, "precision"), caller()
    )
    return with_look(core, material, name)


def menger(
    corner: Vector = (-1, -1, -1), opposite: Vector = (1, 1, 1), level: int = 3, *, material: Look | None = None, name: str | None = None
) -> Object:
    """Menger's sponge between two opposite corners: a box of which the middle of each face and the core are taken away, ``level`` times over, up to 20."""
    core = _strahl.menger(vector(corner, "corner"), vector(opposite, "opposite"), integer(level, "level", 0), caller())
    return with_look(core, material, name)


def terrain(
    kind: Literal["ridged", "hetero", "fbm"] = "ridged",
    *,
    x: tuple[float, float] | None = None,
    z: tuple[float, float] | None = None,
    h: float = 0.9,
    lacunarity: float = 2.1,
    octaves: float = 8.0,
    offset: float = 1.0,
    gain: float = 2.0,
    noise: Literal[1, 2, 3] = 2,
    viewpoint: Vector | None = None,
    angle: float = 0.05,
    material: Look | None = None,
    name: str | None = None,
) -> Object:
    """A fractal landscape: the surface y = height(x, z), solid below, over the ranges ``x`` and ``z``, or endless.

    Each of the ``octaves`` has ``lacunarity`` times the frequency of the one before and ``lacunarity ** -h`` of its strength. ``"ridged"`` has sharp crests, whose roughness grows by ``gain``;
    ``"hetero"`` has smooth valleys; ``"fbm"`` is rough everywhere. Heights begin at ``offset``. With a ``viewpoint`` octaves end where their waves are seen from there under less than
    ``angle`` degrees.
    """
    if (x is None) != (z is None):
        raise ValueError("x and z must be given together")
    extent = None
    if x is not None and z is not None:
        (left, right), (front, back) = x, z
        extent = [[number(left, "x"), number(front, "z")], [number(right, "x"), number(back, "z")]]
    core = _strahl.terrain(
        {
            "kind": kind,
            "h": number(h, "h"),
            "lacunarity": number(lacunarity, "lacunarity"),
            "octaves": number(octaves, "octaves"),
            "offset": number(offset, "offset"),
            "gain": number(gain, "gain"),
            "noise": integer(noise, "noise", 1),
            "extent": extent,
            "detail": None if viewpoint is None else (vector(viewpoint, "viewpoint"), radians(positive(angle, "angle"))),
        },
        caller(),
    )
    return with_look(core, material, name)


def implicit(
    formula: str,
    corner: Vector = (-1, -1, -1),
    opposite: Vector = (1, 1, 1),
    *,
    threshold: float = 0.0,
    declare: Mapping[str, Declared] | None = None,
    accuracy: float = 0.001,
    max_gradient: float | None = None,
    open: bool = False,
    material: Look | None = None,
    name: str | None = None,
) -> Object:
    """The surface where a formula of x, y and z in POV-Ray's language has the value ``threshold``, within a box; inside, values are smaller.

    ``strahl.implicit("x*x + y*y + A*z*z - 1", declare={"A": 2})``: ``declare`` has the values of names. The functions of ``functions.inc`` are known. The box closes the solid, unless it is
    ``open``. No gradient has to be guessed; only formulas with patterns need a ``max_gradient`` (1.1 if there is none), and if there is one for a sum over octaves of noise (``f_ridged_mf``), it is trusted, which is faster than proofs. Parts thinner than ``accuracy`` may be missed. Raises `SceneError` if the formula is wrong.
    """
    numbers: dict[str, Declared] = {"Strahl_low": vector(corner, "corner"), "Strahl_high": vector(opposite, "opposite"), "Strahl_threshold": number(threshold, "threshold")}
    gradient = "" if max_gradient is None else f'max_gradient {positive(max_gradient, "max_gradient")!r}'
    text = f"""isosurface {{ function {{
{formula}
}} contained_by {{ box {{ Strahl_low, Strahl_high }} }} threshold Strahl_threshold
accuracy {positive(accuracy, "accuracy")!r} {gradient} {"open" if open else ""} }}"""
    return _of_text(text, numbers, declare, material, name)


def parametric(
    x: str,
    y: str,
    z: str,
    u: tuple[float, float] = (0, 1),
    v: tuple[float, float] = (0, 1),
    *,
    corner: Vector = (-1e3, -1e3, -1e3),
    opposite: Vector = (1e3, 1e3, 1e3),
    declare: Mapping[str, Declared] | None = None,
    accuracy: float = 0.001,
    max_gradient: float = 1.0,
    material: Look | None = None,
    name: str | None = None,
) -> Object:
    """The surface of three formulas of u and v in POV-Ray's language, within a box: ``strahl.parametric("u*cos(v)", "v", "u*sin(v)", v=(0, 6))``. It has no inside.

    ``declare``, ``accuracy`` and ``max_gradient`` are those of `implicit`.
    """
    (low_u, high_u), (low_v, high_v) = u, v
    ranges = [number(low_u, "u"), number(low_v, "v"), number(high_u, "u"), number(high_v, "v")]
    numbers: dict[str, Declared] = {"Strahl_low": vector(corner, "corner"), "Strahl_high": vector(opposite, "opposite")}
    text = f"""parametric {{ function {{
{x}
}} function {{
{y}
}} function {{
{z}
}} <{ranges[0]!r}, {ranges[1]!r}>, <{ranges[2]!r}, {ranges[3]!r}> contained_by {{ box {{ Strahl_low, Strahl_high }} }}
accuracy {positive(accuracy, "accuracy")!r} max_gradient {positive(max_gradient, "max_gradient")!r} }}"""
    return _of_text(text, numbers, declare, material, name)


def text(
    line: str,
    font: str | os.PathLike[str],
    *,
    thickness: float = 0.25,
    spacing: Vector = (0, 0, 0),
    material: Look | None = None,
    name: str | None = None,
) -> Object:
    """Letters of height 1 in the plane of x and y, from the origin to the right, and ``thickness`` deep along z; ``spacing`` is added between them.

    ``font`` is a TrueType or OpenType file, or the name of one of the system's. Raises `SceneError` if there is none.
    """
    if not isinstance(line, str):
        raise TypeError(f"line must be a str, not {type(line).__name__}")
    numbers: dict[str, Any] = {
        "Strahl_line": line, "Strahl_font": os.fspath(font), "Strahl_thickness": number(thickness, "thickness"), "Strahl_spacing": vector(spacing, "spacing"),
    }
    return _of_text("text { ttf Strahl_font Strahl_line Strahl_thickness, Strahl_spacing }", numbers, None, material, name)


def _four(value: Vector, name: str) -> list[float]:
    numbers = real(value, name)
    if numbers.shape != (4,):
        raise ValueError(f"{name} must have 4 numbers, not the shape {numbers.shape}")
    return [number(each, name) for each in numbers.tolist()]


def _of_text(text: str, numbers: Mapping[str, Declared], declare: Mapping[str, Declared] | None, material: Look | None, name: str | None) -> Object:
    scene = parse('#include "functions.inc"\n' + text, name="formula", declare={**(declare or {}), **numbers})
    return with_look(scene._core.one_object().made_at(caller()), material, name)
