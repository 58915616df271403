"""Materials, cameras and backgrounds."""

from __future__ import annotations

from math import radians
from typing import Any

from strahl import _strahl
from strahl._convert import ColorLike, Vector, integer, number, vector
from strahl._convert import color as linear


def _fraction(value: float, name: str) -> float:
    result = number(value, name)
    if result < 0:
        raise ValueError(f"{name} must not be negative, not {value!r}")
    return result


class Material:
    """The look of an object, by the coefficients of the classical model; `Material.pov` takes a texture of POV-Ray's language.

    ``diffuse`` is kd, ``ambient`` ka (kd unless given), ``specular`` ks with the exponent ``shininess``, ``reflection`` kr, ``transmission`` kt.
    ``ior`` is the index of refraction of the inside, ``absorption`` that of its light per unit length. With ``fresnel`` Fresnel's equations
    divide the light between reflection and transmission. ``thin`` is a sheet without an inside. ``one_sided`` surfaces exist from their
    front only. ``model`` is ``"lambert"``, ``"phong"`` or ``"blinn-phong"`` (the scene's unless given).
    """

    def __init__(
        self,
        diffuse: ColorLike = 0.8,
        *,
        ambient: ColorLike | None = None,
        specular: ColorLike = 0.0,
        shininess: float = 50.0,
        reflection: ColorLike = 0.0,
        transmission: ColorLike = 0.0,
        emission: ColorLike = 0.0,
        ior: float = 1.0,
        absorption: ColorLike = 0.0,
        fresnel: bool = False,
        thin: bool = False,
        one_sided: bool = False,
        model: str | None = None,
        name: str = "",
    ) -> None:
        eta = number(ior, "ior")
        if eta <= 0:
            raise ValueError(f"ior must be positive, not {ior!r}")
        self._core = _strahl.Material(
            {
                "ambient": linear(diffuse if ambient is None else ambient, "ambient"),
                "diffuse": linear(diffuse, "diffuse"),
                "specular": linear(specular, "specular"),
                "shininess": _fraction(shininess, "shininess"),
                "reflection": linear(reflection, "reflection"),
                "transmission": linear(transmission, "transmission"),
                "emission": linear(emission, "emission"),
                "ior": eta,
                "absorption": linear(absorption, "absorption"),
                "fresnel": bool(fresnel),
                "thin": bool(thin),
                "one_sided": bool(one_sided),
                "model": model,
                "name": name,
            }
        )

    @classmethod
    def _of(cls, core: _strahl.Material) -> Material:
        self = cls.__new__(cls)
        self._core = core
        return self

    @classmethod
    def matte(cls, color: ColorLike = 0.8, *, name: str = "") -> Material:
        """A diffuse surface without highlights."""
        return cls(color, name=name)

    @classmethod
    def shiny(
        cls,
        color: ColorLike = 0.8,
        *,
        specular: ColorLike = 0.4,
        shininess: float = 50.0,
        reflection: ColorLike = 0.0,
        name: str = "",
    ) -> Material:
        """A diffuse surface with a highlight."""
        return cls(
            color, specular=specular, shininess=shininess, reflection=reflection, name=name
        )

    @classmethod
    def mirror(cls, reflection: ColorLike = 0.9, *, name: str = "") -> Material:
        """A mirror with a sharp highlight."""
        return cls(0.0, specular=reflection, shininess=200.0, reflection=reflection, name=name)

    @classmethod
    def glass(
        cls, ior: float = 1.5, *, absorption: ColorLike = 0.0, name: str = ""
    ) -> Material:
        """Glass with Fresnel reflection; of light of each colour ``exp(-absorption * length)`` passes."""
        return cls(
            0.0,
            reflection=1.0,
            transmission=1.0,
            specular=0.5,
            shininess=200.0,
            ior=ior,
            absorption=absorption,
            fresnel=True,
            name=name,
        )

    @classmethod
    def pov(cls, text: str, *, name: str = "") -> Material:
        """A look in POV-Ray's language: ``texture { ... }``, ``pigment { ... }`` with ``finish { ... }``, ``material { ... }``, ``interior { ... }``.

        What stands in front of the last statement, such as ``#include "woods.inc"``, is read first; put the object's statements on lines of
        their own, behind a line ``---``. Raises `SceneError` if the text is wrong.
        """
        from strahl._load import parse

        before, _, look = text.rpartition("\n---\n")
        scene = parse(f"{before}\nsphere {{ 0, 1 {look} }}", name="material")
        core = scene._core.material()
        return cls._of(core.named(name) if name else core)

    @property
    def name(self) -> str:
        """The name for ray trees, or the empty string."""
        return self._core.name

    def named(self, name: str) -> Material:
        """The same look under a name."""
        return self._of(self._core.named(name))

    def __repr__(self) -> str:
        return f"<strahl.Material {self.name!r}>" if self.name else "<strahl.Material>"


def material_of(value: Material | ColorLike) -> Material:
    """A material; a colour stands for a matte one."""
    return value if isinstance(value, Material) else Material.matte(value)


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

    def focused(self, aperture: float, focal_point: Vector, *, samples: int = 64) -> Camera:
        """With a lens: what is not in the plane of ``focal_point`` is blurred. ``aperture`` is four times the radius of the lens, as in POV-Ray;
        ``samples`` is the largest number of rays per place."""
        return Camera(
            self._core.focused(
                _fraction(aperture, "aperture"),
                vector(focal_point, "focal_point"),
                integer(samples, "samples", 1),
            )
        )

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


class Background:
    """What rays see that hit nothing; a colour alone stands for `Background.solid`."""

    def __init__(self, core: _strahl.Background) -> None:
        self._core = core

    @classmethod
    def solid(cls, color: ColorLike) -> Background:
        """One colour everywhere."""
        return cls(_strahl.Background.solid(linear(color, "background")))

    @classmethod
    def gradient(
        cls, bottom: ColorLike, top: ColorLike, *, up: Vector = (0, 1, 0)
    ) -> Background:
        """A blend by the height of the direction: ``bottom`` straight down, ``top`` straight up."""
        return cls(
            _strahl.Background.gradient(
                linear(bottom, "bottom"), linear(top, "top"), vector(up, "up")
            )
        )

    @classmethod
    def pov(cls, text: str) -> Background:
        """A background in POV-Ray's language: ``background { ... }`` or ``sky_sphere { ... }``."""
        from strahl._load import parse

        core = parse(text, name="background")._core.background()
        if core is None:
            raise ValueError("the text has no background")
        return cls(core)


def background_of(value: Background | ColorLike | Any) -> Background:
    """A background; a colour stands for one everywhere."""
    return value if isinstance(value, Background) else Background.solid(value)
