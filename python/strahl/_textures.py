"""Textures of POV-Ray's kind: pigments, normals, finishes and interiors."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any, TypeAlias, TypeVar

from strahl import _strahl
from strahl._convert import ColorLike, color, color_ft, integer, number, positive
from strahl._maps import Movable
from strahl._patterns import Name, Pattern

_T = TypeVar("_T")
_C = TypeVar("_C")

Entries: TypeAlias = Mapping[float, _T] | Sequence[tuple[float, _T]]
"""What a pattern's values stand for: a dictionary, or pairs in ascending order (two of the same value are a step). Between values there is a blend."""


class Pigment(Movable):
    """Colours at the points of space. It never changes; methods return new pigments.

    ``Pigment(color)`` is the same everywhere: a linear colour, ``"#rrggbb"``, or five numbers with ``filter`` (the share of light from behind that passes, tinted) and ``transmit``
    (the share that passes as it is). ``Pigment(pattern)`` of `Pattern.image` shows the picture's colours.
    """

    __slots__ = ("_core",)

    def __init__(self, color: ColorLike | Pattern) -> None:
        if isinstance(color, Pattern):
            self._core = _strahl.Pigment.picture(color._core)
        else:
            self._core = _strahl.Pigment.solid(color_ft(color, "color"))

    @classmethod
    def _of(cls, core: _strahl.Pigment) -> Pigment:
        self = cls.__new__(cls)
        self._core = core
        return self

    def _moved(self, by: _strahl.Map) -> Pigment:
        return self._of(self._core.transformed(by))

    @classmethod
    def map(cls, pattern: Pattern | Name, entries: Entries[Pigment | ColorLike]) -> Pigment:
        """Colours or pigments by the value of a pattern: ``Pigment.map("wood", {0: "#553311", 1: "#bb8855"})``."""
        pairs = pairs_of(entries)
        field = pattern_of(pattern)
        if any(isinstance(each, Pigment) for _, each in pairs):
            return cls._of(_strahl.Pigment.map(field._core, [(at, pigment_of(each)._core) for at, each in pairs]))
        return cls._of(_strahl.Pigment.colors(field._core, [(at, color_ft(each, "entries")) for at, each in pairs]))  # type: ignore[arg-type]

    @classmethod
    def blocks(cls, pattern: Pattern | Name, members: Sequence[Pigment | ColorLike]) -> Pigment:
        """A colour or pigment for each block of a pattern: ``Pigment.blocks("checker", [0, 1])``."""
        field = _with_blocks(pattern, len(members))
        return cls._of(_strahl.Pigment.blocks(field._core, [pigment_of(each)._core for each in members]))

    @classmethod
    def average(cls, *members: Pigment | ColorLike, weights: Iterable[float] | None = None) -> Pigment:
        """The mean of pigments, with weights that are 1 unless given."""
        return cls._of(_strahl.Pigment.average([(weight, pigment_of(each)._core) for weight, each in _weighted(members, weights)]))

    def uv_mapped(self) -> Pigment:
        """By the texture coordinates of surfaces: (u, v, 0) is the point."""
        return self._of(self._core.uv_mapped())

    def quick(self, color: ColorLike) -> Pigment:
        """With a colour that takes its place in pictures of a `Scene.quality` of 5 or less (``quick_color``)."""
        return self._of(self._core.quick(color_ft(color, "color")))


class Normal(Movable):
    """Makes smooth surfaces look rough: a pattern tilts the normal. It never changes; methods return new normals.

    ``pattern`` is a name or a `Pattern`; ``"bumps"``, ``"dents"``, ``"wrinkles"``, ripples, waves, quilted patterns and images tilt by rules of their own, others by their value as a height.
    ``amount`` is how much. ``slopes`` changes values to pairs of height and slope. ``accuracy`` is the distance at which heights are probed; without ``bump_scale`` bumps do not grow with
    a transformation that enlarges the pattern.
    """

    __slots__ = ("_core",)

    def __init__(
        self,
        pattern: Pattern | Name,
        amount: float = 0.5,
        *,
        slopes: Entries[tuple[float, float]] | None = None,
        accuracy: float = 0.02,
        bump_scale: bool = True,
    ) -> None:
        field = pattern_of(pattern)
        heights = None
        if slopes is not None:
            heights = [(at, (number(height, "slopes"), number(slope, "slopes"))) for at, (height, slope) in pairs_of(slopes)]
        self._core = _strahl.Normal(
            field._core, number(amount, "amount"), field.name == "bumps", heights, positive(accuracy, "accuracy"), not bump_scale
        )

    @classmethod
    def _of(cls, core: _strahl.Normal) -> Normal:
        self = cls.__new__(cls)
        self._core = core
        return self

    def _moved(self, by: _strahl.Map) -> Normal:
        return self._of(self._core.transformed(by))

    @classmethod
    def map(cls, pattern: Pattern | Name, entries: Entries[Normal]) -> Normal:
        """Normals by the value of a pattern."""
        pairs = [(at, _checked(each, Normal)._core) for at, each in pairs_of(entries)]
        return cls._of(_strahl.Normal.map(pattern_of(pattern)._core, pairs))

    @classmethod
    def blocks(cls, pattern: Pattern | Name, members: Sequence[Normal]) -> Normal:
        """A normal for each block of a pattern."""
        field = _with_blocks(pattern, len(members))
        return cls._of(_strahl.Normal.blocks(field._core, [_checked(each, Normal)._core for each in members]))

    @classmethod
    def average(cls, *members: Normal, weights: Iterable[float] | None = None) -> Normal:
        """The mean of normals, with weights that are 1 unless given."""
        return cls._of(_strahl.Normal.average([(weight, _checked(each, Normal)._core) for weight, each in _weighted(members, weights)]))

    @classmethod
    def facets(cls, size: float = 0.1, *, tilt: float = 0.0) -> Normal:
        """Flat pieces, as of cut glass: the normal becomes the nearest of many directions, about ``size`` apart (1 is the length of a normal).

        With a ``tilt`` (``coords``) the pieces are the cells of a crackle in this size, also on flat surfaces, each tilted by that much.
        """
        return cls._of(_strahl.Normal.facets(positive(size, "size"), number(tilt, "tilt")))

    def uv_mapped(self) -> Normal:
        """By the texture coordinates of surfaces."""
        return self._of(self._core.uv_mapped())


