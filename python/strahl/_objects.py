"""Objects: shapes, and what is combined from them."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from math import radians
from typing import Any, Literal, TypeAlias

import numpy as np
import numpy.typing as npt

from strahl import _strahl
from strahl._convert import (
    ColorLike,
    Vector,
    caller,
    finite_rows,
    integer,
    number,
    real,
    vector,
)
from strahl._looks import Material, material_of

Look: TypeAlias = Material | ColorLike


class Object:
    """A surface or solid, or several of them. It belongs to no scene until it is added to one, and never changes: methods return new objects.

    Solids combine: ``a - b`` is a without b, ``a & b`` what is in both, ``a | b`` both together, ``-a`` what is outside of a. Parts keep their materials; the
    material of a combination is that of the parts that have none. Transformations come after those that the object has already.
    """

    __slots__ = ("_core",)

    def __init__(self, core: _strahl.Object) -> None:
        self._core = core

    @property
    def name(self) -> str | None:
        """The name for ray trees."""
        return self._core.name

    @property
    def kind(self) -> str:
        """The field's word for it: ``"sphere"``, ``"mesh"``, ``"difference"``, ..."""
        return self._core.kind

    @property
    def parts(self) -> int:
        """Number of objects that are combined; 0 for a shape."""
        return self._core.parts

    @property
    def source(self) -> str | None:
        """The line of the program or scene that made it, as ``file:line``."""
        return self._core.source

    def named(self, name: str) -> Object:
        """Under a name, which ray trees show."""
        return Object(self._core.named(name))

    def material(self, material: Look) -> Object:
        """With a material; a colour stands for a matte one."""
        return Object(self._core.with_material(material_of(material)._core))

    def visible_to(
        self, *, camera: bool = True, reflections: bool = True, shadows: bool = True
    ) -> Object:
        """Seen by some kinds of rays only: those of the camera, of mirrors and glass, and those to lights."""
        return Object(self._core.visible_to(camera, reflections, shadows))

    def hollow(self, hollow: bool = True) -> Object:
        """Whether fog also fills its inside."""
        return Object(self._core.hollow(hollow))

    def translate(self, offset: Vector) -> Object:
        """Moved by a vector."""
        return Object(self._core.translated(vector(offset, "offset")))

    def rotate(self, axis: Vector, degrees: float) -> Object:
        """Turned about an axis through the origin, counter-clockwise as seen from the tip of the axis with right-handed coordinates."""
        direction = vector(axis, "axis")
        if direction == (0, 0, 0):
            raise ValueError("axis must not be zero")
        return Object(self._core.rotated(direction, radians(number(degrees, "degrees"))))

    def scale(self, factors: float | Vector) -> Object:
        """Scaled about the origin, by one factor or by three; none may be zero."""
        if np.ndim(factors) == 0:
            factor = number(factors, "factors")  # type: ignore[arg-type]
            return Object(self._core.scaled((factor, factor, factor)))
        return Object(self._core.scaled(vector(factors, "factors")))  # type: ignore[arg-type]

    def transform(self, matrix: npt.ArrayLike) -> Object:
        """Mapped by a matrix (3, 4) or (4, 4) that multiplies column vectors (x, y, z, 1); its last row must be 0 0 0 1."""
        numbers = real(matrix, "matrix")
        if numbers.shape == (4, 4):
            if (numbers[3] != (0, 0, 0, 1)).any():
                raise ValueError("the last row of matrix must be 0 0 0 1: projections are no transformations")
            numbers = numbers[:3]
        if numbers.shape != (3, 4):
            raise ValueError(f"matrix must have the shape (3, 4) or (4, 4), not {numbers.shape}")
        return Object(self._core.mapped(np.ascontiguousarray(numbers)))

    def clipped_by(self, *solids: Object) -> Object:
        """The part of its surface that is inside of all solids; the cut is open."""
        return _combined("clip", [self, *solids])

    def _flat(self, operation: str) -> list[Object]:
        parts = self._core.loose_parts(operation)
        return [self] if parts is None else [Object(part) for part in parts]

    def __or__(self, other: Object) -> Object:
        if not isinstance(other, Object):
            return NotImplemented
        return _combined("union", [*self._flat("union"), other])

    def __and__(self, other: Object) -> Object:
        if not isinstance(other, Object):
            return NotImplemented
        return _combined("intersection", [*self._flat("intersection"), other])

    def __sub__(self, other: Object) -> Object:
        if not isinstance(other, Object):
            return NotImplemented
        return _combined("difference", [*self._flat("difference"), other])

    def __neg__(self) -> Object:
        return _combined("inverse", [self])

    def __repr__(self) -> str:
        name = f" {self.name!r}" if self.name else ""
        return f"<strahl.Object {self.kind}{name}>"


