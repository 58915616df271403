"""Objects: what they have in common, and how they combine."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from typing import TYPE_CHECKING, Any

import numpy.typing as npt

from strahl import _strahl
from strahl._convert import Place, caller, real
from strahl._looks import Look, material_of
from strahl._maps import Movable
from strahl._maps import matrices as rows_of

if TYPE_CHECKING:
    from strahl._lights import Light


class Object(Movable):
    """A surface or solid, or several of them. It belongs to no scene until it is added to one, and never changes: methods return new objects.

    Solids combine: ``a - b`` is a without b, ``a & b`` what is in both, ``a | b`` both together, ``-a`` what is outside of a. Parts keep their materials; the
    material of a combination is that of the parts that have none.
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

    def double_illuminated(self) -> Object:
        """Light on its back shows on its front, too, as on a lampshade."""
        return Object(self._core.double_illuminated())

    def uv_mapped(self) -> Object:
        """Its textures and those of its parts lie on the texture coordinates of the surfaces."""
        return Object(self._core.uv_mapped())

    def _moved(self, by: _strahl.Map) -> Object:
        return Object(self._core.transformed(by))

    def instances(self, matrices: npt.ArrayLike) -> Object:
        """The object once for each matrix (n, 3, 4) or (n, 4, 4), as `transform` takes them: a union of places that share the object, so that each takes
        little memory, however large the object is. They cannot be parts of intersections and differences."""
        return Object(self._core.instances(rows_of(real(matrices, "matrices"), "matrices", "n, "), caller()))

    def clipped_by(self, *solids: Object) -> Object:
        """The part of its surface that is inside of all solids; the cut is open."""
        return _combined("clip", [self, *solids])

    def bounded_by(self, *objects: Object) -> Object:
        """Seen only by rays that meet each of these objects somewhere: what POV-Ray's ``bounded_by`` does to those objects that keep their bounds. It makes nothing faster."""
        return _combined("bound", [self, *objects])

    def _loose(self, operation: str) -> list[Object]:
        parts = self._core.loose_parts(operation)
        return [self] if parts is None else [Object(part) for part in parts]

    def __or__(self, other: Object) -> Object:
        if not isinstance(other, Object):
            return NotImplemented
        return _combined("union", [*self._loose("union"), other])

    def __and__(self, other: Object) -> Object:
        if not isinstance(other, Object):
            return NotImplemented
        return _combined("intersection", [*self._loose("intersection"), other])

    def __sub__(self, other: Object) -> Object:
        if not isinstance(other, Object):
            return NotImplemented
        return _combined("difference", [*self._loose("difference"), other])

    def __neg__(self) -> Object:
        return _combined("inverse", [self])

    def __repr__(self) -> str:
        name = f" {self.name!r}" if self.name else ""
        return f"<strahl.Object {self.kind}{name}>"


def _combined(operation: str, objects: Sequence[Object]) -> Object:
    for thing in objects:
        if not isinstance(thing, Object):
            raise TypeError(f"only objects can be combined, not {type(thing).__name__}; lights have light_group and Light.with_body")
    cores = [thing._core for thing in objects]
    return Object(_strahl.combined(operation, cores, caller()))


def light_group(*things: Object | Light | Iterable[Object | Light], global_lights: bool = False, outer_lights: bool = False, name: str | None = None) -> Object:
    """Objects with lights that shine on them alone; with ``global_lights`` those of the scene do, too, and with ``outer_lights`` those of the group
    that this group is in. All objects cast shadows."""
    from strahl._lights import Light

    parts: list[_strahl.Object | tuple[_strahl.Light, Place]] = []
    for thing in flat(things):
        if isinstance(thing, Light):
            parts.append((thing._core, thing._place))
        elif isinstance(thing, Object):
            parts.append(thing._core)
        else:
            raise TypeError(f"a light group consists of objects and lights, not {type(thing).__name__}")
    others = " and ".join(kind for kind, shine in (("global lights", global_lights), ("outer lights", outer_lights)) if shine)
    operation = f"light group with {others}" if others else "light group"
    return with_look(_strahl.combined(operation, parts, caller()), None, name)


def flat(things: Iterable[Any]) -> Iterator[Any]:
    for thing in things:
        if isinstance(thing, Iterable) and not isinstance(thing, (str, bytes)):
            yield from thing
        else:
            yield thing


def with_look(core: _strahl.Object, material: Look | None, name: str | None) -> Object:
    """An object with a material and a name, if they are given."""
    if material is not None:
        core = core.with_material(material_of(material)._core)
    if name is not None:
        core = core.named(name)
    return Object(core)


def union(*objects: Object | Iterable[Object], material: Look | None = None, name: str | None = None) -> Object:
    """All objects together; surfaces inside of other objects are kept."""
    return with_look(_combined("union", list(flat(objects)))._core, material, name)


def merge(*objects: Object | Iterable[Object], material: Look | None = None, name: str | None = None) -> Object:
    """All solids together as one, without surfaces inside: for glass."""
    return with_look(_combined("merge", list(flat(objects)))._core, material, name)


def intersection(*objects: Object | Iterable[Object], material: Look | None = None, name: str | None = None) -> Object:
    """What is inside of all solids."""
    return with_look(_combined("intersection", list(flat(objects)))._core, material, name)


def difference(*objects: Object | Iterable[Object], material: Look | None = None, name: str | None = None) -> Object:
    """The first solid without the others."""
    return with_look(_combined("difference", list(flat(objects)))._core, material, name)