class Finish:
    """How a textured surface reflects light, by POV-Ray's formulas and with its defaults.

    ``ambient`` and ``emission`` are shares of the pigment's colour, ``diffuse`` and ``diffuse_back`` those of light from the front and, through thin sheets, from behind; ``brilliance`` is the
    power of the cosine. ``phong`` with ``phong_size`` and ``specular`` with ``roughness`` are highlights, which take on the pigment's colour by ``metallic``.

    ``reflection`` is what a mirror reflects, and ``reflection_grazing`` that at grazing angles; ``reflection_falloff`` is the power of the way between them, or ``fresnel`` follows Fresnel's equations.
    ``reflection_exponent`` dims weak light, ``reflection_metallic`` tints by the pigment. ``conserve_energy`` takes reflected light from what passes. ``crand`` is random darkening,
    ``irid`` a thin film (amount, thickness, turbulence).
    """

    def __init__(
        self,
        *,
        ambient: ColorLike = 0.1,
        emission: ColorLike = 0.0,
        diffuse: float = 0.6,
        diffuse_back: float = 0.0,
        brilliance: float = 1.0,
        phong: float = 0.0,
        phong_size: float = 40.0,
        specular: float = 0.0,
        roughness: float = 0.05,
        metallic: float = 0.0,
        reflection: ColorLike = 0.0,
        reflection_grazing: ColorLike | None = None,
        reflection_falloff: float = 1.0,
        reflection_exponent: float = 1.0,
        reflection_metallic: float = 0.0,
        fresnel: bool = False,
        conserve_energy: bool = False,
        crand: float = 0.0,
        irid: tuple[float, float, float] | None = None,
    ) -> None:
        film = None
        if irid is not None:
            amount, thickness, turbulence = irid
            film = number(amount, "irid"), number(thickness, "irid"), number(turbulence, "irid")
        head_on = color(reflection, "reflection")
        grazing = head_on if reflection_grazing is None else color(reflection_grazing, "reflection_grazing")
        self._numbers: dict[str, Any] = {
            "ambient": color(ambient, "ambient"),
            "emission": color(emission, "emission"),
            "diffuse": number(diffuse, "diffuse"),
            "diffuse_back": number(diffuse_back, "diffuse_back"),
            "brilliance": number(brilliance, "brilliance"),
            "phong": number(phong, "phong"),
            "phong_size": number(phong_size, "phong_size"),
            "specular": number(specular, "specular"),
            "roughness": positive(roughness, "roughness"),
            "metallic": number(metallic, "metallic"),
            "reflection": (head_on, grazing),
            "fresnel": bool(fresnel),
            "reflection_falloff": number(reflection_falloff, "reflection_falloff"),
            "reflection_exponent": number(reflection_exponent, "reflection_exponent"),
            "reflection_metallic": number(reflection_metallic, "reflection_metallic"),
            "conserve_energy": bool(conserve_energy),
            "crand": number(crand, "crand"),
            "irid": film,
        }


class Interior:
    """The inside of a transparent solid, by POV-Ray's formulas.

    ``ior`` is the index of refraction. At ``fade_distance`` the light is attenuated to a half, or to 1/e with a ``fade_power`` of 1000 or more; ``fade_color`` is what is left after any
    distance. ``dispersion`` is the ratio of the indices for violet and red, shown by ``dispersion_samples`` rays. ``caustics`` brightens shadows.
    """

    def __init__(
        self,
        ior: float = 1.0,
        *,
        fade_distance: float = 0.0,
        fade_power: float = 0.0,
        fade_color: ColorLike = 0.0,
        dispersion: float = 1.0,
        dispersion_samples: int = 7,
        caustics: float = 0.0,
    ) -> None:
        rays = integer(dispersion_samples, "dispersion_samples", 2)
        if rays > 1000:
            raise ValueError(f"dispersion_samples must be from 2 to 1000, not {rays}")
        self._numbers: dict[str, Any] = {
            "ior": positive(ior, "ior"),
            "fade_distance": number(fade_distance, "fade_distance"),
            "fade_power": number(fade_power, "fade_power"),
            "fade_color": color(fade_color, "fade_color"),
            "dispersion": positive(dispersion, "dispersion"),
            "dispersion_samples": rays,
            "caustics": number(caustics, "caustics"),
        }