def _combined(operation: str, objects: Sequence[Object]) -> Object:
    for thing in objects:
        if not isinstance(thing, Object):
            raise TypeError(f"only objects can be combined, not {type(thing).__name__}")
    cores = [thing._core for thing in objects]
    return Object(_strahl.Object.combined(operation, cores, caller()))


def _all(objects: tuple[Object | Iterable[Object], ...]) -> list[Object]:
    flat: list[Object] = []
    for thing in objects:
        if isinstance(thing, Object):
            flat.append(thing)
        else:
            flat.extend(thing)
    return flat


def _with(core: _strahl.Object, material: Look | None, name: str | None) -> Object:
    if material is not None:
        core = core.with_material(material_of(material)._core)
    if name is not None:
        core = core.named(name)
    return Object(core)


def union(*objects: Object | Iterable[Object], material: Look | None = None, name: str | None = None) -> Object:
    """All objects together; surfaces inside of other objects are kept."""
    return _with(_combined("union", _all(objects))._core, material, name)


def merge(*objects: Object | Iterable[Object], material: Look | None = None, name: str | None = None) -> Object:
    """All solids together as one, without surfaces inside: for glass."""
    return _with(_combined("merge", _all(objects))._core, material, name)


def intersection(*objects: Object | Iterable[Object], material: Look | None = None, name: str | None = None) -> Object:
    """What is inside of all solids."""
    return _with(_combined("intersection", _all(objects))._core, material, name)


def difference(*objects: Object | Iterable[Object], material: Look | None = None, name: str | None = None) -> Object:
    """The first solid without the others."""
    return _with(_combined("difference", _all(objects))._core, material, name)


def sphere(center: Vector = (0, 0, 0), radius: float = 1.0, *, material: Look | None = None, name: str | None = None) -> Object:
    """A sphere."""
    core = _strahl.sphere(vector(center, "center"), number(radius, "radius"), caller())
    return _with(core, material, name)


def plane(point: Vector = (0, 0, 0), normal: Vector = (0, 1, 0), *, material: Look | None = None, name: str | None = None) -> Object:
    """An infinite plane through a point; as a solid it is the half-space behind it."""
    core = _strahl.plane(vector(point, "point"), vector(normal, "normal"), caller())
    return _with(core, material, name)


def box(corner: Vector = (-1, -1, -1), opposite: Vector = (1, 1, 1), *, material: Look | None = None, name: str | None = None) -> Object:
    """A box with faces along the axes between two opposite corners."""
    core = _strahl.cuboid(vector(corner, "corner"), vector(opposite, "opposite"), caller())
    return _with(core, material, name)


def disc(
    center: Vector = (0, 0, 0), normal: Vector = (0, 1, 0), radius: float = 1.0, *, hole: float = 0.0, material: Look | None = None, name: str | None = None
) -> Object:
    """A flat disc, perhaps with a round hole of radius ``hole``."""
    core = _strahl.disc(
        vector(center, "center"), vector(normal, "normal"), number(radius, "radius"), number(hole, "hole"), caller()
    )
    return _with(core, material, name)


def cylinder(
    base: Vector = (0, 0, 0), apex: Vector = (0, 1, 0), radius: float = 1.0, *, open: bool = False, material: Look | None = None, name: str | None = None
) -> Object:
    """A cylinder between the centres of its ends; ``open`` ones have no caps."""
    core = _strahl.cylinder(vector(base, "base"), vector(apex, "apex"), number(radius, "radius"), open, caller())
    return _with(core, material, name)


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
    return _with(core, material, name)


def torus(
    major: float = 1.0, minor: float = 0.25, *, center: Vector = (0, 0, 0), axis: Vector = (0, 1, 0), material: Look | None = None, name: str | None = None
) -> Object:
    """A torus: ``major`` is the radius of its circle, ``minor`` that of its tube."""
    core = _strahl.torus(
        vector(center, "center"), vector(axis, "axis"), number(major, "major"), number(minor, "minor"), caller()
    )
    return _with(core, material, name)


def ovus(bottom: float, top: float, *, material: Look | None = None, name: str | None = None) -> Object:
    """An egg about the y axis, as POV-Ray's ``ovus``: the radii of its bottom and its top."""
    return _with(_strahl.ovus(number(bottom, "bottom"), number(top, "top"), caller()), material, name)


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
    return _with(core, material, name)


