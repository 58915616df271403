"""Cameras."""

from __future__ import annotations

from math import radians

import numpy as np
import numpy.typing as npt

from strahl import _strahl
from strahl._convert import Vector, faces_of, finite_rows, integer, not_negative, number, positive, real, vector
from strahl._textures import Normal


class Camera:
    """The eye of a picture. It never changes; methods return new cameras.

    ``eye`` is its position, ``look_at`` the point in the middle of the picture, ``up`` any vector that points upwards in it. ``aspect`` fixes the ratio of
    width to height of the view; without it the view has the ratio of the picture.
    """

    def __init__(self, core: _strahl.Camera) -> None:
        self._core = core

    @classmethod
    def _looking(
        cls,
        projection: str,
        eye: Vector,
        look_at: Vector,
        up: Vector,
        numbers: tuple[float, float],
        aspect: float | None,
        *,
        upright: bool = True,
        moving: bool = False,
    ) -> Camera:
        return cls(
            _strahl.Camera(
                projection,
                vector(eye, "eye"),
                vector(look_at, "look_at"),
                vector(up, "up"),
                numbers,
                None if aspect is None else number(aspect, "aspect"),
                (upright, moving),
            )
        )

    @classmethod
    def perspective(
        cls,
        eye: Vector,
        look_at: Vector = (0, 0, 0),
        *,
        up: Vector = (0, 1, 0),
        angle: float = 40.0,
        aspect: float | None = None,
    ) -> Camera:
        """A camera whose rays start at the eye; ``angle`` is that from the bottom to the top of the picture, in degrees below 180."""
        half = radians(number(angle, "angle"))
        return cls._looking("perspective", eye, look_at, up, (half, 0.0), aspect)

    @classmethod
    def orthographic(
        cls,
        eye: Vector,
        look_at: Vector = (0, 0, 0),
        *,
        up: Vector = (0, 1, 0),
        height: float = 2.0,
        aspect: float | None = None,
    ) -> Camera:
        """A camera with parallel rays that sees ``height`` units of the scene from the bottom to the top."""
        size = number(height, "height")
        return cls._looking("orthographic", eye, look_at, up, (size, 0.0), aspect)

    @classmethod
    def fisheye(
        cls,
        eye: Vector,
        look_at: Vector = (0, 0, 0),
        *,
        up: Vector = (0, 1, 0),
        angle: float = 180.0,
        aspect: float | None = 1.0,
    ) -> Camera:
        """A fisheye lens; ``angle`` is that across the circle, in degrees up to 360."""
        full = radians(number(angle, "angle"))
        return cls._looking("fisheye", eye, look_at, up, (full, 0.0), aspect)

    @classmethod
    def ultra_wide_angle(
        cls,
        eye: Vector,
        look_at: Vector = (0, 0, 0),
        *,
        up: Vector = (0, 1, 0),
        angle: float = 120.0,
        aspect: float | None = None,
    ) -> Camera:
        """A fisheye that fills the picture; ``angle`` is that from the left to the right edge of a square picture, in degrees."""
        full = radians(number(angle, "angle"))
        return cls._looking("ultra_wide_angle", eye, look_at, up, (full, 0.0), aspect)

    @classmethod
    def omnimax(cls, eye: Vector, look_at: Vector = (0, 0, 0), *, up: Vector = (0, 1, 0), aspect: float | None = None) -> Camera:
        """A fisheye of 180 degrees with the lens of Omnimax projectors: the view ends 45 degrees below the horizon."""
        return cls._looking("omnimax", eye, look_at, up, (0.0, 0.0), aspect)

    @classmethod
    def panoramic(cls, eye: Vector, look_at: Vector = (0, 0, 0), *, up: Vector = (0, 1, 0), aspect: float | None = 1.0) -> Camera:
        """Half of all directions: 180 degrees from edge to edge, both ways, with longitude and latitude as x and y."""
        return cls._looking("panoramic", eye, look_at, up, (0.0, 0.0), aspect)

    @classmethod
    def spherical(
        cls,
        eye: Vector,
        look_at: Vector = (0, 0, 0),
        *,
        up: Vector = (0, 1, 0),
        horizontal: float = 360.0,
        vertical: float = 180.0,
    ) -> Camera:
        """Longitude and latitude as x and y; the angles are those from edge to edge, in degrees. The whole sphere is twice as wide as high."""
        numbers = radians(number(horizontal, "horizontal")), radians(number(vertical, "vertical"))
        return cls._looking("spherical", eye, look_at, up, numbers, None)

    @classmethod
    def cylinder(
        cls,
        eye: Vector,
        look_at: Vector = (0, 0, 0),
        *,
        up: Vector = (0, 1, 0),
        angle: float = 180.0,
        upright: bool = True,
        moving: bool = False,
        aspect: float | None = None,
    ) -> Camera:
        """A panorama on a cylinder; ``angle`` is that around the axis, in degrees. The axis is vertical, or horizontal unless ``upright``; with ``moving`` the eye moves
        along it, and rays stand at right angles to it."""
        full = radians(number(angle, "angle"))
        return cls._looking("cylinder", eye, look_at, up, (full, 0.0), aspect, upright=upright, moving=moving)

    @classmethod
    def pov(cls, text: str) -> Camera:
        """A camera in POV-Ray's language: ``camera { ... }``. All of POV-Ray's projections and lenses are there."""
        from strahl._load import parse

        scene = parse(text, name="camera")._core
        core = scene.camera()
        if core is None or scene.assumes_camera():
            raise ValueError("the text has no camera")
        return cls(core)

    @classmethod
    def mesh(
        cls,
        vertices: npt.ArrayLike,
        faces: npt.ArrayLike,
        *,
        normals: npt.ArrayLike | None = None,
        uv: npt.ArrayLike | None = None,
        offset: float = 1e-6,
        reversed: bool = False,
    ) -> Camera:
        """Rays that start on a mesh and go along its normals: what light arrives there. Vertices (n, 3), faces (m, 3) of whole numbers; corners run counter-clockwise as seen from the front.

        Pixel after pixel, row by row, gets the face of its number. With ``uv`` (n, 2) the picture is that of the texture coordinates: a pixel gets the place of its face, and with
        ``normals`` (n, 3) directions are interpolated. Rays start ``offset`` in front of the face, or go to its back with ``reversed``.
        """
        places, rows = finite_rows(vertices, "vertices", 3), faces_of(faces)
        if len(rows) and not 0 <= int(rows.min()) <= int(rows.max()) < len(places):
            raise ValueError(f"faces must have vertices from 0 to {len(places) - 1}")
        core = _strahl.Camera.mesh(
            places,
            rows.astype(np.uint32),
            None if normals is None else finite_rows(normals, "normals", 3),
            None if uv is None else finite_rows(uv, "uv", 2),
            number(offset, "offset"),
            bool(reversed),
        )
        return cls(core)

    def focused(
        self,
        aperture: float,
        focal_point: Vector,
        *,
        samples: int | tuple[int, int] = 64,
        confidence: float = 0.9,
        variance: float = 1 / 10_000,
        bokeh: npt.ArrayLike | None = None,
    ) -> Camera:
        """With a lens: what is not in the plane of ``focal_point`` is blurred. ``aperture`` is four times the radius of the lens, as in POV-Ray.

        ``samples`` is the largest number of rays per place, or a pair with the smallest. The more their colours vary, the more rays there are, depending on ``variance`` and ``confidence`` by POV-Ray's rule. ``bokeh`` (n, n) are
        weights of the parts of the lens, the first row at the top; without it the lens is round.
        """
        pair = samples if isinstance(samples, tuple) else (7 if integer(samples, "samples", 1) >= 7 else 4, samples)
        least, most = (integer(each, "samples", 1) for each in pair)
        if most > 1 << 16:
            raise ValueError(f"samples must be at most {1 << 16}, not {most}")
        weights = None if bokeh is None else real(bokeh, "bokeh")
        if weights is not None and (weights.ndim != 2 or weights.shape[0] != weights.shape[1] or weights.size == 0):
            raise ValueError(f"bokeh must have the shape (n, n), not {weights.shape}")
        if not 0 <= number(confidence, "confidence") < 1:
            raise ValueError(f"confidence must be from 0 to less than 1, not {confidence!r}")
        return Camera(
            self._core.focused(
                {
                    "aperture": not_negative(aperture, "aperture"),
                    "focal_point": vector(focal_point, "focal_point"),
                    "samples": (least, most),
                    "confidence": float(confidence),
                    "variance": positive(variance, "variance"),
                    "bokeh": None if weights is None else np.ascontiguousarray(weights),
                }
            )
        )

    def rippled(self, normal: Normal) -> Camera:
        """Through rippled glass: a `Normal` tilts the rays, by their place in the picture from -0.5 to 0.5."""
        return Camera(self._core.rippled(normal._core))

    @property
    def projection(self) -> str:
        """The name of the projection."""
        return self._core.projection

    @property
    def eye(self) -> tuple[float, float, float]:
        """The position."""
        return self._core.eye

    @property
    def direction(self) -> tuple[float, float, float]:
        """From the eye to the middle of the image plane."""
        return self._core.direction

    @property
    def right(self) -> tuple[float, float, float]:
        """From the middle of the image plane to its right edge, for a square picture."""
        return self._core.right

    @property
    def up(self) -> tuple[float, float, float]:
        """From the middle of the image plane to its top edge."""
        return self._core.up

    def __repr__(self) -> str:
        return f"<strahl.Camera {self.projection} at {self.eye}>"