class Texture(Movable):
    """A pigment, a normal and a finish: a look that stands wherever a material does. It never changes; methods return new textures.

    Transformations move the pattern over the surface; a texture also moves with the object that has it.
    """

    __slots__ = ("_core",)

    def __init__(self, pigment: Pigment | ColorLike, *, normal: Normal | None = None, finish: Finish | None = None) -> None:
        core = None if normal is None else _checked(normal, Normal)._core
        numbers = _checked(finish or Finish(), Finish)._numbers
        self._core = _strahl.Texture(pigment_of(pigment)._core, core, numbers)

    @classmethod
    def _of(cls, core: _strahl.Texture) -> Texture:
        self = cls.__new__(cls)
        self._core = core
        return self

    def _moved(self, by: _strahl.Map) -> Texture:
        return self._of(self._core.transformed(by))

    @classmethod
    def layered(cls, *layers: Texture) -> Texture:
        """Textures over each other, the lowest first; upper ones need pigments that let light through."""
        return cls._of(_strahl.Texture.layered([_checked(each, Texture)._core for each in _some(layers)]))

    @classmethod
    def map(cls, pattern: Pattern | Name, entries: Entries[Texture]) -> Texture:
        """Textures by the value of a pattern."""
        pairs = [(at, _checked(each, Texture)._core) for at, each in pairs_of(entries)]
        return cls._of(_strahl.Texture.map(pattern_of(pattern)._core, pairs))

    @classmethod
    def blocks(cls, pattern: Pattern | Name, members: Sequence[Texture]) -> Texture:
        """A texture for each block of a pattern."""
        field = _with_blocks(pattern, len(members))
        return cls._of(_strahl.Texture.blocks(field._core, [_checked(each, Texture)._core for each in members]))

    @classmethod
    def average(cls, *members: Texture, weights: Iterable[float] | None = None) -> Texture:
        """The mean of textures, with weights that are 1 unless given."""
        return cls._of(_strahl.Texture.average([(weight, _checked(each, Texture)._core) for weight, each in _weighted(members, weights)]))

    @classmethod
    def picture(cls, pattern: Pattern, members: Sequence[Texture]) -> Texture:
        """The texture whose number is a texel of a `Pattern.image`: its red as a code from 0 to 255, modulo the number of textures."""
        return cls._of(_strahl.Texture.picture(pattern._core, [_checked(each, Texture)._core for each in _some(members)]))

    def uv_mapped(self) -> Texture:
        """By the texture coordinates of surfaces."""
        return self._of(self._core.uv_mapped())


def pigment_of(value: Pigment | ColorLike) -> Pigment:
    """A pigment; a colour stands for one that is the same everywhere."""
    return value if isinstance(value, Pigment) else Pigment(value)


def pattern_of(value: Pattern | Name) -> Pattern:
    """A pattern; a name stands for one without parameters."""
    return value if isinstance(value, Pattern) else Pattern(value)


def _with_blocks(value: Pattern | Name, members: int) -> Pattern:
    pattern = pattern_of(value)
    if pattern.blocks is None:
        raise ValueError(f"the pattern {pattern.name} has continuous values: use map")
    if pattern.blocks != members:
        raise ValueError(f"the pattern {pattern.name} has {pattern.blocks} blocks, not {members}")
    return pattern


def _checked(value: Any, kind: type[_C]) -> _C:
    if not isinstance(value, kind):
        raise TypeError(f"expected a {kind.__name__}, not {type(value).__name__}")
    return value


def _some(members: Sequence[_T]) -> Sequence[_T]:
    if not members:
        raise ValueError("there must be one at least")
    return members


def pairs_of(entries: Entries[_T]) -> list[tuple[float, _T]]:
    """Entries as pairs with ascending numbers, or ValueError."""
    pairs: Any = entries.items() if isinstance(entries, Mapping) else entries
    result = [(number(at, "entries"), each) for at, each in pairs]
    if any(low > high for (low, _), (high, _) in zip(result, result[1:])):
        raise ValueError("the values of entries must ascend")
    return list(_some(result))


def _weighted(members: Sequence[_T], weights: Iterable[float] | None) -> list[tuple[float, _T]]:
    _some(members)
    numbers = [1.0] * len(members) if weights is None else [number(weight, "weights") for weight in weights]
    if len(numbers) != len(members):
        raise ValueError(f"there are {len(members)} members, but {len(numbers)} weights")
    return list(zip(numbers, members))
