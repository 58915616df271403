"""The ray trees of a pixel as objects: the schema of ``strahl explain --format json``.

This file is made by ``python/tools/tree_classes.py`` from the schema in Rust.

Points, directions and colours are tuples of three numbers; colours are linear. Fields are named as in the formulas of the documentation.
"""

from __future__ import annotations

import json
from collections.abc import Iterator
from dataclasses import dataclass, field, fields
from html import escape
from typing import Any

from strahl import _strahl
from strahl._node import Node

Triple = tuple[float, float, float]


@dataclass(frozen=True, kw_only=True)
class Explanation(Node):
    """A pixel and all rays that were traced for it."""
    pixel: tuple[int, int]
    """Column and row."""
    size: tuple[int, int]
    """Width and height of the picture."""
    sampling: str
    """Where rays go through the pixels."""
    places: int
    """How many places of the picture the samples belong to."""
    samples: list[Sample]
    """Its samples."""
    color: Triple
    """The linear colour before rounding."""
    film: tuple[float, float, float]
    """The colour as it is in the film."""
    rgb8: tuple[int, int, int]
    """The colour as sRGB codes of 8 bits."""
    _json: dict[str, Any] = field(repr=False, compare=False)

    @property
    def total(self) -> Triple:
        """The linear colour before rounding: the mean of what the samples bring, or what the sampling makes of them."""
        return self.color

    @property
    def root(self) -> TreeRay:
        """The ray from the eye of the first sample."""
        return self.samples[0].root

    def to_html(self, title: str = "", *, language: str = "en") -> str:
        """A page with the ray trees: the one of ``strahl explain --format html``, which has everything in it. ``language`` is ``"en"`` or ``"de"``."""
        return _strahl.explanation_page(json.dumps(self.to_dict()), self.pixel, title, language)

    def _repr_html_(self) -> str:
        # Names of objects come from scenes, so the page runs in a frame that cannot reach the notebook.
        style = "width: 100%; height: 480px; border: 1px solid rgb(128 128 128 / 40%); resize: vertical; overflow: auto"
        return f'<iframe sandbox="allow-scripts" style="{style}" srcdoc="{escape(self.to_html())}"></iframe>'

    def __repr__(self) -> str:
        rays = sum(len(sample.rays) for sample in self.samples)
        return f"<strahl.Explanation of pixel {self.pixel} with {len(self.samples)} samples and {rays} rays, total {self.total}>"

    def to_networkx(self) -> Any:
        """A networkx.DiGraph of all rays: nodes (sample, ray) with the fields of `TreeRay`, edges from rays to those they sent. It needs networkx."""
        import networkx  # type: ignore[import-not-found,import-untyped,unused-ignore]

        graph = networkx.DiGraph(pixel=self.pixel)
        for sample in self.samples:
            for ray in sample.rays:
                values = {f.name: getattr(ray, f.name) for f in fields(ray) if not f.name.startswith("_")}
                graph.add_node((sample.sample, ray.id), **values)
            for ray in sample.rays:
                for child in ray.children:
                    graph.add_edge((sample.sample, ray.id), (sample.sample, child))
        return graph


@dataclass(frozen=True, kw_only=True)
class Sample(Node):
    """One primary ray and all that came of it."""
    sample: int
    """Its number, counted from 1."""
    position: tuple[float, float]
    """The place in the picture, in pixels."""
    pass_: int
    """The pass of the sampling that asked for it."""
    lens_ray: int | None = None
    """The number of the ray, where a place has several."""
    times: int
    """How often its place counts in the mean of the pixel."""
    share: float
    """The share of its place in the mean of the pixel."""
    color: Triple
    """The linear colour it brings."""
    rays: list[TreeRay]
    """The rays in the order of tracing; the first is the primary ray."""
    _json: dict[str, Any] = field(repr=False, compare=False)

    @property
    def root(self) -> TreeRay:
        """The primary ray."""
        return self.rays[0]


