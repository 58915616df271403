"""Shapes from numbers."""

from __future__ import annotations

from collections.abc import Sequence

import numpy.typing as npt

from strahl import _strahl
from strahl._arrays import each, mesh
from strahl._convert import Vector, caller, finite_rows, integer, number, vector
from strahl._looks import Look
from strahl._objects import Object, with_look


def sphere(center: Vector = (0, 0, 0), radius: float = 1.0, *, material: Look | None = None, name: str | None = None) -> Object:
    """A sphere about a centre."""
    core = _strahl.sphere(vector(center, "center"), number(radius, "radius"), caller())
    return with_look(core, material, name)


def plane(point: Vector = (0, 0, 0), normal: Vector = (0, 1, 0), *, material: Look | None = None, name: str | None = None) -> Object:
    """An infinite plane through a point; as a solid it is the half-space behind it."""
    core = _strahl.plane(vector(point, "point"), vector(normal, "normal"), caller())
    return with_look(core, material, name)


def box(corner: Vector = (-1, -1, -1), opposite: Vector = (1, 1, 1), *, material: Look | None = None, name: str | None = None) -> Object:
    """A box with faces along the axes between two opposite corners."""
    core = _strahl.cuboid(vector(corner, "corner"), vector(opposite, "opposite"), caller())
    return with_look(core, material, name)


def disc(
    center: Vector = (0, 0, 0), normal: Vector = (0, 1, 0), radius: float = 1.0, *, hole: float = 0.0, material: Look | None = None, name: str | None = None
) -> Object:
    """A flat disc, perhaps with a round hole of radius ``hole``."""
    core = _strahl.disc(
        vector(center, "center"), vector(normal, "normal"), number(radius, "radius"), number(hole, "hole"), caller()
    )
    return with_look(core, material, name)


def cylinder(
    base: Vector = (0, 0, 0), apex: Vector = (0, 1, 0), radius: float = 1.0, *, open: bool = False, material: Look | None = None, name: str | None = None
) -> Object:
    """A cylinder between the centres of its ends; ``open`` ones have no caps."""
    core = _strahl.cylinder(vector(base, "base"), vector(apex, "apex"), number(radius, "radius"), open, caller())
    return with_look(core, material, name)


def cone(
    base: Vector = (0, 0, 0),
    base_radius: float = 1.0,
    apex: Vector = (0, 1, 0),
    apex_radius: float = 0.0,
    *,
    open: bool = False,
    material: Look | None = None,
    name: str | None = None,
) -> Object:
    """A cone, or a truncated one if both radii are positive; ``open`` ones have no caps."""
    core = _strahl.cone(
        vector(base, "base"),
        number(base_radius, "base_radius"),
        vector(apex, "apex"),
        number(apex_radius, "apex_radius"),
        open,
        caller(),
    )
    return with_look(core, material, name)


def torus(
    major: float = 1.0, minor: float = 0.25, *, center: Vector = (0, 0, 0), axis: Vector = (0, 1, 0), material: Look | None = None, name: str | None = None
) -> Object:
    """A torus: ``major`` is the radius of its circle, ``minor`` that of its tube."""
    core = _strahl.torus(
        vector(center, "center"), vector(axis, "axis"), number(major, "major"), number(minor, "minor"), caller()
    )
    return with_look(core, material, name)


def ovus(bottom: float, top: float, *, material: Look | None = None, name: str | None = None) -> Object:
    """An egg about the y axis, as POV-Ray's ``ovus``: the radii of its bottom and its top."""
    return with_look(_strahl.ovus(number(bottom, "bottom"), number(top, "top"), caller()), material, name)


def lemon(
    base: Vector, base_radius: float, apex: Vector, apex_radius: float, inner: float, *, material: Look | None = None, name: str | None = None
) -> Object:
    """An arc turned about an axis, as POV-Ray's ``lemon``; ``inner`` is the radius of the arc."""
    core = _strahl.lemon(
        vector(base, "base"),
        number(base_radius, "base_radius"),
        vector(apex, "apex"),
        number(apex_radius, "apex_radius"),
        number(inner, "inner"),
        caller(),
    )
    return with_look(core, material, name)


def quadric(coefficients: Sequence[float], *, material: Look | None = None, name: str | None = None) -> Object:
    """The surface A x² + B y² + C z² + D xy + E xz + F yz + G x + H y + I z + J = 0 for the 10 numbers A to J."""
    numbers = [number(c, "coefficients") for c in coefficients]
    if len(numbers) != 10:
        raise ValueError(f"a quadric has 10 coefficients, not {len(numbers)}")
    return with_look(_strahl.quadric(numbers, caller()), material, name)