def quadric(coefficients: Sequence[float], *, material: Look | None = None, name: str | None = None) -> Object:
    """The surface A x² + B y² + C z² + D xy + E xz + F yz + G x + H y + I z + J = 0 for the 10 numbers A to J."""
    numbers = [number(c, "coefficients") for c in coefficients]
    if len(numbers) != 10:
        raise ValueError(f"a quadric has 10 coefficients, not {len(numbers)}")
    return _with(_strahl.quadric(numbers, caller()), material, name)


def superellipsoid(e: float, n: float, *, material: Look | None = None, name: str | None = None) -> Object:
    """A superquadric ellipsoid within the cube from -1 to 1, as POV-Ray's."""
    return _with(_strahl.superellipsoid(number(e, "e"), number(n, "n"), caller()), material, name)


def triangle(a: Vector, b: Vector, c: Vector, *, material: Look | None = None, name: str | None = None) -> Object:
    """A flat triangle."""
    return mesh([vector(a, "a"), vector(b, "b"), vector(c, "c")], [[0, 1, 2]], material=material, name=name)


def polygon(corners: npt.ArrayLike, *, holes: Sequence[npt.ArrayLike] = (), material: Look | None = None, name: str | None = None) -> Object:
    """A flat polygon with corners (n, 3), perhaps with holes of the same kind."""
    inner = [finite_rows(hole, "holes", 3) for hole in holes]
    return _with(_strahl.polygon(finite_rows(corners, "corners", 3), inner, caller()), material, name)


def polynomial(terms: dict[tuple[int, int, int], float], *, material: Look | None = None, name: str | None = None) -> Object:
    """The surface where a polynomial is zero: ``{(i, j, k): c}`` stands for the sum of c xⁱ yʲ zᵏ, of a degree up to 35."""
    table = [(integer(i, "terms", 0), integer(j, "terms", 0), integer(k, "terms", 0), number(c, "terms")) for (i, j, k), c in terms.items()]
    return _with(_strahl.polynomial(table, caller()), material, name)


def blob(
    balls: npt.ArrayLike = (), capsules: npt.ArrayLike = (), *, threshold: float = 0.6, material: Look | None = None, name: str | None = None
) -> Object:
    """Balls and capsules that merge smoothly.

    Rows of ``balls`` (n, 5) are x, y, z, radius, strength; rows of ``capsules`` (m, 8) are both ends, radius, strength. The surface is where the sum of
    all fields ``strength (1 - (d / radius)²)²`` is ``threshold``.
    """
    first, second = finite_rows(balls, "balls", 5), finite_rows(capsules, "capsules", 8)
    core = _strahl.blob(number(threshold, "threshold"), first.tolist(), second.tolist(), caller())
    return _with(core, material, name)


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
    return _with(core, material, name)


def lathe(points: npt.ArrayLike, *, curve: str = "linear", material: Look | None = None, name: str | None = None) -> Object:
    """A curve turned about the y axis. ``points`` (n, 2) are radius and height; ``curve`` is as in `prism`."""
    return _with(_strahl.lathe(finite_rows(points, "points", 2), curve, caller()), material, name)


def sor(points: npt.ArrayLike, *, open: bool = False, material: Look | None = None, name: str | None = None) -> Object:
    """A surface of revolution about the y axis whose radius is a smooth function of the height. ``points`` (n, 2) are radius and rising height."""
    return _with(_strahl.sor(finite_rows(points, "points", 2), open, caller()), material, name)


def sphere_sweep(
    centers: npt.ArrayLike, radii: npt.ArrayLike, *, curve: str = "cubic", material: Look | None = None, name: str | None = None
) -> Object:
    """The volume that a sphere sweeps: centres (n, 3), radii (n,) or one number; ``curve`` is ``"linear"``, ``"bspline"`` or ``"cubic"``."""
    places = finite_rows(centers, "centers", 3)
    return _with(_strahl.sphere_sweep(places, _each(radii, "radii", len(places)), curve, caller()), material, name)


def bicubic_patch(points: npt.ArrayLike, *, material: Look | None = None, name: str | None = None) -> Object:
    """A bicubic Bézier patch with control points (4, 4, 3)."""
    numbers = real(points, "points")
    if numbers.shape != (4, 4, 3):
        raise ValueError(f"points must have the shape (4, 4, 3), not {numbers.shape}")
    return _with(_strahl.bicubic_patch(finite_rows(numbers.reshape(16, 3), "points", 3), caller()), material, name)