@dataclass(frozen=True, kw_only=True)
class TreeRay(Node):
    """A ray of a tree."""
    id: int
    """Its number in the tree."""
    parent: int | None = None
    """The ray that sent it; none for the primary ray."""
    kind: str
    """`primary`, `reflection`, `transparency` or `gather`."""
    depth: int
    """Level in the tree, 1 for the primary ray."""
    weight: float
    """The largest channel of the product of all coefficients on the way to it."""
    spectrum: float | None = None
    """Its place in the spectrum, if it stands for a part of it."""
    share: Triple
    """The factor with which it contributes to the hit that sent it."""
    power: float
    """The exponent that is applied to the radiance before."""
    ray: Line
    """The ray."""
    hit: Hit | None = None
    """The surface it hit."""
    background: Triple | None = None
    """The colour of the background, if it hit nothing."""
    lights: list[Light]
    """The lights looked at from the hit."""
    gathered: Gathered | None = None
    """Light that a method of light transport found at the hit."""
    ended: list[Ended]
    """Rays that were not traced."""
    children: list[int]
    """Numbers of the rays it sent."""
    medium: str | None = None
    """The material of the solid it ran through; none is air."""
    attenuation: Triple
    """The attenuation by the medium it ran through."""
    fog: Triple
    """The light that fog and rainbows in front of the hit add."""
    local: Triple
    """The hit's own contribution."""
    total: Triple
    """The radiance along the ray."""
    _nodes: tuple[TreeRay, ...] = field(default=(), repr=False, compare=False)
    _json: dict[str, Any] = field(repr=False, compare=False)

    @property
    def nodes(self) -> tuple[TreeRay, ...]:
        """The rays it sent."""
        return self._nodes

    def walk(self) -> Iterator[TreeRay]:
        """This ray and all that came of it, depth first."""
        waiting: list[TreeRay] = [self]
        while waiting:
            ray = waiting.pop()
            yield ray
            waiting.extend(reversed(ray._nodes))


@dataclass(frozen=True, kw_only=True)
class Line(Node):
    """Origin and direction of a ray."""
    origin: Triple
    """Where it starts."""
    direction: Triple
    """How far it moves per unit of `t`."""
    _json: dict[str, Any] = field(repr=False, compare=False)


@dataclass(frozen=True, kw_only=True)
class Gathered(Node):
    """Light that is neither the hit's own, nor reflected, nor transmitted."""
    method: str
    """The name of the method that found it."""
    radiance: Triple
    """The radiance, without that of its rays."""
    rays: int
    """How many rays it asked for."""
    _json: dict[str, Any] = field(repr=False, compare=False)


@dataclass(frozen=True, kw_only=True)
class Ended(Node):
    """A branch that was not traced."""
    kind: str
    """`reflection` or `transparency`."""
    weight: float
    """Its weight."""
    reason: str
    """Why."""
    _json: dict[str, Any] = field(repr=False, compare=False)


@dataclass(frozen=True, kw_only=True)
class Hit(Node):
    """The surface that a ray hit."""
    t: float
    """Ray parameter."""
    object: str
    """Kind and name of the object."""
    object_id: int
    """Its number."""
    element: int
    """Number of the element."""
    source: str | None = None
    """The place in the scene's files: `file:line:column`."""
    material: str
    """The material."""
    position: Triple
    """World position."""
    normal: Triple
    """Unit normal of the surface, on the side of the ray."""
    shading_normal: Triple
    """Unit normal for shading, on the side of the ray."""
    n1: float
    """Index of refraction on the side of the ray."""
    n2: float
    """Index of refraction behind the surface."""
    cos_theta1: float
    """Cosine of the angle of incidence."""
    cos_theta2: float | None = None
    """Cosine of the angle of refraction."""
    total_reflection: bool
    """Whether Snell's law has no solution."""
    ka: Triple
    """The ambient coefficient."""
    Ia: Triple
    """The ambient light."""
    ka_Ia: Triple
    """Their product."""
    emission: Triple
    """Light that the surface emits."""
    kr: Triple
    """The coefficient of reflection."""
    kt: Triple
    """The coefficient of transparency."""
    model: str
    """Its name."""
    fresnel: float | None = None
    """Fresnel's reflectance, if the material asks for it."""
    kd: Triple | None = None
    """The diffuse coefficient."""
    ks: Triple | None = None
    """The coefficient of highlights; none without."""
    p: float | None = None
    """The exponent of highlights; none without."""
    terms_of: str | None = None
    """The shading model whose terms are shown, if one was asked for."""
    layers: list[Layer] | None = None
    """The layers of the texture."""
    _json: dict[str, Any] = field(repr=False, compare=False)


@dataclass(frozen=True, kw_only=True)
class Layer(Node):
    """A layer of a POV-Ray texture."""
    pigment: Pigment
    """The colour."""
    normal: Triple
    """The tilted unit normal, on the side of the ray."""
    share: float
    """The share where textures are blended."""
    above: Triple
    """What the layers above let pass."""
    C: Triple
    """What ambient, emission and diffuse are multiplied by."""
    finish: Finish
    """The finish."""
    rise: float | None = None
    """How far the reflection has come from `min` to `max`."""
    fresnel: float | None = None
    """The same, if it is Fresnel's."""
    reflection_film: Triple | None = None
    """The factor of a thin film for light from the mirror direction."""
    reflectance: Triple
    """The share of the light from the mirror direction that is reflected."""
    _json: dict[str, Any] = field(repr=False, compare=False)


@dataclass(frozen=True, kw_only=True)
class Pigment(Node):
    """A colour with `filter` and `transmit`."""
    rgb: Triple
    """The colour."""
    filter: float
    """What passes with this colour."""
    transmit: float
    """What passes unchanged."""
    _json: dict[str, Any] = field(repr=False, compare=False)


