"""The builder means what POV-Ray's language says, to the last bit, and has everything that the Rust builder has."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from conftest import ROOT

import strahl
from strahl import Background, Fog, Interior, Material, Normal, Object, Pattern, Pigment, Rainbow, Texture

EYE = "camera { location <1, 2, -4> look_at 0 angle 50 } "
LAMP = "light_source { <4, 8, -6>, 1 } "
GROUND = "plane { y, -1 pigment { rgb <0.4, 0.5, 0.3> } } "
TWO = {0: (1, 0.1, 0), 1: (0, 0.2, 0.9)}
MAP = "color_map { [0 rgb <1, 0.1, 0>] [1 rgb <0, 0.2, 0.9>] }"


def _sha256(scene: strahl.Scene) -> str:
    return scene.render(24, 18, sampling="center", threads=1).sha256


def _same(built: strahl.Scene, text: str) -> None:
    written = strahl.parse(f"#version 3.7; global_settings {{ assumed_gamma 1 }} {text}")
    assert _sha256(built) == _sha256(written)


def _scene(*things: Any, more: str = LAMP + EYE) -> strahl.Scene:
    """Things with what a text has besides."""
    return strahl.parse(f"#version 3.7; global_settings {{ assumed_gamma 1 }} {more}").add(*things)


PATTERNS: dict[str, Pattern] = {
    "agate agate_turb 0.5": Pattern.agate(0.5),
    "aoi": Pattern("aoi"),
    "boxed": Pattern("boxed"),
    "bozo": Pattern("bozo"),
    "cells scale 0.3": Pattern("cells").scale(0.3),
    "crackle form <1, 0.5, 0> metric 3 offset 0.4 scale 0.4": Pattern.crackle((1, 0.5, 0), metric=3, offset=0.4).scale(0.4),
    "crackle solid scale <0.4, 0.2, 0.3>": Pattern.crackle(solid=True).scale((0.4, 0.2, 0.3)),
    "cylindrical": Pattern("cylindrical"),
    "dents scale 0.2": Pattern("dents").scale(0.2),
    "mandel 30 exponent 3 interior 1, 0.7 exterior 6, 0.3": Pattern.fractal(30, exponent=3, interior=(1, 0.7), exterior=(6, 0.3)),
    "julia <0.353, 0.288>, 30": Pattern.fractal(30, julia=0.353 + 0.288j),
    "magnet 1 mandel 20 scale 0.3": Pattern.fractal(20, kind="magnet1").scale(0.3),
    "magnet 2 mandel 20 scale 0.3": Pattern.fractal(20, kind="magnet2").scale(0.3),
    "function { sin(7 * x) + y }": Pattern.function("sin(7 * x) + y"),
    "gradient <1, 2, 0> scale 0.5": Pattern.gradient((1, 2, 0)).scale(0.5),
    "granite": Pattern("granite"),
    "leopard scale 0.1": Pattern("leopard").scale(0.1),
    "marble turbulence 0.7 octaves 4 lambda 2.5 omega 0.4 scale 0.3": Pattern("marble").turbulence(0.7, octaves=4, lambda_=2.5, omega=0.4).scale(0.3),
    "onion scale 0.3": Pattern("onion").scale(0.3),
    "pigment_pattern { checker rgb 0, rgb 1 scale 0.3 }": Pattern.pigment(Pigment.blocks(Pattern("checker").scale(0.3), [0, 1])),
    "planar": Pattern("planar"),
    "quilted control0 0.3 control1 0.8 scale 0.4": Pattern.quilted(0.3, 0.8).scale(0.4),
    "radial frequency 5 phase 0.2 sine_wave": Pattern("radial").frequency(5, 0.2).wave("sine"),
    "ripples frequency 3": Pattern.ripples().frequency(3),
    "slope { <0, 1, 0.2>, 0.2, 0.8 altitude y, -1, 1 }": Pattern.slope((0, 1, 0.2), range=(0.2, 0.8), altitude=(0, 1, 0), altitude_range=(-1, 1)),
    "slope { point_at <3, 2, 1> }": Pattern.slope((3, 2, 1), to_point=True),
    "spherical": Pattern("spherical"),
    "spiral1 3 scale 0.3": Pattern.spiral(3).scale(0.3),
    "spiral2 5 scale 0.3": Pattern.spiral(5, double=True).scale(0.3),
    "tiling 7 scale 0.2": Pattern.tiling(7).scale(0.2),
    "waves frequency 2 scallop_wave": Pattern.waves().frequency(2).wave("scallop"),
    "wood turbulence <0.1, 0.2, 0.3> rotate 30 * x scale 0.2": Pattern("wood").turbulence((0.1, 0.2, 0.3)).rotate((1, 0, 0), 30).scale(0.2),
    "wrinkles noise_generator 3 cubic_wave": Pattern("wrinkles").noise(3).wave("cubic"),
    "bozo triangle_wave frequency 3 scale 0.4": Pattern("bozo").wave("triangle").frequency(3).scale(0.4),
    "bozo poly_wave 2 scale 0.4": Pattern("bozo").wave("poly", 2).scale(0.4),
    "bozo ramp_wave frequency 2": Pattern("bozo").wave("ramp").frequency(2),
    "gradient y warp { repeat 0.5 * x offset <0, 0.3, 0> flip y }": Pattern.gradient((0, 1, 0)).repeat("x", 0.5, offset=(0, 0.3, 0), flip=(False, True, False)),
    "bozo warp { black_hole <0.5, 0.6, 0.7>, 0.45 repeat <1, 2, 3> turbulence <0.3, 0.2, 0.4> }":
        Pattern("bozo").black_hole((0.5, 0.6, 0.7), 0.45, repeat=(1, 2, 3), turbulence=(0.3, 0.2, 0.4)),
    "bozo warp { cubic }": Pattern("bozo").wrap("cubic"),
    "gradient y warp { black_hole <0, 0.3, -1>, 0.7 strength 1.5 falloff 1.2 inverse }":
        Pattern.gradient((0, 1, 0)).black_hole((0, 0.3, -1), 0.7, strength=1.5, falloff=1.2, inverse=True),
    "gradient y warp { turbulence 0.5 octaves 3 } scale 0.5": Pattern.gradient((0, 1, 0)).stir(0.5, octaves=3).scale(0.5),
    "granite scale 0.2 warp { cylindrical orientation y dist_exp 1 }":
        Pattern("granite").scale(0.2).wrap("cylindrical", orientation=(0, 1, 0), distance_exponent=1),
    "granite scale 0.2 warp { spherical }": Pattern("granite").scale(0.2).wrap("spherical"),
    "granite scale 0.2 warp { toroidal major_radius 0.6 }": Pattern("granite").scale(0.2).wrap("toroidal", radius=0.6),
    "granite scale 0.2 warp { planar <1, 1, 0>, 0.3 }": Pattern("granite").scale(0.2).flatten((1, 1, 0), 0.3),
}  # fmt: skip


@pytest.mark.parametrize("text", PATTERNS)
def test_patterns_are_those_of_the_language(text: str) -> None:
    ball = strahl.sphere(material=Pigment.map(PATTERNS[text], TWO))
    _same(_scene(ball), f"{LAMP} {EYE} sphere {{ 0, 1 pigment {{ {text} {MAP} }} }}")


BLOCKS: dict[str, Pattern] = {
    "brick {} brick_size <0.5, 0.3, 0.4> mortar 0.1": Pattern.brick((0.5, 0.3, 0.4), 0.1),
    "checker {} scale 0.3": Pattern("checker").scale(0.3),
    "hexagon {} scale 0.3": Pattern("hexagon").scale(0.3),
    "square {} scale 0.3": Pattern("square").scale(0.3),
    "triangular {} scale 0.3": Pattern("triangular").scale(0.3),
    "cubic {}": Pattern("cubic"),
    "object {{ box {{ -0.6, 0.6 rotate 20 * y }} {} }}": Pattern.object(strahl.box((-0.6,) * 3, (0.6,) * 3).rotate((0, 1, 0), 20)),
}
RED = [(0.1 * k, 0.9 - 0.1 * k, 0.5) for k in range(6)]


def _rgb(color: tuple[float, ...]) -> str:
    return "rgb <" + ", ".join(map(repr, color)) + ">"


@pytest.mark.parametrize("text", BLOCKS)
def test_blocks_are_those_of_the_language(text: str) -> None:
    pattern = BLOCKS[text]
    colors = RED[: pattern.blocks]
    _same(
        _scene(strahl.sphere(material=Pigment.blocks(pattern, colors))),
        f"{LAMP} {EYE} sphere {{ 0, 1 pigment {{ {text.format(', '.join(map(_rgb, colors)))} }} }}",
    )
    with pytest.raises(ValueError, match="blocks, not 1"):
        Pigment.blocks(pattern, [1])


PALE = strahl.Finish(ambient=0.3, diffuse=0.5)
LOOKS: dict[str, Material | Texture | Pigment] = {
    "pigment { rgbft <0.9, 0.7, 0.5, 0.4, 0.2> }": Pigment((0.9, 0.7, 0.5, 0.4, 0.2)),
    "pigment { bozo pigment_map { [0.2 rgb 1] [0.8 checker rgb 0, rgb 1 scale 0.2] } scale 0.6 }": Pigment.map(
        Pattern("bozo"), [(0.2, 1), (0.8, Pigment.blocks(Pattern("checker").scale(0.2), [0, 1]))]
    ).scale(0.6),
    "pigment { average pigment_map { [1 gradient y color_map { [0 rgb 0] [1 rgb 1] }] [3 rgb <1, 0, 0>] } }": Pigment.average(
        Pigment.map(Pattern.gradient((0, 1, 0)), {0: 0, 1: 1}), (1, 0, 0), weights=[1, 3]
    ),
    "pigment { uv_mapping gradient x color_map { [0 rgb 0] [1 rgb 1] } }": Pigment.map(Pattern.gradient((1, 0, 0)), {0: 0, 1: 1}).uv_mapped(),
    "pigment { rgb 0.7 } normal { bumps 0.6 scale 0.2 }": Texture(0.7, normal=Normal("bumps", 0.6).scale(0.2)),
    "pigment { rgb 0.7 } normal { bozo 0.6 scale 0.2 }": Texture(0.7, normal=Normal("bozo", 0.6).scale(0.2)),
    "pigment { rgb 0.7 } normal { dents 0.6 scale 0.2 no_bump_scale }": Texture(0.7, normal=Normal("dents", 0.6, bump_scale=False).scale(0.2)),
    "pigment { rgb 0.7 } normal { wrinkles 0.8 scale 0.3 }": Texture(0.7, normal=Normal("wrinkles", 0.8).scale(0.3)),
    "pigment { rgb 0.7 } normal { ripples 0.8 frequency 4 }": Texture(0.7, normal=Normal(Pattern.ripples().frequency(4), 0.8)),
    "pigment { rgb 0.7 } normal { waves 0.8 frequency 4 }": Texture(0.7, normal=Normal(Pattern.waves().frequency(4), 0.8)),
    "pigment { rgb 0.7 } normal { quilted 0.8 control0 0.2 control1 0.9 scale 0.3 }": Texture(0.7, normal=Normal(Pattern.quilted(0.2, 0.9).scale(0.3), 0.8)),
    "pigment { rgb 0.7 } normal { facets size 0.3 rotate 20*y }": Texture(0.7, normal=Normal.facets(0.3).rotate((0, 1, 0), 20)),
    "pigment { rgb 0.7 } normal { facets coords 0.5 size 0.2 scale 2 }": Texture(0.7, normal=Normal.facets(0.2, tilt=0.5).scale(2)),
    "pigment { rgb 0.7 } normal { granite 0.4 accuracy 0.05 }": Texture(0.7, normal=Normal("granite", 0.4, accuracy=0.05)),
    "pigment { rgb 0.7 } normal { gradient y 0.5 slope_map { [0 <0, 1>] [0.5 <1, 0>] [1 <0, -1>] } scale 0.4 }": Texture(
        0.7, normal=Normal(Pattern.gradient((0, 1, 0)), 0.5, slopes={0: (0, 1), 0.5: (1, 0), 1: (0, -1)}).scale(0.4)
    ),
    "pigment { rgb 0.7 } normal { gradient y normal_map { [0.3 bumps 0.5 scale 0.2] [0.7 dents 0.8 scale 0.3] } }": Texture(
        0.7, normal=Normal.map(Pattern.gradient((0, 1, 0)), {0.3: Normal("bumps", 0.5).scale(0.2), 0.7: Normal("dents", 0.8).scale(0.3)})
    ),
    "pigment { rgb 0.7 } normal { average normal_map { [1 bumps 0.5 scale 0.2] [2 dents 0.8 scale 0.3] } }": Texture(
        0.7, normal=Normal.average(Normal("bumps", 0.5).scale(0.2), Normal("dents", 0.8).scale(0.3), weights=[1, 2])
    ),
    "pigment { rgb <1, 0.5, 0> } finish { ambient 0.2 emission 0.1 diffuse 0.7 brilliance 2 phong 0.4 phong_size 20 specular 0.3 roughness 0.02 metallic 0.6 }": Texture(
        (1, 0.5, 0),
        finish=strahl.Finish(ambient=0.2, emission=0.1, diffuse=0.7, brilliance=2, phong=0.4, phong_size=20, specular=0.3, roughness=0.02, metallic=0.6),
    ),
    "pigment { rgb <1, 0.5, 0> } finish { reflection { 0.1, 0.8 falloff 3 exponent 0.8 metallic 0.5 } conserve_energy }": Texture(
        (1, 0.5, 0),
        finish=strahl.Finish(
            reflection=0.1, reflection_grazing=0.8, reflection_falloff=3, reflection_exponent=0.8, reflection_metallic=0.5, conserve_energy=True
        ),
    ),
    "pigment { rgbf 0.9 } finish { reflection { 0, 1 fresnel } } interior { ior 1.5 fade_distance 0.8 fade_power 2 fade_color <1, 0.2, 0.1> }": Material.textured(
        Texture((0.9,) * 4 + (0,), finish=strahl.Finish(reflection=0, reflection_grazing=1, fresnel=True)),
        interior=Interior(1.5, fade_distance=0.8, fade_power=2, fade_color=(1, 0.2, 0.1)),
    ),
    "pigment { rgbf 0.9 } interior { ior 1.5 dispersion 1.2 dispersion_samples 5 caustics 0.5 }": Material.textured(
        Pigment((0.9,) * 4 + (0,)), interior=Interior(1.5, dispersion=1.2, dispersion_samples=5, caustics=0.5)
    ),
    "texture { pigment { rgb <1, 0, 0> } finish { ambient 0.3 diffuse 0.5 } } texture { pigment { granite color_map { [0 rgbt 1] [1 rgb 0.2] } } scale 0.5 }": Texture.layered(
        Texture((1, 0, 0), finish=PALE), Texture(Pigment.map("granite", {0: (1, 1, 1, 0, 1), 1: 0.2})).scale(0.5)
    ),
    "texture { marble texture_map { [0.2 pigment { rgb 1 }] [0.8 pigment { rgb 0.1 } finish { phong 1 }] } scale 0.4 rotate 40 * z }": Texture.map(
        "marble", {0.2: Texture(1), 0.8: Texture(0.1, finish=strahl.Finish(phong=1))}
    ).scale(0.4).rotate((0, 0, 1), 40),
    "texture { checker texture { pigment { rgb 1 } }, texture { pigment { rgb 0.1 } } scale 0.4 }": Texture.blocks("checker", [Texture(1), Texture(0.1)]).scale(0.4),
    "texture { average texture_map { [1 pigment { rgb 1 }] [3 pigment { rgb <1, 0, 0> }] } }": Texture.average(Texture(1), Texture((1, 0, 0)), weights=[1, 3]),
    "texture { uv_mapping pigment { checker rgb 0, rgb 1 scale 0.2 } }": Texture(Pigment.blocks(Pattern("checker").scale(0.2), [0, 1])).uv_mapped(),
    "texture { pigment { rgbt 0.5 } } interior_texture { pigment { rgb <0, 1, 0> } }": Material.textured(
        Pigment((0.5, 0.5, 0.5, 0, 0.5)), inside=Texture((0, 1, 0))
    ),
    "pigment { rgb 0.5 } finish { irid { 0.4 thickness 0.5 turbulence 0.2 } }": Texture(0.5, finish=strahl.Finish(irid=(0.4, 0.5, 0.2))),
}  # fmt: skip


@pytest.mark.parametrize("text", LOOKS)
def test_looks_are_those_of_the_language(text: str) -> None:
    _same(_scene(strahl.sphere(material=LOOKS[text]), more=LAMP + EYE + GROUND), f"{LAMP} {EYE} {GROUND} sphere {{ 0, 1 {text} }}")


GREY = strahl.Texture(0.7)
LIGHTS: dict[str, Callable[[], Any]] = {
    "light_source { <4, 8, -6>, rgb <1, 0.8, 0.6> }": lambda: strahl.point_light((4, 8, -6), (1, 0.8, 0.6), clearance=1e-3),
    "light_source { <4, 8, -6>, 1 fade_distance 5 fade_power 2 }": lambda: strahl.point_light((4, 8, -6), falloff=(5, 2), clearance=1e-3),
    "light_source { <4, 8, -6>, 1 shadowless }": lambda: strahl.point_light((4, 8, -6), shadows=False, highlights=False),
    "light_source { <4, 8, -6>, 1 media_attenuation on } fog { distance 20 rgb 0.5 }": lambda: [
        strahl.point_light((4, 8, -6), fogged=True, clearance=1e-3), Fog(0.5, 20)
    ],
    "light_source { <4, 8, -6>, 1 area_light 3 * x, 3 * z, 4, 5 adaptive 1 circular orient }": lambda: strahl.area_light(
        (4, 8, -6), (3, 0, 0), (0, 0, 3), size=(4, 5), circular=True, orient=True, clearance=1e-3
    ),
    "light_source { <4, 8, -6>, 1 area_light 3 * x, 3 * z, 4, 4 area_illumination on }": lambda: strahl.point_light((4, 8, -6), clearance=1e-3).area(
        (3, 0, 0), (0, 0, 3), (4, 4), adaptive=None, illumination=True
    ),
    "light_source { 0, 1 translate <4, 8, -6> rotate 40 * y }": lambda: strahl.point_light((0, 0, 0), clearance=1e-3)
    .translate((4, 8, -6))
    .rotate((0, 1, 0), 40),
    "light_source { <4, 8, -6>, 1 projected_through { box { <1, 1, -2>, <2, 3, 0> } } }": lambda: strahl.point_light((4, 8, -6), clearance=1e-3).through(
        strahl.box((1, 1, -2), (2, 3, 0))
    ),
    "light_source { <0.5, 1.5, -0.5>, 1 looks_like { sphere { 0, 0.2 pigment { rgb 0.7 } finish { emission 1 } } } }": lambda: strahl.point_light(
        (0, 0, 0), clearance=1e-3
    ).with_body(strahl.sphere(radius=0.2, material=Texture(0.7, finish=strahl.Finish(emission=1)))).translate((0.5, 1.5, -0.5)),
    "light_source { <4, 8, -6>, 0.3 } light_group { light_source { <-4, 5, -6>, rgb <1, 0, 0> } sphere { <1, 0.5, 0>, 0.5 pigment { rgb 0.7 } } global_lights off }": lambda: [
        strahl.point_light((4, 8, -6), 0.3, clearance=1e-3),
        strahl.light_group(strahl.point_light((-4, 5, -6), (1, 0, 0), clearance=1e-3), strahl.sphere((1, 0.5, 0), 0.5, material=GREY)),
    ],
    "light_source { <4, 8, -6>, 0.3 } light_group { light_source { <-4, 5, -6>, rgb <1, 0, 0> } sphere { <1, 0.5, 0>, 0.5 pigment { rgb 0.7 } } global_lights on }": lambda: [
        strahl.point_light((4, 8, -6), 0.3, clearance=1e-3),
        strahl.light_group([strahl.point_light((-4, 5, -6), (1, 0, 0), clearance=1e-3), strahl.sphere((1, 0.5, 0), 0.5, material=GREY)], global_lights=True),
    ],
    "#declare G = light_group { light_source { <-4, 5, -6>, rgb <1, 0, 0> } sphere { <1, 0.5, 0>, 0.5 pigment { rgb 0.7 } } } light_group { light_source { <4, 8, -6>, 0.3 } G }": lambda: [
        strahl.light_group(
            strahl.point_light((4, 8, -6), 0.3, clearance=1e-3),
            strahl.light_group(strahl.point_light((-4, 5, -6), (1, 0, 0), clearance=1e-3), strahl.sphere((1, 0.5, 0), 0.5, material=GREY), outer_lights=True),
        ),
    ],
}  # fmt: skip


@pytest.mark.parametrize("text", LIGHTS)
def test_lights_are_those_of_the_language(text: str) -> None:
    more = EYE + GROUND + "sphere { 0, 0.8 pigment { rgb 0.7 } finish { phong 1 } } "
    _same(_scene(LIGHTS[text](), more=more), more + text)


AIR: dict[str, Callable[[], Any]] = {
    "fog { distance 6 rgbft <0.5, 0.6, 0.7, 0.3, 0.1> }": lambda: Fog((0.5, 0.6, 0.7), 6, filter=0.3, transmit=0.1),
    "fog { fog_type 2 distance 3 rgb 0.7 fog_offset -0.5 fog_alt 0.4 up <0.1, 1, 0> }": lambda: Fog(0.7, 3, altitude=0.4, offset=-0.5, up=(0.1, 1, 0)),
    "fog { distance 6 rgb 0.7 turbulence <0.3, 0.4, 0.5> turb_depth 0.8 octaves 3 lambda 2.2 omega 0.6 }": lambda: Fog(
        0.7, 6, turbulence=(0.3, 0.4, 0.5), turbulence_depth=0.8, octaves=3, lambda_=2.2, omega=0.6
    ),
    f"rainbow {{ direction <0, -0.3, 1> angle 20 width 8 distance 10 {MAP} jitter 0.01 up <0.1, 1, 0> arc_angle 120 falloff_angle 60 }}": lambda: Rainbow(
        (0, -0.3, 1), TWO, angle=20, width=8, distance=10, jitter=0.01, up=(0.1, 1, 0), arc_angle=120, falloff_angle=60
    ),
    "background { rgb <0.2, 0.3, 0.4> }": lambda: Background.solid((0.2, 0.3, 0.4)),
    "sky_sphere { pigment { gradient y color_map { [0 rgb 1] [1 rgb <0.1, 0.2, 0.8>] } } pigment { bozo color_map { [0.4 rgbt 1] [1 rgb 1] } scale 0.3 } }": lambda: Background.sky(
        Pigment.map(Pattern.gradient((0, 1, 0)), {0: 1, 1: (0.1, 0.2, 0.8)}), Pigment.map("bozo", {0.4: (1, 1, 1, 0, 1), 1: 1}).scale(0.3)
    ),
}  # fmt: skip


@pytest.mark.parametrize("text", AIR)
def test_air_and_skies_are_those_of_the_language(text: str) -> None:
    more = LAMP + EYE + "sphere { 0, 0.8 pigment { rgb 0.7 } } "
    _same(_scene(AIR[text](), more=more), more + text)


CUBE = [(x, y, z) for z in (-1, 1) for y in (-1, 1) for x in (-1, 1)]
SIDES = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]]
OCTAHEDRON = [(1, 0, 0), (0, 1, 0), (0, -1, 0), (-1, 0, 0), (0, 0, 1), (0, 0, -1)]
EIGHTHS = [[0, 1, 4], [1, 3, 4], [3, 2, 4], [2, 0, 4], [1, 0, 5], [3, 1, 5], [2, 3, 5], [0, 2, 5]]


def _cage(scheme: str, points: list[tuple[int, int, int]], faces: list[list[int]]) -> str:
    """A subdivision surface with a crease along the points 0, 1, 3, 2, and with the last point as a corner."""
    places = ", ".join(f"<{x}, {y}, {z}>" for x, y, z in points)
    sides = " ".join(f"face {{ {', '.join(map(str, face))} }}" for face in faces)
    return f"subdivision {{ {scheme} points {{ {places} }} {sides} crease {{ sharpness 2.5 0, 1, 3, 2, 0 }} corner {{ sharpness 10 {len(points) - 1} }} }}"


SHAPES: dict[str, Callable[[], Object]] = {
    "julia_fractal { <-0.083, 0, -0.83, -0.025> quaternion sqr max_iteration 8 precision 15 }": lambda: strahl.julia(
        (-0.083, 0, -0.83, -0.025), max_iteration=8, precision=15
    ),
    "julia_fractal { <-0.2, 0.3, 0.1, 0.5> hypercomplex pwr (2.5, 0.3) max_iteration 6 slice <0.2, 0, 0, 1>, 0.1 }": lambda: strahl.julia(
        (-0.2, 0.3, 0.1, 0.5), "pwr", algebra="hypercomplex", exponent=2.5 + 0.3j, max_iteration=6, slice=(0.2, 0, 0, 1), distance=0.1
    ),
    "mandelbulb { 8 max_iteration 5 precision 15 }": lambda: strahl.mandelbulb(8, max_iteration=5, precision=15),
    _cage("catmull_clark", CUBE, SIDES): lambda: strahl.subdivision(CUBE, SIDES, creases=[([0, 1, 3, 2, 0], 2.5)], corners=[(7, 10)]),
    _cage("loop", OCTAHEDRON, EIGHTHS): lambda: strahl.subdivision(
        OCTAHEDRON, np.array(EIGHTHS), "loop", creases=[((0, 1), 2.5), ((1, 3), 2.5), ((3, 2), 2.5), ((2, 0), 2.5)], corners=[(5, 10)]
    ),
    "menger { -1, 1 3 }": lambda: strahl.menger((-1, -1, -1), (1, 1, 1), 3),
    "terrain { fbm h 1.1 octaves 4 extent <-2, -2>, <2, 2> offset -0.5 }": lambda: strahl.terrain(
        "fbm", h=1.1, octaves=4, x=(-2, 2), z=(-2, 2), offset=-0.5
    ),
    "isosurface { function { x*x + 2*y*y + z*z*z*z - 0.7 } contained_by { box { -1, 1 } } threshold 0.1 open }": lambda: strahl.implicit(
        "x*x + A*y*y + z*z*z*z - 0.7", threshold=0.1, declare={"A": 2}, open=True
    ),
    "parametric { function { u }, function { 0.3*sin(4*u)*v } function { v } <-1, -1>, <1, 1> contained_by { box { -2, 2 } } }": lambda: strahl.parametric(
        "u", "0.3*sin(4*u)*v", "v", (-1, 1), (-1, 1), corner=(-2, -2, -2), opposite=(2, 2, 2)
    ),
    "sphere { 0, 1 clipped_by { plane { y, 0.3 } } }": lambda: strahl.sphere().clipped_by(strahl.plane((0, 0.3, 0))),
    "intersection { sphere { 0, 1 } box { -0.9, 0.9 } bounded_by { box { <-1, -1, -1>, <0.5, 0.6, 1> } } }": lambda: (
        strahl.sphere() & strahl.box((-0.9,) * 3, (0.9,) * 3)
    ).bounded_by(strahl.box((-1, -1, -1), (0.5, 0.6, 1))),
    "sphere { 0, 1 double_illuminate }": lambda: strahl.sphere().double_illuminated(),
    "union { sphere { 0, 0.7 } box { -0.6, 0.6 } translate 0.2 * y rotate <0, 30, 0> }": lambda: (strahl.sphere(radius=0.7) | strahl.box((-0.6,) * 3, (0.6,) * 3))
    .translate((0, 0.2, 0))
    .rotate((0, 1, 0), 30),
}  # fmt: skip


@pytest.mark.parametrize("text", SHAPES)
def test_shapes_are_those_of_the_language(text: str) -> None:
    more = LAMP + EYE + GROUND
    look = "pigment { rgb 0.7 }"
    _same(_scene(SHAPES[text]().material(GREY), more=more), f"{more} object {{ {text} {look} }}")


FONTS = [*Path("/usr/share/fonts").rglob("*.ttf"), *Path("/Library/Fonts").rglob("*.ttf"), *Path("C:/Windows/Fonts").glob("*.ttf")]


@pytest.mark.skipif(not FONTS, reason="there is no font")
def test_texts_are_letters(tmp_path: Path) -> None:
    font = sorted(FONTS)[0]
    letters = strahl.text('L "x\\n', font, thickness=0.3, spacing=(0.1, 0, 0)).material(GREY)
    written = f'text {{ ttf "{font.as_posix()}" "L \\"x\\\\n" 0.3, 0.1 * x pigment {{ rgb 0.7 }} }}'
    _same(_scene(letters), LAMP + EYE + written)
    # Another font of the system replaces it with a warning, which is an error in tests, or there is none.
    with pytest.raises((strahl.SceneError, strahl.SceneWarning), match="nowhere.ttf.* was not found"):
        strahl.text("x", tmp_path / "nowhere.ttf")


def test_cameras_see_through_meshes_lenses_and_ripples() -> None:
    ball = strahl.sphere(material=Texture(1, finish=strahl.Finish(ambient=0, diffuse=0, emission=1)))
    # A square in four faces that looks at the ball, which is behind two of them.
    corners = [[-9, -1, 0], [0, -1, 0], [0, 1, 0], [-9, 1, 0], [0.2, -0.2, 0], [0.2, 0.2, 0]]
    vertices = np.asarray(corners, float) + (0, 0, 5)
    faces = [[0, 2, 1], [0, 3, 2], [1, 5, 4], [1, 2, 5]]
    toward = strahl.Camera.mesh(vertices, faces)
    scene = strahl.Scene(ball, background=0)
    assert scene.render(4, 1, sampling="center", camera=toward).rgb[0, :, 0].tolist() == [0, 0, 1, 1]
    away = strahl.Camera.mesh(vertices, faces, reversed=True)
    assert scene.render(4, 1, sampling="center", camera=away).rgb.max() == 0
    square = np.array([[-1, -1, 5], [1, -1, 5], [1, 1, 5], [-1, 1, 5]], float)
    by_uv = strahl.Camera.mesh(square, [[0, 2, 1], [0, 3, 2]], uv=[[0, 0], [1, 0], [1, 1], [0, 1]], normals=[[0, 0, -1]] * 4)
    disc = scene.render(8, 8, sampling="center", camera=by_uv).rgb[..., 0]
    assert disc[0, 0] == 0 and disc[4, 4] == 1 and 0.6 < disc.mean() < 0.9
    with pytest.raises(ValueError, match="from 0 to 3"):
        strahl.Camera.mesh(square, [[0, 1, 4]])

    eye = strahl.Camera.perspective((1, 2, -4), angle=50)
    things = (GROUND, "sphere { 0, 0.8 pigment { rgb 0.7 } }", LAMP)
    look = "camera {{ location <1, 2, -4> look_at 0 right x * image_width / image_height angle 50 {} }}"
    sharp = strahl.parse(" ".join(things)).add(eye)
    lens = eye.focused(0.5, (0, 0, 0), samples=(4, 20), confidence=0.8, variance=0.001)
    assert sharp.render(16, 12, camera=lens).sha256 != sharp.render(16, 12).sha256
    assert sharp.render(16, 12, camera=lens).sha256 != sharp.render(16, 12, camera=eye.focused(0.5, (0, 0, 0), samples=20, bokeh=np.eye(3))).sha256
    assert sharp.render(16, 12, camera=eye.rippled(Normal("bumps", 0.5).scale(0.2))).sha256 != sharp.render(16, 12).sha256
    # The language's camera looks with a left-handed picture: its own, rippled and focused the same way.
    written = strahl.Camera.pov("#version 3.7;" + look.format("normal { bumps 0.5 scale 0.2 }"))
    plain = strahl.Camera.pov("#version 3.7;" + look.format("")).rippled(Normal("bumps", 0.5).scale(0.2))
    assert sharp.render(16, 12, camera=written).sha256 == sharp.render(16, 12, camera=plain).sha256
    focal = "aperture 0.5 focal_point 0 blur_samples 4, 20 confidence 0.8 variance 0.001"
    written = strahl.Camera.pov("#version 3.7;" + look.format(focal))
    plain = strahl.Camera.pov("#version 3.7;" + look.format("")).focused(0.5, (0, 0, 0), samples=(4, 20), confidence=0.8, variance=0.001)
    assert sharp.render(16, 12, camera=written).sha256 == sharp.render(16, 12, camera=plain).sha256
    for wrong, message in (({"bokeh": [[1, 2]]}, "bokeh must have"), ({"bokeh": [[0.0]]}, "bokeh must have a positive"), ({"confidence": 1.0}, "confidence"), ({"samples": 0}, "samples")):
        with pytest.raises(ValueError, match=message):
            eye.focused(0.5, (0, 0, 0), **wrong)  # type: ignore[arg-type]


def test_densities_are_arrays() -> None:
    values = np.random.default_rng(3).integers(0, 256, (4, 3, 2)).astype(np.uint8)
    square = strahl.mesh([[0, 0, 0.6], [1, 0, 0.6], [1, 1, 0.6], [0, 1, 0.6]], [[0, 1, 2], [0, 2, 3]])
    eye = strahl.Camera.orthographic((0.5, 0.5, -1), (0.5, 0.5, 0), height=1, aspect=1)
    glow = strahl.Finish(ambient=0, diffuse=0, emission=1)

    def seen(density: Pattern) -> Any:
        pigment = Pigment.map(density, [(0, (0, 0, 0)), (1, (1, 1, 1))])
        # The camera's x points to the left of the picture's, because it looks along z with right-handed coordinates.
        return strahl.Scene(square.material(Texture(pigment, finish=glow)), eye).render(2, 3, sampling="center").rgb[::-1, ::-1, 0]

    assert np.allclose(seen(Pattern.density(values)), values[2] / 255, atol=1e-6)
    same = Pattern.density(values / 255)
    assert np.allclose(seen(same), values[2] / 255, atol=1e-6)
    for other in ("trilinear", "tricubic"):
        assert not np.allclose(seen(Pattern.density(values, interpolation=other)), values[2] / 255)  # type: ignore[arg-type]
    for wrong, error in ((np.zeros((2, 2)), ValueError), (np.zeros((2, 2, 2), np.int64), TypeError), (np.full((1, 1, 1), 1.5), ValueError), (np.zeros((0, 1, 1)), ValueError)):
        with pytest.raises(error):
            Pattern.density(wrong)
    with pytest.raises(ValueError, match="interpolation"):
        Pattern.density(values, interpolation="linear")  # type: ignore[arg-type]


def test_images_are_arrays() -> None:
    pixels = np.random.default_rng(2).integers(0, 256, (7, 5, 3)).astype(np.uint8)
    square = strahl.mesh([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], [[0, 1, 2], [0, 2, 3]], uv=[[0, 0], [1, 0], [1, 1], [0, 1]])
    eye = strahl.Camera.orthographic((0.5, 0.5, -1), (0.5, 0.5, 0), height=1, aspect=1)
    glow = strahl.Finish(ambient=0, diffuse=0, emission=1)

    def seen(image: Pattern | Pigment) -> Any:
        pigment = image if isinstance(image, Pigment) else Pigment(image)
        # The camera's x points to the left of the picture's, because it looks along z with right-handed coordinates.
        return strahl.Scene(square.material(Texture(pigment, finish=glow)), eye).render(5, 7, sampling="center").rgb[:, ::-1]

    nearest = seen(Pattern.image(pixels, interpolation="nearest"))
    codes = pixels / 255
    linear = np.where(codes <= 0.04045, codes / 12.92, ((codes + 0.055) / 1.055) ** 2.4)
    assert np.allclose(nearest, linear, atol=1e-6)
    assert (seen(Pattern.image(linear, interpolation="nearest")) == seen(Pattern.image(linear.astype(np.float32), interpolation="nearest"))).all()
    assert np.allclose(seen(Pattern.image(pixels, interpolation="nearest", srgb=False)), codes, atol=1e-6)
    # Any layout and byte order, and one channel.
    assert (seen(Pattern.image(np.asfortranarray(pixels), interpolation="nearest")) == nearest).all()
    grey = (pixels[..., 0].astype(np.uint16) * 257).astype(">u2")
    assert np.allclose(seen(Pattern.image(grey, interpolation="nearest"))[..., 1], linear[..., 0], atol=1e-6)
    # Mesh coordinates show the picture as its plane does.
    assert np.allclose(seen(Pigment(Pattern.image(pixels, interpolation="nearest")).uv_mapped()), linear, atol=1e-6)
    # As a relief, as a number, and as the number of a texture.
    bumpy = strahl.Scene(square.material(Texture(1, normal=Normal(Pattern.image(pixels), 3))), strahl.point_light((0, 3, -3)), eye)
    flat = strahl.Scene(square.material(Texture(1)), strahl.point_light((0, 3, -3)), eye)
    assert bumpy.render(5, 7).sha256 != flat.render(5, 7).sha256
    grey = np.array([[0, 1], [1, 0]], np.uint8)
    numbers = Pattern.image(grey, interpolation="nearest", srgb=False)
    two = Texture.picture(numbers, [Texture((1, 0, 0), finish=glow), Texture((0, 0, 1), finish=glow)])
    picture = strahl.Scene(square.material(two), eye).render(2, 2, sampling="center").rgb[:, ::-1]
    assert picture.tolist() == [[[1, 0, 0], [0, 0, 1]], [[0, 0, 1], [1, 0, 0]]]
    for wrong, error in ((np.zeros((2, 2, 5)), ValueError), (np.zeros((2, 2), np.int64), TypeError), (np.full((2, 2), np.nan), ValueError), (np.zeros(0), ValueError)):
        with pytest.raises(error, match="pixels"):
            Pattern.image(wrong)


def test_textures_move_with_their_objects_and_alone() -> None:
    wood = Texture(Pigment.map("wood", TWO)).scale(0.3)
    ball = strahl.sphere(material=wood)
    turned = _scene(ball.rotate((1, 0, 0), 50), more=EYE + LAMP)
    assert _sha256(turned) != _sha256(_scene(ball, more=EYE + LAMP))
    # A ball is the same after a turn: only its texture turns.
    alone = _scene(strahl.sphere(material=wood.rotate((1, 0, 0), 50)), more=EYE + LAMP)
    assert np.abs(turned.render(24, 18).rgb - alone.render(24, 18).rgb).max() < 1e-5


def test_wrong_looks_are_refused() -> None:
    wrong: list[tuple[Callable[[], Any], str]] = [
        (lambda: Pattern("marbel"), "no pattern `marbel`"),  # type: ignore[arg-type]
        (lambda: Pattern.tiling(99), "no tiling 99"),
        (lambda: Pattern("bozo").turbulence(float("nan")), "amount must be finite"),
        (lambda: Pattern("bozo").turbulence(1, octaves=11), "octaves"),
        (lambda: Pattern.fractal(exterior=(7, 1)), "0 to 6"),
        (lambda: Pattern.fractal(10**9), "iterations"),
        (lambda: Pattern("bozo").repeat("w"), "axis"),  # type: ignore[arg-type]
        (lambda: Pattern("bozo").flatten((0, 0, 0)), "orientation"),
        (lambda: Pattern("bozo").wave("square"), "no wave"),  # type: ignore[arg-type]
        (lambda: Pigment(Pattern("bozo")), "images"),
        (lambda: Pigment.map("bozo", {}), "one at least"),
        (lambda: Pigment.map("bozo", [(1, 0), (0, 1)]), "ascend"),
        (lambda: Pigment.blocks("bozo", [0, 1]), "continuous"),
        (lambda: Pigment.average(0, 1, weights=[1]), "weights"),
        (lambda: Pigment((0, 0, 0, 0, float("inf"))), "finite"),
        (lambda: Interior(0), "positive"),
        (lambda: Fog(0.5, 0), "distance must be positive"),
        (lambda: Fog(0.5, 1, altitude=1, up=(0, 0, 0)), "up must not be zero"),
        (lambda: Rainbow((0, 0, 0), TWO), "direction must not be zero"),
        (lambda: strahl.terrain(x=(0, 1)), "together"),
        (lambda: strahl.terrain(x=(0, 0), z=(0, 1)), "extent"),
        (lambda: strahl.mandelbulb(99), "from 2 to 16"),
        (lambda: strahl.menger(level=21), "from 0 to 20"),
        (lambda: strahl.subdivision(CUBE, SIDES, "butterfly"), "no scheme `butterfly`"),
        (lambda: strahl.subdivision(CUBE, [[0, 1, 9]]), "9"),
        (lambda: strahl.subdivision(CUBE, SIDES, creases=[([0], 1)]), "two points"),
        (lambda: strahl.subdivision(CUBE, SIDES, creases=[([0, 7], 1)]), "edge"),
        (lambda: strahl.subdivision(CUBE, SIDES, uv=[(0, 0)]), "texture coordinates"),
        (lambda: strahl.julia((0, 0, 0)), "4 numbers"),
        (lambda: strahl.julia((0, 0, 0, 0), "ln"), "no function `ln`"),
    ]
    for make, message in wrong:
        with pytest.raises(ValueError, match=message):
            make()
    with pytest.raises(TypeError, match="expected a Normal"):
        Texture(1, normal=Pattern("bozo"))  # type: ignore[arg-type]
    with pytest.raises(TypeError, match="not a Normal"):
        strahl.sphere(material=Normal("bumps"))  # type: ignore[arg-type]
    with pytest.raises(ValueError, match="material: 'redd' is no colour"):
        strahl.sphere(material="redd")
    with pytest.raises(ValueError, match="size must be from 1 to 1024"):
        strahl.area_light((0, 9, 0), (1, 0, 0), (0, 0, 1), size=(2, 1025))
    with pytest.raises(TypeError, match="light_group"):
        strahl.union(strahl.sphere(), strahl.point_light((0, 9, 0)))  # type: ignore[arg-type]
    with pytest.raises(TypeError, match="light group consists"):
        strahl.light_group(strahl.Camera.perspective((0, 0, 1)))  # type: ignore[arg-type]


def test_errors_of_formulas_show_the_formula() -> None:
    with pytest.raises(strahl.SceneError, match=r"x\*x \+ nowhere\n *\| *\^") as caught:
        strahl.implicit("x*x + nowhere")
    assert caught.value.diagnostics[0].file == "formula"
    with pytest.raises(strahl.SceneError, match="expected a number"):
        Pattern.function("x +")


def test_shapes_of_formulas_remember_the_line_of_the_program() -> None:
    assert re.fullmatch(r".*test_builder.py:\d+", strahl.implicit("x*x + y*y + z*z - 0.5").source or "")


def test_quick_colors_are_those_of_the_language() -> None:
    built = _scene(strahl.sphere(material=Pigment.map(Pattern("bozo"), TWO).quick((0.2, 0.9, 0.4)).scale(0.3)))
    written = strahl.parse(
        f"#version 3.7; global_settings {{ assumed_gamma 1 }} {LAMP} {EYE} sphere {{ 0, 1 pigment {{ bozo {MAP} quick_color rgb <0.2, 0.9, 0.4> scale 0.3 }} }}"
    )
    full = _sha256(built)
    assert full == _sha256(written) and built.quality == 9
    built.quality = written.quality = 5
    assert full != _sha256(built) == _sha256(written)
    with pytest.raises(ValueError, match="at most 9"):
        built.quality = 10



def _variants(path: str, start: str) -> set[str]:
    """The variants of an enum of the Rust sources, or the rows of the table of shapes."""
    text = (ROOT / path).read_text()
    body = text[text.index(start) + len(start) :]
    return set(re.findall(r"(?m)^    ([A-Z]\w+)", body[: re.search(r"(?m)^}", body).start()]))  # type: ignore[union-attr]


SAME: dict[tuple[str, str], dict[str, Any]] = {
    ("crates/strahl-geometry/src/shape.rs", "\nshapes! {\n"): {
        "Sphere": strahl.sphere, "Plane": strahl.plane, "Cuboid": strahl.box, "Disc": strahl.disc, "Cylinder": strahl.cylinder, "Cone": strahl.cone,
        "Torus": strahl.torus, "Ovus": strahl.ovus, "Lemon": strahl.lemon, "Quadric": strahl.quadric, "Prism": strahl.prism, "Glyph": strahl.text,
        "Lathe": strahl.lathe, "Sor": strahl.sor, "SphereSweep": strahl.sphere_sweep, "Polynomial": strahl.polynomial, "Blob": strahl.blob,
        "Superellipsoid": strahl.superellipsoid, "Isosurface": strahl.implicit, "GridIsosurface": strahl.isosurface, "HeightField": strahl.height_field,
        "Parametric": strahl.parametric, "BicubicPatch": strahl.bicubic_patch, "Nurbs": strahl.nurbs, "NurbsBrep": strahl.brep, "Subdivision": strahl.subdivision, "Julia": strahl.julia,
        "Mandelbulb": strahl.mandelbulb, "Menger": strahl.menger, "Terrain": strahl.terrain, "Triangle": strahl.triangle, "SmoothTriangle": strahl.mesh,
        "Polygon": strahl.polygon, "TriangleMesh": strahl.mesh, "Brep": strahl.mesh, "Csg": strahl.difference, "Bounded": Object.bounded_by,
        "Custom": None,  # a shape of a Rust program
    },
    ("crates/strahl-shade/src/light.rs", "pub enum LightKind {\n"): {
        "Point": strahl.point_light, "Directional": strahl.directional_light, "Spot": strahl.spot_light, "Parallel": strahl.parallel_light, "Beam": strahl.beam_light,
    },
    ("crates/strahl-scene/src/projection.rs", "pub enum Projection {\n"): {
        "Perspective": strahl.Camera.perspective, "Orthographic": strahl.Camera.orthographic, "Fisheye": strahl.Camera.fisheye, "UltraWideAngle": strahl.Camera.ultra_wide_angle,
        "Omnimax": strahl.Camera.omnimax, "Panoramic": strahl.Camera.panoramic, "Spherical": strahl.Camera.spherical, "Cylinder": strahl.Camera.cylinder,
        "Mesh": strahl.Camera.mesh,
    },
    ("crates/strahl-scene/src/object.rs", "pub enum CsgOp {\n"): {
        "Union": strahl.union, "Merge": strahl.merge, "Intersection": strahl.intersection, "Difference": strahl.difference, "Inverse": Object.__neg__,
        "Clip": Object.clipped_by, "Bound": Object.bounded_by, "LightGroup": strahl.light_group,
    },
    ("crates/strahl-scene/src/background.rs", "pub enum Background {\n"): {
        "Solid": Background.solid, "Gradient": Background.gradient, "Sky": Background.sky,
    },
    ("crates/strahl-shade/src/patterns/warp.rs", "pub enum Warp {\n"): {
        "Transform": Pattern.transform, "Repeat": Pattern.repeat, "BlackHole": Pattern.black_hole, "Turbulence": Pattern.stir, "Mapping": Pattern.wrap, "Cubic": Pattern.wrap, "Planar": Pattern.flatten,
    },
    ("crates/strahl-shade/src/texture.rs", "pub enum Texture {\n"): {
        "Plain": Texture, "Layered": Texture.layered, "Map": Texture.map, "Blocks": Texture.blocks, "Average": Texture.average, "MaterialMap": Texture.picture,
        "Shared": None,  # made for blobs by the language alone
        "Transformed": Texture.transform, "UvMapped": Texture.uv_mapped,
    },
    ("crates/strahl-shade/src/pigment.rs", "pub enum Pigment {\n"): {
        "Solid": Pigment, "ColorMap": Pigment.map, "PigmentMap": Pigment.map, "Blocks": Pigment.blocks, "Image": Pattern.image, "Average": Pigment.average,
        "UvMapped": Pigment.uv_mapped, "Quick": Pigment.quick,
    },
    ("crates/strahl-shade/src/normal.rs", "pub enum NormalKind {\n"): {
        "Facets": Normal.facets,
        **{name: Normal for name in ("Bumps", "Dents", "Wrinkles", "Ripples", "Waves", "Quilted", "Height", "BumpMap", "Map", "Blocks", "Average")},
    },
    ("crates/strahl-shade/src/patterns/mod.rs", "pub enum Pattern {\n"): {
        **{name: Pattern for name in (
            "Aoi", "Boxed", "Bozo", "Cells", "Checker", "Cubic", "Cylindrical", "Dents", "Granite", "Hexagon", "Leopard", "Marble", "Onion", "Planar", "Radial",
            "Spherical", "Square", "Triangular", "Wood", "Wrinkles",
        )},
        "Agate": Pattern.agate, "Brick": Pattern.brick, "Crackle": Pattern.crackle, "Density": Pattern.density, "Fractal": Pattern.fractal, "Function": Pattern.function,
        "Gradient": Pattern.gradient, "Image": Pattern.image, "Object": Pattern.object, "Pigment": Pattern.pigment, "Quilted": Pattern.quilted,
        "Ripples": Pattern.ripples, "Slope": Pattern.slope, "Spiral1": Pattern.spiral, "Spiral2": Pattern.spiral, "Tiling": Pattern.tiling, "Waves": Pattern.waves,
    },
}  # fmt: skip


@pytest.mark.parametrize("where", SAME, ids=lambda where: where[0].rpartition("/")[2] + " " + where[1].strip())
def test_the_builder_has_all_that_the_rust_builder_has(where: tuple[str, str]) -> None:
    """A new variant fails here until Python has it."""
    assert _variants(*where) == set(SAME[where])
