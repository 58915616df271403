"""Objects: what they have in common, and how they combine."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from math import radians
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from strahl import _strahl
from strahl._convert import ColorLike, Vector, caller, number, real, vector
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
        (row,) = _matrices(real(matrix, "matrix")[np.newaxis], "matrix", "")
        return Object(self._core.mapped(row.tolist()))

    def instances(self, matrices: npt.ArrayLike) -> Object:
        """The object once for each matrix (n, 3, 4) or (n, 4, 4), as `transform` takes them: a union of places that share the object, so that each takes
        little memory, however large the object is. They cannot be parts of intersections and differences."""
        return Object(self._core.instances(_matrices(real(matrices, "matrices"), "matrices", "n, "), caller()))

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


def _matrices(array: npt.NDArray[np.float64], name: str, more: str) -> npt.NDArray[np.float64]:
    """Rows of the 12 numbers of each matrix."""
    if array.shape[1:] == (4, 4):
        if (array[:, 3] != (0, 0, 0, 1)).any():
            raise ValueError(f"the last row of {name} must be 0 0 0 1: projections are no transformations")
        array = array[:, :3]
    if array.shape[1:] != (3, 4):
        shape = array.shape if more else array.shape[1:]
        raise ValueError(f"{name} must have the shape ({more}3, 4) or ({more}4, 4), not {shape}")
    return np.ascontiguousarray(array).reshape(-1, 12)


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


def with_look(core: _strahl.Object, material: Look | None, name: str | None) -> Object:
    """An object with a material and a name, if they are given."""
    if material is not None:
        core = core.with_material(material_of(material)._core)
    if name is not None:
        core = core.named(name)
    return Object(core)


def union(*objects: Object | Iterable[Object], material: Look | None = None, name: str | None = None) -> Object:
    """All objects together; surfaces inside of other objects are kept."""
    return with_look(_combined("union", _all(objects))._core, material, name)


def merge(*objects: Object | Iterable[Object], material: Look | None = None, name: str | None = None) -> Object:
    """All solids together as one, without surfaces inside: for glass."""
    return with_look(_combined("merge", _all(objects))._core, material, name)


def intersection(*objects: Object | Iterable[Object], material: Look | None = None, name: str | None = None) -> Object:
    """What is inside of all solids."""
    return with_look(_combined("intersection", _all(objects))._core, material, name)


def difference(*objects: Object | Iterable[Object], material: Look | None = None, name: str | None = None) -> Object:
    """The first solid without the others."""
    return with_look(_combined("difference", _all(objects))._core, material, name)