def _each(values: npt.ArrayLike, name: str, count: int) -> npt.NDArray[np.float64]:
    numbers = real(values, name)
    if numbers.shape not in ((), (count,)):
        raise ValueError(f"{name} must have the shape ({count},) or be one number, not {numbers.shape}")
    return np.ascontiguousarray(np.broadcast_to(numbers, (count,)))


def spheres(
    centers: npt.ArrayLike,
    radii: npt.ArrayLike = 1.0,
    colors: npt.ArrayLike | None = None,
    *,
    specular: float = 0.0,
    shininess: float = 50.0,
    material: Look | None = None,
    name: str | None = None,
) -> Object:
    """Many spheres at once: centres (n, 3), radii (n,) or one number, linear colours (n, 3) or one colour.

    Spheres of the same colour share a material, with highlights of strength ``specular``. Without colours all have ``material``.
    """
    places = finite_rows(centers, "centers", 3)
    table = None
    if colors is not None:
        if np.ndim(colors) == 1 and np.shape(colors) == (3,):
            colors = np.broadcast_to(real(colors, "colors"), (len(places), 3))
        table = finite_rows(colors, "colors", 3)
        if len(table) != len(places):
            raise ValueError(f"colors must have the shape ({len(places)}, 3), not {table.shape}")
    sizes = _each(radii, "radii", len(places))
    core = _strahl.spheres(places, sizes, table, number(specular, "specular"), number(shininess, "shininess"), caller())
    return _with(core, material, name)


def _faces(faces: npt.ArrayLike, count: int) -> npt.NDArray[np.uint32]:
    array = np.asarray(faces)
    if array.ndim != 2 or array.shape[1] != 3:
        raise ValueError(f"faces must have the shape (m, 3), not {array.shape}")
    if array.dtype.kind not in "iu":
        raise TypeError(f"faces must be whole numbers, not {array.dtype}")
    if array.size and (array.min() < 0 or array.max() >= count):
        raise ValueError(f"faces must be between 0 and {count - 1}, the last vertex, not {array.min()} to {array.max()}")
    return np.ascontiguousarray(array, np.uint32)


def mesh(
    vertices: npt.ArrayLike,
    faces: npt.ArrayLike,
    *,
    normals: npt.ArrayLike | None = None,
    uv: npt.ArrayLike | None = None,
    material: Look | None = None,
    name: str | None = None,
) -> Object:
    """A mesh of triangles: vertices (n, 3), faces (m, 3) of vertex numbers, counter-clockwise as seen from the front.

    ``normals`` (n, 3) make it look smooth, ``uv`` (n, 2) are texture coordinates. The mesh stores float32, so float32 vertices are kept exactly.
    """
    points = finite_rows(vertices, "vertices", 3)
    corners = _faces(faces, len(points))
    bends = None if normals is None else finite_rows(normals, "normals", 3).astype(np.float32)
    places = None if uv is None else finite_rows(uv, "uv", 2).astype(np.float32)
    for label, table in (("normals", bends), ("uv", places)):
        if table is not None and len(table) != len(points):
            raise ValueError(f"{label} must have as many rows as vertices ({len(points)}), not {len(table)}")
    return _with(_strahl.mesh(points, corners, bends, places, caller()), material, name)


def height_field(
    heights: npt.ArrayLike,
    *,
    x: tuple[float, float] = (0.0, 1.0),
    z: tuple[float, float] = (0.0, 1.0),
    smooth: bool = False,
    material: Look | None = None,
    name: str | None = None,
) -> Object:
    """A surface y = heights[i, j] over a grid in the plane of x and z, joined by triangles: heights (n, m), rows along z, columns along x.

    ``x`` and ``z`` are the coordinates of the first and last column and row. The range of the heights is stored in 65536 steps.
    """
    numbers = real(heights, "heights")
    if numbers.ndim != 2 or min(numbers.shape) < 2:
        raise ValueError(f"heights must have the shape (n, m) with 2 or more each, not {numbers.shape}")
    if not np.isfinite(numbers).all():
        raise ValueError("heights must be finite")
    low, high = float(numbers.min()), float(numbers.max())
    span = high - low or 1.0
    # 65536 stands for 1; the first row of the field lies at z = 1.
    steps = np.round((numbers[::-1] - low) / span * 65535).astype(np.uint16)
    (left, right), (front, back) = x, z
    if left == right or front == back:
        raise ValueError("x and z must be ranges")
    rows_, columns = numbers.shape
    core = _strahl.height_field(np.ascontiguousarray(steps), columns, rows_, 0.0, smooth, caller())
    scaled = core.scaled((right - left, span * 65536 / 65535, back - front))
    return _with(scaled.translated((left, low, front)), material, name)


