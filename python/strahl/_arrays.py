"""Objects from arrays: meshes, many spheres, heights and samples on a grid."""

from __future__ import annotations

from typing import Any, Literal

import numpy as np
import numpy.typing as npt

from strahl import _strahl
from strahl._convert import Vector, caller, faces_of, finite_rows, number, real, rows_of_floats
from strahl._looks import Look
from strahl._objects import Object, with_look


def each(values: npt.ArrayLike, name: str, count: int) -> npt.NDArray[np.float64]:
    """One number for each of ``count`` things: an array (count,) or a single number."""
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
    sizes = each(radii, "radii", len(places))
    core = _strahl.spheres(places, sizes, table, number(specular, "specular"), number(shininess, "shininess"), caller())
    return with_look(core, material, name)


def _per_vertex(values: npt.ArrayLike | None, name: str, columns: int, count: int) -> npt.NDArray[np.float32] | None:
    if values is None:
        return None
    table = rows_of_floats(values, name, columns).astype(np.float32, copy=False)
    if len(table) != count:
        raise ValueError(f"{name} must have as many rows as vertices ({count}), not {len(table)}")
    return table


def mesh(
    vertices: npt.ArrayLike,
    faces: npt.ArrayLike,
    *,
    normals: npt.ArrayLike | None = None,
    uv: npt.ArrayLike | None = None,
    solid: bool = False,
    material: Look | None = None,
    name: str | None = None,
) -> Object:
    """A mesh of triangles: vertices (n, 3), faces (m, 3) of vertex numbers from 0, counter-clockwise as seen from the front.

    ``normals`` (n, 3) make it look smooth, ``uv`` (n, 2) are texture coordinates. With ``solid`` it is the solid within a closed mesh, which combines with others.

    The mesh stores float32 and uint32: 12 bytes for each vertex and each face, 12 more per vertex for normals, 8 for texture coordinates. Arrays in C order of float32 or
    float64 vertices and of uint32, int32 or int64 faces are copied once, straight into the mesh; other layouts and kinds are converted before. float32 vertices are kept
    exactly. Your arrays may change afterwards.

    Raises ValueError for other shapes, numbers that are not finite, faces without vertices, no faces, and a solid that is not closed.
    """
    points, corners = rows_of_floats(vertices, "vertices", 3), faces_of(faces)
    bends, places = _per_vertex(normals, "normals", 3, len(points)), _per_vertex(uv, "uv", 2, len(points))
    return with_look(_strahl.mesh(points, corners, bends, places, solid, caller()), material, name)


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
    field = with_look(core, material, name)
    return field.scale((right - left, span * 65536 / 65535, back - front)).translate((left, low, front))


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
    return with_look(core, material, name).scale(steps).translate(origin)


def from_trimesh(thing: Any, *, smooth: bool = False, material: Look | None = None, name: str | None = None) -> Object:
    """A mesh from an object with ``vertices`` and ``faces``, such as trimesh.Trimesh; ``smooth`` takes its ``vertex_normals``."""
    for attribute in ("vertices", "faces"):
        if not hasattr(thing, attribute):
            raise TypeError(f"{type(thing).__name__} has no {attribute}: only triangle meshes can be taken over")
    normals = thing.vertex_normals if smooth else None
    return mesh(np.asarray(thing.vertices), np.asarray(thing.faces), normals=normals, material=material, name=name)


def from_ase(atoms: Any, *, scale: float = 0.5, radii: npt.ArrayLike | None = None, colors: npt.ArrayLike | None = None, name: str | None = None) -> Object:
    """Atoms as spheres, from an object with ``positions`` (n, 3) and ``numbers`` (n,), such as ase.Atoms.

    Radii (n,) are the covalent ones times ``scale`` and colours (n, 3) those of Jmol if ASE is installed, unless they are given.
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
