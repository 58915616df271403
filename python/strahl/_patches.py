"""Free-form surfaces."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from strahl import _strahl
from strahl._convert import caller, finite_rows, integer, real
from strahl._looks import Look
from strahl._objects import Object, flat, with_look


def bicubic_patch(
    points: npt.ArrayLike, *, weights: npt.ArrayLike | None = None, material: Look | None = None, name: str | None = None
) -> Object:
    """A bicubic Bézier patch with control points (4, 4, 3); positive weights (4, 4) make it rational, so that circles and spheres are exact."""
    net = _net(points)
    if net.shape != (4, 4, 3):
        raise ValueError(f"points must have the shape (4, 4, 3), not {net.shape}")
    core = _strahl.bicubic_patch(finite_rows(net.reshape(16, 3), "points", 3), _weights(weights, (4, 4)), caller())
    return with_look(core, material, name)


class NurbsCurve:
    """A curve in the plane of the parameters of a `nurbs` surface, for its loops: control points (n, 2) of u and v, in the units of the knots.

    ``degree`` is from 1, straight lines, to 9. ``weights`` (n,) are positive, 1 unless given. There are n + degree + 1 ascending ``knots``; without them the curve begins
    and ends at its outer points, and knots are evenly spaced.
    """

    def __init__(
        self, points: npt.ArrayLike, degree: int = 1, *, weights: npt.ArrayLike | None = None, knots: npt.ArrayLike | None = None
    ) -> None:
        table = finite_rows(points, "points", 2)
        numbers = _weights(weights, (len(table),))
        self._numbers = {
            "degree": _degree(degree),
            "points": table,
            "weights": [] if numbers is None else numbers.tolist(),
            "knots": None if knots is None else _knots(knots, "knots"),
        }


Loop: TypeAlias = NurbsCurve | Sequence[NurbsCurve] | npt.ArrayLike
"""A closed loop: corners (n, 2) of a polygon, or curves of which each begins where the one before it ends."""


def nurbs(
    points: npt.ArrayLike,
    degree: int | tuple[int, int] = 3,
    *,
    weights: npt.ArrayLike | None = None,
    knots: tuple[npt.ArrayLike, npt.ArrayLike] | None = None,
    trim: Iterable[Loop] = (),
    holes: Iterable[Loop] = (),
    material: Look | None = None,
    name: str | None = None,
) -> Object:
    """A NURBS surface with control points (rows, columns, 3): u runs along the columns, v from row to row. Rays meet the surface itself, without triangles.

    ``degree`` is that along u and v, or a pair, from 1 to 9. ``weights`` (rows, columns) are positive, 1 unless given. ``knots`` is a pair of ascending lists along u and
    v, of columns + degree + 1 and rows + degree + 1 numbers; without them the surface begins and ends at its outer points, and knots are the whole numbers from 0.

    ``trim`` and ``holes`` are loops in the plane of u and v, in the units of the knots: arrays (n, 2) of corners, or lists of `NurbsCurve`. The surface is there where
    an odd number of loops is around; with holes alone its border counts as one.

    A surface that is not trimmed and is closed, such as a ball or a ring, is a solid: its opposite sides have the same points, to the last bit, or are collapsed. Raises ValueError if numbers do not fit together.
    """
    net = _net(points)
    rows, columns, _ = net.shape
    both = degree if isinstance(degree, (list, tuple)) else (degree, degree)
    if len(both) != 2:
        raise ValueError(f"degree must be a number or a pair, not {degree!r}")
    lists = None
    if knots is not None:
        if len(knots) != 2:
            raise ValueError("knots must be a pair of lists, along u and along v")
        lists = [_knots(along, "knots") for along in knots]
    numbers = _weights(weights, (rows, columns))
    loops = [(_curves(loop), is_hole) for some, is_hole in ((trim, False), (holes, True)) for loop in some]
    core = _strahl.nurbs(
        [_degree(each) for each in both],
        columns,
        finite_rows(net.reshape(-1, 3), "points", 3),
        [] if numbers is None else numbers.tolist(),
        lists,
        loops,
        caller(),
    )
    return with_look(core, material, name)


def brep(*faces: Object | Iterable[Object], material: Look | None = None, name: str | None = None) -> Object:
    """The solid within `nurbs` surfaces that close a volume together, trimmed or whole: a boundary representation.

    ``faces`` are surfaces and lists of them, also moved ones and unions, in any order and turned either way; their materials do not count. Each border is that of
    another face, too, or of the same face elsewhere (the seam of a tube), within a ten-thousandth of the diagonal of the whole; such gaps let no ray through.

    Raises ValueError if the faces leave a gap, which tells where, or cross each other.
    """
    return with_look(_strahl.brep([face._core for face in flat(faces)], caller()), material, name)


def subdivision(
    points: npt.ArrayLike,
    faces: npt.ArrayLike | Sequence[Sequence[int]],
    scheme: str = "catmull-clark",
    *,
    creases: Iterable[tuple[Sequence[int], float]] = (),
    corners: Iterable[tuple[int, float]] = (),
    uv: npt.ArrayLike | None = None,
    material: Look | None = None,
    name: str | None = None,
) -> Object:
    """The limit of a mesh that is divided and smoothed without end, by the ``scheme`` "catmull-clark" or "loop". Rays meet the limit itself, without triangles.

    ``points`` are (n, 3). ``faces`` are rows of numbers of points, counter-clockwise seen from the front: an array (m, k), or a list of faces of 3 to 10000 corners; with "loop"
    all of them are triangles. ``creases`` are pairs of a line of points along edges and its sharpness, ``corners`` pairs of a point and its sharpness: so many levels of
    division treat them as sharp, 10 and more for ever. ``uv`` are texture coordinates (number of all corners, 2), those of the faces' corners one after the other.

    A mesh without a border is a solid. Raises ValueError if more than two faces meet at an edge, or if numbers do not fit together.
    """
    rows = [[integer(corner, "a corner of faces", 0) for corner in face] for face in np.asarray(faces, dtype=object)]
    edges = []
    for line, sharpness in creases:
        ends = [integer(point, "a point of creases", 0) for point in line]
        if len(ends) < 2:
            raise ValueError("a crease has two points at least")
        edges += [((a, b), float(sharpness)) for a, b in zip(ends, ends[1:])]
    numbers = {
        "scheme": scheme,
        "points": finite_rows(points, "points", 3),
        "sizes": [len(row) for row in rows],
        "indices": [corner for row in rows for corner in row],
        "creases": edges,
        "corners": [(integer(point, "a point of corners", 0), float(sharpness)) for point, sharpness in corners],
        "uv": None if uv is None else finite_rows(uv, "uv", 2),
    }
    return with_look(_strahl.subdivision(numbers, caller()), material, name)


def _degree(degree: int) -> int:
    result = integer(degree, "degree", 1)
    if result > 9:
        raise ValueError(f"degree must be from 1 to 9, not {result}")
    return result


def _net(points: npt.ArrayLike) -> npt.NDArray[np.float64]:
    net = real(points, "points")
    if net.ndim != 3 or net.shape[2] != 3 or net.size == 0:
        raise ValueError(f"points must have the shape (rows, columns, 3), not {net.shape}")
    return net


def _weights(weights: npt.ArrayLike | None, shape: tuple[int, ...]) -> npt.NDArray[np.float64] | None:
    """The weights of control points of this shape, in a row."""
    if weights is None:
        return None
    numbers = real(weights, "weights")
    if numbers.shape != shape:
        raise ValueError(f"weights must have the shape {shape}, not {numbers.shape}")
    return np.ascontiguousarray(numbers).reshape(-1)


def _knots(knots: npt.ArrayLike, name: str) -> list[float]:
    numbers = real(knots, name)
    if numbers.ndim != 1:
        raise ValueError(f"{name} must be a list of numbers, not of the shape {numbers.shape}")
    return [float(knot) for knot in numbers]


def _curves(loop: Loop) -> list[dict[str, Any]]:
    if isinstance(loop, NurbsCurve):
        return [loop._numbers]
    if isinstance(loop, (list, tuple)) and any(isinstance(part, NurbsCurve) for part in loop):
        curves = [part._numbers for part in loop if isinstance(part, NurbsCurve)]
        if len(curves) < len(loop):
            raise TypeError("a loop must be an array of corners or a list of curves, not of both")
        return curves
    corners = finite_rows(loop, "a loop", 2)
    if len(corners) == 0:
        raise ValueError("a loop must have corners")
    closed = (corners[0] == corners[-1]).all()
    return [NurbsCurve(corners if closed else np.concatenate([corners, corners[:1]]))._numbers]
