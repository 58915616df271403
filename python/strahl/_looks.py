"""Materials and backgrounds."""

from __future__ import annotations

from typing import Any, TypeAlias

from strahl import _strahl
from strahl._convert import ColorLike, Vector, not_negative, positive, vector
from strahl._convert import color as linear
from strahl._maps import Movable
from strahl._textures import Interior, Pigment, Texture, pigment_of


class Material:
    """The look of an object, by the coefficients of the classical model. `Material.textured` takes a `Texture`, `Material.pov` a text of POV-Ray's language.

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
        self._core = _strahl.Material(
            {
                "ambient": linear(diffuse if ambient is None else ambient, "ambient"),
                "diffuse": linear(diffuse, "diffuse"),
                "specular": linear(specular, "specular"),
                "shininess": not_negative(shininess, "shininess"),
                "reflection": linear(reflection, "reflection"),
                "transmission": linear(transmission, "transmission"),
                "emission": linear(emission, "emission"),
                "ior": positive(ior, "ior"),
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
    def textured(
        cls, texture: Texture | Pigment | ColorLike, *, inside: Texture | None = None, interior: Interior | None = None, name: str = ""
    ) -> Material:
        """A texture of POV-Ray's kind; ``inside`` is another one that is seen from inside, ``interior`` what is within. A `Texture` alone can stand for it."""
        outer = texture if isinstance(texture, Texture) else Texture(texture)
        made = cls._of(_strahl.Material.textured(outer._core, None if inside is None else inside._core, name))
        return made if interior is None else made.with_interior(interior)

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

    def with_interior(self, interior: Interior) -> Material:
        """The same surface around another inside, which takes the place of ``ior`` and ``absorption``."""
        return self._of(self._core.with_interior(interior._numbers))

    @property
    def name(self) -> str:
        """The name for ray trees, or the empty string."""
        return self._core.name

    def named(self, name: str) -> Material:
        """The same look under a name."""
        return self._of(self._core.named(name))

    def __repr__(self) -> str:
        return f"<strahl.Material {self.name!r}>" if self.name else "<strahl.Material>"


Look: TypeAlias = Material | Texture | Pigment | ColorLike
"""What stands for a material: a texture, a pigment with POV-Ray's default finish, or a colour, which is matte."""


def material_of(value: Look) -> Material:
    """The material that a look stands for."""
    if isinstance(value, Material):
        return value
    if isinstance(value, (Texture, Pigment)):
        return Material.textured(value)
    if isinstance(value, Movable):
        raise TypeError(f"material must be a material, a texture, a pigment or a colour, not a {type(value).__name__}")
    return Material.matte(linear(value, "material"))


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
    def sky(cls, *layers: Pigment | ColorLike, behind: ColorLike = 0.0, emission: ColorLike = 1.0) -> Background:
        """Pigments by the direction, as points of the unit sphere: the lowest layer first, over the colour ``behind``. ``emission`` is a factor of their colours."""
        pigments = [pigment_of(layer)._core for layer in layers]
        return cls(_strahl.Background.sky(pigments, linear(emission, "emission"), linear(behind, "behind")))

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