def superellipsoid(e: float, n: float, *, material: Look | None = None, name: str | None = None) -> Object:
    """A superquadric ellipsoid within the cube from -1 to 1, as POV-Ray's."""
    return with_look(_strahl.superellipsoid(number(e, "e"), number(n, "n"), caller()), material, name)


def triangle(a: Vector, b: Vector, c: Vector, *, material: Look | None = None, name: str | None = None) -> Object:
    """A flat triangle."""
    return mesh([vector(a, "a"), vector(b, "b"), vector(c, "c")], [[0, 1, 2]], material=material, name=name)


def polygon(corners: npt.ArrayLike, *, holes: Sequence[npt.ArrayLike] = (), material: Look | None = None, name: str | None = None) -> Object:
    """A flat polygon with corners (n, 3), perhaps with holes of the same kind."""
    inner = [finite_rows(hole, "holes", 3) for hole in holes]
    return with_look(_strahl.polygon(finite_rows(corners, "corners", 3), inner, caller()), material, name)


def polynomial(terms: dict[tuple[int, int, int], float], *, material: Look | None = None, name: str | None = None) -> Object:
    """The surface where a polynomial is zero: ``{(i, j, k): c}`` stands for the sum of c xⁱ yʲ zᵏ, of a degree up to 35."""
    table = [(integer(i, "terms", 0), integer(j, "terms", 0), integer(k, "terms", 0), number(c, "terms")) for (i, j, k), c in terms.items()]
    return with_look(_strahl.polynomial(table, caller()), material, name)


def blob(
    balls: npt.ArrayLike = (), capsules: npt.ArrayLike = (), *, threshold: float = 0.6, material: Look | None = None, name: str | None = None
) -> Object:
    """Balls and capsules that merge smoothly.

    Rows of ``balls`` (n, 5) are x, y, z, radius, strength; rows of ``capsules`` (m, 8) are both ends, radius, strength. The surface is where the sum of
    all fields ``strength (1 - (d / radius)²)²`` is ``threshold``.
    """
    first, second = finite_rows(balls, "balls", 5), finite_rows(capsules, "capsules", 8)
    core = _strahl.blob(number(threshold, "threshold"), first.tolist(), second.tolist(), caller())
    return with_look(core, material, name)


def prism(
    points: npt.ArrayLike,
    low: float = 0.0,
    high: float = 1.0,
    *,
    curve: str = "linear",
    conic: bool = False,
    open: bool = False,
    material: Look | None = None,
    name: str | None = None,
) -> Object:
    """A figure in the plane of x and z, swept along y from ``low`` to ``high``. ``points`` (n, 2) are x and z; a closed curve ends with its first point.

    ``curve`` is ``"linear"``, ``"quadratic"``, ``"cubic"`` or ``"bezier"``, as in POV-Ray; ``conic`` scales the figure by the height.
    """
    heights = [number(low, "low"), number(high, "high")]
    core = _strahl.prism(finite_rows(points, "points", 2), heights, curve, conic, open, caller())
    return with_look(core, material, name)


def lathe(points: npt.ArrayLike, *, curve: str = "linear", material: Look | None = None, name: str | None = None) -> Object:
    """A curve turned about the y axis. ``points`` (n, 2) are radius and height; ``curve`` is as in `prism`."""
    return with_look(_strahl.lathe(finite_rows(points, "points", 2), curve, caller()), material, name)


def sor(points: npt.ArrayLike, *, open: bool = False, material: Look | None = None, name: str | None = None) -> Object:
    """A surface of revolution about the y axis whose radius is a smooth function of the height. ``points`` (n, 2) are radius and rising height."""
    return with_look(_strahl.sor(finite_rows(points, "points", 2), open, caller()), material, name)


def sphere_sweep(
    centers: npt.ArrayLike, radii: npt.ArrayLike, *, curve: str = "cubic", material: Look | None = None, name: str | None = None
) -> Object:
    """The volume that a sphere sweeps: centres (n, 3), radii (n,) or one number; ``curve`` is ``"linear"``, ``"bspline"`` or ``"cubic"``."""
    places = finite_rows(centers, "centers", 3)
    return with_look(_strahl.sphere_sweep(places, each(radii, "radii", len(places)), curve, caller()), material, name)


def pov(text: str, *, material: Look | None = None, name: str | None = None) -> Object:
    """Objects in POV-Ray's language, such as ``"julia_fractal { ... }"``: everything that its language has. Several are a union.

    Raises `SceneError` if the text is wrong.
    """
    from strahl._load import parse

    return with_look(parse(text, name="text")._core.one_object(), material, name)
