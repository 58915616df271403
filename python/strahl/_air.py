"""What fills the space between objects: fog and rainbows."""

from __future__ import annotations

from math import inf

from strahl import _strahl
from strahl._convert import ColorLike, Vector, color_ft, number, positive, vector
from strahl._patterns import octaves_of, three
from strahl._textures import Entries, pairs_of


class Fog:
    """Fog in all space outside of solids, by POV-Ray's formulas: add it to a scene, which may have several.

    On ``distance`` it lets 1/e of the light through and adds its ``color``. ``filter`` is how much it tints, ``transmit`` the least that passes. ``turbulence`` (a number, or one for each axis)
    is the scale of noise that thins it in places, by ``turbulence_depth``.

    With an ``altitude`` it is ground fog: full up to the height ``offset`` along ``up``, and half as dense ``altitude`` above it.
    """

    def __init__(
        self,
        color: ColorLike,
        distance: float,
        *,
        filter: float = 0.0,
        transmit: float = 0.0,
        altitude: float | None = None,
        offset: float = 0.0,
        up: Vector = (0, 1, 0),
        turbulence: float | Vector | None = None,
        turbulence_depth: float = 0.5,
        octaves: int = 6,
        lambda_: float = 2.0,
        omega: float = 0.5,
    ) -> None:
        red, green, blue, *_ = color_ft(color, "color")
        noise = None
        if turbulence is not None:
            noise = three(turbulence, "turbulence"), number(turbulence_depth, "turbulence_depth"), octaves_of(octaves, lambda_, omega)
        ground = None
        if altitude is not None:
            ground = vector(up, "up"), number(offset, "offset"), number(altitude, "altitude")
        self._core = _strahl.Fog(
            {
                "color": (red, green, blue, number(filter, "filter"), number(transmit, "transmit")),
                "distance": positive(distance, "distance"),
                "ground": ground,
                "turbulence": noise,
            }
        )


class Rainbow:
    """A ring of colours around a direction, in front of the background or of far objects, by POV-Ray's formulas: add it to a scene, which may have several.

    ``direction`` is that in which the light travels that makes it: rays along it see the centre. The ring is ``angle`` degrees from there and ``width`` degrees wide; ``colors`` go from its inner edge
    (0) to its outer one (1), and let light through by filter and transmit, as five numbers. ``arc_angle`` and ``falloff_angle`` are the degrees of the arc around ``up`` that
    is seen, and seen fully. ``distance`` is how near objects may be that it covers; ``jitter`` is noise.
    """

    def __init__(
        self,
        direction: Vector,
        colors: Entries[ColorLike],
        *,
        angle: float = 42.5,
        width: float = 5.0,
        up: Vector = (0, 1, 0),
        arc_angle: float = 360.0,
        falloff_angle: float = 360.0,
        distance: float = inf,
        jitter: float = 0.0,
    ) -> None:
        self._core = _strahl.Rainbow(
            {
                "direction": vector(direction, "direction"),
                "up": vector(up, "up"),
                "angle": number(angle, "angle"),
                "width": positive(width, "width"),
                "arc_angle": number(arc_angle, "arc_angle"),
                "falloff_angle": number(falloff_angle, "falloff_angle"),
                "distance": inf if distance == inf else positive(distance, "distance"),
                "colors": [(at, color_ft(each, "colors")) for at, each in pairs_of(colors)],
                "jitter": number(jitter, "jitter"),
            }
        )