@dataclass(frozen=True, kw_only=True)
class Finish(Node):
    """A POV-Ray finish, with the words of its language."""
    ambient: Triple
    emission: Triple
    diffuse: float
    diffuse_from_behind: float
    brilliance: float
    phong: float
    phong_size: float
    specular: float
    roughness: float
    metallic: float
    crand: float
    irid: Irid | None = None
    conserve_energy: bool
    reflection: Reflection
    _json: dict[str, Any] = field(repr=False, compare=False)


@dataclass(frozen=True, kw_only=True)
class Irid(Node):
    """A thin film."""
    amount: float
    thickness: float
    turbulence: float
    _json: dict[str, Any] = field(repr=False, compare=False)


@dataclass(frozen=True, kw_only=True)
class Reflection(Node):
    """The reflection of a finish."""
    min: Triple
    max: Triple
    fresnel: bool
    falloff: float
    exponent: float
    metallic: float
    _json: dict[str, Any] = field(repr=False, compare=False)


@dataclass(frozen=True, kw_only=True)
class Light(Node):
    """A light, as a hit sees it."""
    light: str
    """Number, counted from 1, and name."""
    kind: str | None = None
    """Its kind."""
    position: Triple | None = None
    """Its position, if it has one."""
    direction: Triple | None = None
    """The direction of its light, if it has no position."""
    source: str | None = None
    """The place in the scene's files."""
    color: Triple | None = None
    """Its colour."""
    color_here: Triple
    """Its colour at the point: spot lights and fading change it."""
    l: Triple | None = None
    """Unit vector towards it; none where it does not shine."""
    n_dot_l: float
    """n·l."""
    shadow_rays: list[Shadow]
    """The shadow rays."""
    fog: Triple
    """What fog leaves of its light."""
    visible: Triple
    """What shadow rays leave of its light."""
    L: Triple
    """What arrives."""
    makes_highlights: bool
    """Whether it makes highlights."""
    mean_of_points: int | None = None
    """Of how many points of the light the terms are the mean."""
    terms: list[SurfaceTerm]
    """What each layer makes of it."""
    diffuse: Triple
    """The diffuse part of what is seen."""
    highlight: Triple
    """The highlights."""
    _json: dict[str, Any] = field(repr=False, compare=False)


@dataclass(frozen=True, kw_only=True)
class SurfaceTerm(Node):
    """What a surface, or a layer, makes of one light."""
    n_dot_l: float
    """n·l, at the layer's normal."""
    diffuse_factor: float
    """What the diffuse term takes of the light, without the colour."""
    grain: float
    """What `crand` takes from it."""
    diffuse: Triple
    """The diffuse part of what is seen."""
    highlight: Triple
    """The highlights."""
    phong_cosine: float | None = None
    """The cosine of `phong`."""
    phong_cosine_is: str | None = None
    """Between what: `r·v` or `h·n`."""
    phong: float | None = None
    """The highlight per unit of light."""
    specular_cosine: float | None = None
    """The cosine of `specular`."""
    specular_cosine_is: str | None = None
    """Between what: `h·n` or `r·v`."""
    specular: float | None = None
    """The highlight per unit of light."""
    tint: Triple | None = None
    """The colour that `metallic` gives."""
    film: Triple | None = None
    """The factor of a thin film."""
    r_dot_v: float | None = None
    """r·v."""
    r_dot_v_p: float | None = None
    """`(r·v)^p`."""
    h_dot_n: float | None = None
    """h·n."""
    h_dot_n_p: float | None = None
    """`(h·n)^p`."""
    _json: dict[str, Any] = field(repr=False, compare=False)


@dataclass(frozen=True, kw_only=True)
class Shadow(Node):
    """A shadow ray."""
    origin: Triple
    """Where it starts."""
    direction: Triple
    """The light is at `t = 1`, unless it is infinitely far away."""
    met: list[Obstacle]
    """What it met."""
    medium_behind: Triple
    """What the medium behind the last of them keeps."""
    beside_mask: bool
    """Whether the light has to cross an object on its way and does not."""
    visible: Triple
    """What arrives."""
    _json: dict[str, Any] = field(repr=False, compare=False)


@dataclass(frozen=True, kw_only=True)
class Obstacle(Node):
    """Something in the way of a shadow ray."""
    t: float
    """Ray parameter."""
    object: str
    """Kind and name of the object."""
    object_id: int
    """Its number."""
    element: int
    """Number of the element."""
    source: str | None = None
    """The place in the scene's files."""
    blocks: bool
    """Whether it lets nothing through."""
    filter: Triple
    """What its surface lets through."""
    medium_before: Triple
    """What the medium in front of it keeps."""
    _json: dict[str, Any] = field(repr=False, compare=False)
