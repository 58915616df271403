"""Patterns: numbers at points of space, which pigments, normals and textures are made of."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal, TypeAlias

import numpy as np
import numpy.typing as npt

from strahl import _strahl
from strahl._convert import Triple, Vector, integer, number, numbers, positive, real, vector
from strahl._maps import Movable

if TYPE_CHECKING:
    from strahl._objects import Object
    from strahl._textures import Pigment

Name: TypeAlias = Literal[
    "aoi", "boxed", "bozo", "bumps", "cells", "checker", "cubic", "cylindrical", "dents", "granite", "hexagon", "leopard", "marble", "onion", "planar", "radial",
    "spherical", "square", "triangular", "wood", "wrinkles",
]
"""The patterns that have no parameters."""

Wrapping: TypeAlias = Literal["planar", "spherical", "cylindrical", "toroidal"]
"""How a picture lies in space: on the unit square of x and y, around the origin, around the y axis, or around a circle."""


class Pattern(Movable):
    """A number from 0 to 1 at each point of space, or the number of a block, by POV-Ray's formulas. It never changes; methods return new patterns.

    ``Pattern("marble")`` and the like have no parameters; other patterns are made by class methods. Transformations move the pattern; ``turbulence``, ``frequency`` and
    ``wave`` change how it is read.
    """

    __slots__ = ("_core", "_name")

    def __init__(self, name: Name) -> None:
        if not isinstance(name, str):
            raise TypeError(f"a pattern has a name, not {name!r}")
        self._core = _strahl.Pattern.named(name)
        self._name: str = name

    @classmethod
    def _of(cls, core: _strahl.Pattern, name: str) -> Pattern:
        self = cls.__new__(cls)
        self._core, self._name = core, name
        return self

    def _moved(self, by: _strahl.Map) -> Pattern:
        return self._of(self._core.transformed(by), self._name)

    @property
    def name(self) -> str:
        """The name of the formula."""
        return self._name

    @property
    def blocks(self) -> int | None:
        """The number of blocks: 2 for a checker; None for patterns with continuous values."""
        return self._core.blocks

    @classmethod
    def agate(cls, turbulence: float = 1.0) -> Pattern:
        """Bands of stone along z, stirred by a turbulence of their own."""
        return cls._of(_strahl.Pattern.agate(number(turbulence, "turbulence")), "agate")

    @classmethod
    def brick(cls, size: Vector = (8, 3, 4.5), mortar: float = 0.5) -> Pattern:
        """A wall: block 0 is the mortar, block 1 the bricks, whose ``size`` includes their mortar."""
        return cls._of(_strahl.Pattern.brick(vector(size, "size"), number(mortar, "mortar")), "brick")

    @classmethod
    def crackle(cls, form: Vector = (-1, 1, 0), *, metric: float = 2.0, offset: float = 0.0, solid: bool = False) -> Pattern:
        """Distances to random points, one per unit cube; ``form`` has the factors of those to the nearest three. ``metric`` 2 is Euclid's; ``solid`` gives each cell one value."""
        core = _strahl.Pattern.crackle(vector(form, "form"), number(metric, "metric"), number(offset, "offset"), bool(solid))
        return cls._of(core, "crackle")

    @classmethod
    def fractal(
        cls,
        iterations: int = 20,
        *,
        julia: complex | None = None,
        kind: Literal["power", "magnet1", "magnet2"] = "power",
        exponent: int = 2,
        exterior: tuple[int, float] = (1, 1.0),
        interior: tuple[int, float] = (0, 1.0),
    ) -> Pattern:
        """A Mandelbrot set in the plane of x and y, or the Julia set of a constant. ``exterior`` and ``interior`` are POV-Ray's numbers of colourings (0 to 6) and their factors."""
        count = integer(iterations, "iterations", 1)
        if count > 1 << 22:
            raise ValueError(f"iterations must be at most {1 << 22}, not {count}")
        constant = None if julia is None else (number(complex(julia).real, "julia"), number(complex(julia).imag, "julia"))
        (outside, outside_factor), (inside, inside_factor) = exterior, interior
        core = _strahl.Pattern.fractal(
            {
                "kind": kind,
                "exponent": integer(exponent, "exponent", 2),
                "julia": constant,
                "iterations": count,
                "exterior": (integer(outside, "exterior", 0), number(outside_factor, "exterior")),
                "interior": (integer(inside, "interior", 0), number(inside_factor, "interior")),
            }
        )
        return cls._of(core, "fractal")

    @classmethod
    def density(cls, values: npt.ArrayLike, *, interpolation: Literal["nearest", "trilinear", "tricubic"] = "nearest") -> Pattern:
        """Values (z, y, x) measured at the points of a grid that fills the unit cube; 0 outside of it. POV-Ray's ``density_file``.

        Values are uint8, uint16 or uint32, whose largest number is 1, or floats from 0 to 1, of which 32 bits are kept. The value number ``i`` of ``n`` along an axis lies at ``i / n``.
        """
        samples = numbers(values, "values")
        if samples.ndim != 3 or samples.size == 0 or max(samples.shape) > 65535:
            raise ValueError(f"values must have the shape (z, y, x), each from 1 to 65535, not {np.shape(values)}")
        samples = samples.astype(samples.dtype.newbyteorder("="), copy=False)
        if samples.dtype not in (np.uint8, np.uint16, np.uint32):
            if samples.dtype.kind in "iu":
                raise TypeError(f"values must be uint8, uint16, uint32 or floats, not {samples.dtype}")
            if not ((samples >= 0) & (samples <= 1)).all():
                raise ValueError("values must be from 0 to 1")
            samples = np.rint(samples.astype(np.float64) * 0xFFFF_FFFF).astype(np.uint32)
        return cls._of(_strahl.Pattern.density(np.ascontiguousarray(samples), interpolation), "density")

    @classmethod
    def function(cls, formula: str) -> Pattern:
        """The value of a formula of x, y and z in POV-Ray's language, modulo 1: ``"sin(x) * f_noise3d(x, y, z)"``. Raises `SceneError` if it is wrong."""
        from strahl._load import parse

        look = f"#include \"functions.inc\"\nsphere {{ 0, 1 pigment {{ function {{\n{formula}\n}} color_map {{ [0 rgb 0] [1 rgb 1] }} }} }}"
        return cls._of(parse(look, name="formula")._core.pattern(), "function")

    @classmethod
    def gradient(cls, direction: Vector) -> Pattern:
        """The distance along a direction, modulo 1."""
        return cls._of(_strahl.Pattern.gradient(vector(direction, "direction")), "gradient")

    @classmethod
    def image(
        cls,
        pixels: npt.ArrayLike,
        *,
        map: Wrapping = "planar",
        interpolation: Literal["nearest", "bilinear", "bicubic", "normalized-distance"] = "bilinear",
        once: bool = False,
        srgb: bool | None = None,
        filter: float = 0.0,
        transmit: float = 0.0,
        use_alpha: bool = False,
    ) -> Pattern:
        """A picture in space: pixels (h, w), or (h, w, c) with 1 to 4 channels for grey, grey and alpha, red green blue, and with alpha; the first row is the top.

        Pixels are uint8, uint16, or floats, which are linear; ``srgb`` says whether whole numbers are codes of sRGB (as pictures in colour have, unless given: True). ``map``
        says where it lies; ``once`` leaves out the copies beside it. ``filter`` and ``transmit`` make it transparent.

        As a pattern it is the grey value, or the alpha channel with ``use_alpha``; `Pigment` shows its colours, and `Normal` takes it as a relief.
        """
        samples = numbers(pixels, "pixels")
        if samples.ndim == 2:
            samples = samples[..., np.newaxis]
        if samples.ndim != 3 or samples.size == 0 or samples.shape[2] > 4:
            raise ValueError(f"pixels must have the shape (h, w) or (h, w, c) with 1 to 4 channels, not {np.shape(pixels)}")
        samples = samples.astype(samples.dtype.newbyteorder("="), copy=False)
        if samples.dtype not in (np.uint8, np.uint16):
            if samples.dtype.kind in "iu":
                raise TypeError(f"pixels must be uint8, uint16 or floats, not {samples.dtype}")
            samples = samples.astype(np.float32)
            if not np.isfinite(samples).all():
                raise ValueError("pixels must be finite")
        core = _strahl.Picture(
            np.ascontiguousarray(samples),
            {
                "map": map,
                "interpolation": interpolation,
                "once": bool(once),
                "srgb": samples.dtype.kind == "u" if srgb is None else bool(srgb),
                "filter": number(filter, "filter"),
                "transmit": number(transmit, "transmit"),
                "use_alpha": bool(use_alpha),
            },
        )
        return cls._of(_strahl.Pattern.image(core), "image")

    @classmethod
    def object(cls, solid: Object) -> Pattern:
        """Block 0 is outside of a solid, block 1 is inside. `Object.instances` have no inside."""
        return cls._of(_strahl.Pattern.object(solid._core), "object")

    @classmethod
    def pigment(cls, pigment: Pigment) -> Pattern:
        """The grey value of a pigment."""
        return cls._of(pigment._core.pattern(), "pigment")

    @classmethod
    def quilted(cls, control0: float = 1.0, control1: float = 1.0) -> Pattern:
        """Cushions on the unit cubes; the numbers are the slopes of their profile in the middle and at the seam."""
        return cls._of(_strahl.Pattern.quilted(number(control0, "control0"), number(control1, "control1")), "quilted")

    @classmethod
    def ripples(cls, sources: int = 10) -> Pattern:
        """Ripples of equal length from so many random points."""
        return cls._of(_strahl.Pattern.ripples(_sources(sources)), "ripples")

    @classmethod
    def waves(cls, sources: int = 10) -> Pattern:
        """Waves of different lengths from so many random points."""
        return cls._of(_strahl.Pattern.waves(_sources(sources)), "waves")

    @classmethod
    def slope(
        cls,
        direction: Vector,
        *,
        to_point: bool = False,
        range: tuple[float, float] = (0.0, 1.0),
        altitude: Vector | None = None,
        altitude_range: tuple[float, float] = (0.0, 1.0),
    ) -> Pattern:
        """How steep the surface is: 0 where the normal points against the direction, 1 where along it. ``to_point`` takes ``direction`` as a point to look at; ``range`` has the
        slopes that become 0 and 1. ``altitude`` is a direction whose gradient is mixed in, by its length."""
        ranges = [(number(low, "range"), number(high, "range")) for low, high in (range, altitude_range)]
        numbers = {
            "direction": vector(direction, "direction"),
            "towards_point": bool(to_point),
            "range": ranges[0],
            "altitude": None if altitude is None else (vector(altitude, "altitude"), ranges[1]),
        }
        return cls._of(_strahl.Pattern.slope(numbers), "slope")

    @classmethod
    def spiral(cls, arms: int, *, double: bool = False) -> Pattern:
        """A spiral around the z axis, or two of opposite turn."""
        return cls._of(_strahl.Pattern.spiral(number(arms, "arms"), bool(double)), "spiral")

    @classmethod
    def tiling(cls, kind: int) -> Pattern:
        """Tiles of the plane of x and z with bevelled edges, by POV-Ray's number 1 to 27."""
        return cls._of(_strahl.Pattern.tiling(integer(kind, "kind", 1)), "tiling")

    def turbulence(self, amount: float | Vector, *, octaves: int = 6, lambda_: float = 2.0, omega: float = 0.5) -> Pattern:
        """Stirred by noise: ``amount`` is how far, along all axes or each. Octave after octave the frequency grows by ``lambda_`` and the strength by ``omega``."""
        return self._of(self._core.turbulence(three(amount, "amount"), octaves_of(octaves, lambda_, omega)), self._name)

    def frequency(self, frequency: float, phase: float = 0.0) -> Pattern:
        """Read more often over the same range, beginning at ``phase``."""
        return self._of(self._core.frequency(number(frequency, "frequency"), number(phase, "phase")), self._name)

    def wave(self, form: Literal["ramp", "triangle", "sine", "scallop", "cubic", "poly"], exponent: float = 1.0) -> Pattern:
        """How the value runs from 0 to 1; ``exponent`` is that of ``"poly"``."""
        return self._of(self._core.wave(form, number(exponent, "exponent")), self._name)

    def noise(self, generator: Literal[1, 2, 3]) -> Pattern:
        """By another of POV-Ray's noise generators: 1 the oldest, 2 the default, 3 Perlin's."""
        return self._of(self._core.noise(integer(generator, "generator", 1)), self._name)

    def repeat(
        self, axis: Literal["x", "y", "z"], width: float = 1.0, *, offset: Vector = (0, 0, 0), flip: tuple[bool, bool, bool] = (False, False, False)
    ) -> Pattern:
        """A slice of the pattern again and again along an axis, each moved by ``offset``; every second one is mirrored along the axes that ``flip`` says."""
        if axis not in ("x", "y", "z"):
            raise ValueError(f"axis must be 'x', 'y' or 'z', not {axis!r}")
        x, y, z = flip
        core = self._core.repeated("xyz".index(axis), positive(width, "width"), vector(offset, "offset"), (bool(x), bool(y), bool(z)))
        return self._of(core, self._name)

    def black_hole(
        self,
        center: Vector,
        radius: float,
        *,
        strength: float = 1.0,
        falloff: float = 2.0,
        inverse: bool = False,
        repeat: Vector = (0, 0, 0),
        turbulence: Vector = (0, 0, 0),
    ) -> Pattern:
        """Drawn towards a place from within a radius, or pushed away; ``repeat`` has the edges of blocks that have a hole each, or 0, and by ``turbulence`` the holes are moved within their blocks at random."""
        core = self._core.drawn_in(
            vector(center, "center"),
            positive(radius, "radius"),
            number(strength, "strength"),
            number(falloff, "falloff"),
            bool(inverse),
            (vector(repeat, "repeat"), vector(turbulence, "turbulence")),
        )
        return self._of(core, self._name)

    def stir(self, amount: float | Vector, *, octaves: int = 6, lambda_: float = 2.0, omega: float = 0.5) -> Pattern:
        """As `turbulence`, but at its place among the transformations: those after it move the stirred pattern."""
        return self._of(self._core.stirred(three(amount, "amount"), octaves_of(octaves, lambda_, omega)), self._name)

    def wrap(
        self,
        around: Literal["cylindrical", "spherical", "toroidal", "cubic"],
        *,
        orientation: Vector = (0, 0, 1),
        distance_exponent: float = 0.0,
        radius: float = 1.0,
    ) -> Pattern:
        """The plane of x and y around the y axis, the origin, a circle of ``radius``, or a cube. The pattern is stretched by the distance to the power ``distance_exponent``; cubes have neither that nor an orientation."""
        core = self._core.wrapped(around, _unit(orientation), number(distance_exponent, "distance_exponent"), number(radius, "radius"))
        return self._of(core, self._name)

    def flatten(self, orientation: Vector = (0, 0, 1), distance: float = 0.0) -> Pattern:
        """The pattern of one plane, continued along its normal."""
        return self._of(self._core.flattened(_unit(orientation), number(distance, "distance")), self._name)

    def __repr__(self) -> str:
        return f"<strahl.Pattern {self._name}>"


def three(amount: float | Vector, name: str) -> Triple:
    """One number for all axes, or three."""
    numbers = real(amount, name)
    return vector(np.broadcast_to(numbers, 3) if numbers.ndim == 0 else numbers, name)


def octaves_of(octaves: int, lambda_: float, omega: float) -> tuple[int, float, float]:
    """Octaves of noise."""
    count = integer(octaves, "octaves", 1)
    if count > 10:
        raise ValueError(f"octaves must be from 1 to 10, not {count}")
    return count, number(lambda_, "lambda_"), number(omega, "omega")


def _sources(count: int) -> int:
    result = integer(count, "sources", 1)
    if result > 1000:
        raise ValueError(f"sources must be from 1 to 1000, not {result}")
    return result


def _unit(direction: Vector) -> Triple:
    numbers = np.asarray(vector(direction, "orientation"))
    size = np.abs(numbers).max()
    if size == 0:
        raise ValueError("orientation must not be zero")
    # Divided first by the largest number, so that no square overflows or vanishes.
    numbers = numbers / size
    return vector(numbers / np.linalg.norm(numbers), "orientation")