def isosurface(
    values: npt.ArrayLike,
    level: float,
    *,
    origin: Vector = (0, 0, 0),
    spacing: float | Vector = 1.0,
    inside: Literal["above", "below"] = "above",
    smooth: bool = False,
    open: bool = False,
    material: Look | None = None,
    name: str | None = None,
) -> Object:
    """The surface where the trilinear interpolation of samples has the value ``level``, and the solid that it bounds: values (n, m, k), 2 or more each.

    The sample ``values[i, j, l]`` is at ``origin + spacing * (i, j, l)``. Rays meet the interpolation itself, without triangles and without holes. The inside
    is where values are ``"above"`` the level, or ``"below"`` it, as with signed distances; the walls of the grid close it, unless it is ``open``. ``smooth``
    interpolates normals for shading, which hides the edges between cells. Values are stored as float32: 4 bytes each, and up to 1.2 for a pyramid of extremes.

    Raises ValueError for other shapes, values that are not finite, and a level without values inside of it.
    """
    numbers = np.asarray(values)
    if numbers.dtype.kind not in "biuf":
        raise TypeError(f"values must be real numbers, not {numbers.dtype}")
    if numbers.ndim != 3 or min(numbers.shape) < 2:
        raise ValueError(f"values must have the shape (n, m, k) with 2 or more each, not {numbers.shape}")
    if inside not in ("above", "below"):
        raise ValueError(f"inside must be 'above' or 'below', not {inside!r}")
    steps = np.broadcast_to(real(spacing, "spacing"), (3,))
    if not (np.isfinite(steps).all() and (steps > 0).all()):
        raise ValueError(f"spacing must be positive, not {spacing!r}")
    stored = np.ascontiguousarray(numbers, np.float32)
    core = _strahl.isosurface(stored, number(level, "level"), inside == "below", open, smooth, caller())
    scaled = core.scaled(vector(steps, "spacing"))
    return _with(scaled.translated(vector(origin, "origin")), material, name)


def from_trimesh(thing: Any, *, smooth: bool = False, material: Look | None = None, name: str | None = None) -> Object:
    """A mesh from an object with ``vertices`` and ``faces``, such as trimesh.Trimesh; ``smooth`` takes its ``vertex_normals``."""
    for attribute in ("vertices", "faces"):
        if not hasattr(thing, attribute):
            raise TypeError(f"{type(thing).__name__} has no {attribute}: only triangle meshes can be taken over")
    normals = thing.vertex_normals if smooth else None
    return mesh(np.asarray(thing.vertices), np.asarray(thing.faces), normals=normals, material=material, name=name)


def from_ase(atoms: Any, *, scale: float = 0.5, radii: npt.ArrayLike | None = None, colors: npt.ArrayLike | None = None, name: str | None = None) -> Object:
    """Atoms as spheres, from an object with ``positions`` (n, 3) and ``numbers`` (n,), such as ase.Atoms.

    Radii are the covalent ones times ``scale`` and colours those of Jmol if ASE is installed, unless they are given, one for each atom.
    """
    numbers = np.asarray(atoms.numbers)
    if radii is None or colors is None:
        try:
            from ase.data import covalent_radii  # type: ignore[import-not-found,import-untyped,unused-ignore]
            from ase.data.colors import jmol_colors  # type: ignore[import-not-found,import-untyped,unused-ignore]
        except ImportError:
            raise ImportError("give radii and colors, or install ase for its tables") from None
        if radii is None:
            radii = scale * covalent_radii[numbers]
        if colors is None:
            codes = np.asarray(jmol_colors[numbers], float)
            colors = np.where(codes <= 0.04045, codes / 12.92, ((codes + 0.055) / 1.055) ** 2.4)
    return spheres(np.asarray(atoms.positions), radii, colors, specular=0.3, name=name)


def pov(text: str, *, material: Look | None = None, name: str | None = None) -> Object:
    """Objects in POV-Ray's language, such as ``"julia_fractal { ... }"``: everything that its language has. Several are a union.

    Raises `SceneError` if the text is wrong.
    """
    from strahl._scene import parse

    return _with(parse(text, name="text")._core.one_object(), material, name)


