"""Whatever is handed over: an exception that says what is wrong, or an answer; never a panic, and never the end of the process."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

import strahl

NAN, INF = np.nan, np.inf
TETRAHEDRON = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], float)
FACES = np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])
NET = np.stack([*np.meshgrid(np.arange(4.0), np.arange(4.0)), np.zeros((4, 4))], axis=-1)


def _values(shape: tuple[int, ...]) -> list[Any]:
    """Things in the place of an array of this shape."""
    good = np.random.default_rng(3).uniform(0.1, 0.9, shape)
    strided = np.zeros((2 * shape[0], *shape[1:]))[::2]
    readonly = np.broadcast_to(good[:1], shape)
    return [
        np.full(shape, NAN),
        np.full(shape, INF),
        np.full(shape, 1e300),
        np.full(shape, 1e-320),
        np.full(shape, -1.0),
        np.zeros(shape),
        good[:0],
        good[:1],
        good[0],
        good[..., :-1],
        good[np.newaxis],
        good.ravel(),
        np.zeros(()),
        strided,
        readonly,
        np.asfortranarray(good),
        good.astype(">f8"),
        good.astype("<f2"),
        good.astype(np.longdouble),
        good.astype(np.uint64),
        good.astype(np.int8),
        good > 0.5,
        good.astype(complex),
        good.astype(object),
        good.astype(str),
        good.astype("datetime64[s]"),
        np.ma.masked_array(good, good > 0.5),
        np.matrix([[1.0, 2.0], [3.0, 4.0]]) if len(shape) == 2 else None,
        np.zeros(shape[0], [("x", float), ("y", float)]),
        good.tolist(),
        [[1, 2, 3], [4, 5]],
        [[]],
        [],
        {},
        {"a": 1},
        "text",
        b"bytes",
        None,
        7,
        -(10**30),
        True,
        object(),
        iter([1, 2, 3]),
        np.iinfo(np.int64).min,
        np.array([2**63], np.uint64),
    ]


BALL = strahl.sphere()
SCENE = strahl.Scene(BALL, strahl.point_light((4, 8, 6)))

MAKERS: dict[str, tuple[tuple[int, ...], Callable[[Any], Any]]] = {
    "vertices": ((4, 3), lambda a: strahl.mesh(a, FACES)),
    "faces": ((4, 3), lambda a: strahl.mesh(TETRAHEDRON, a)),
    "solid": ((4, 3), lambda a: strahl.mesh(a, FACES, solid=True)),
    "normals": ((4, 3), lambda a: strahl.mesh(TETRAHEDRON, FACES, normals=a)),
    "uv": ((4, 2), lambda a: strahl.mesh(TETRAHEDRON, FACES, uv=a)),
    "centers": ((5, 3), lambda a: strahl.spheres(a, 0.5)),
    "radii": ((4,), lambda a: strahl.spheres(TETRAHEDRON, a)),
    "colors": ((4, 3), lambda a: strahl.spheres(TETRAHEDRON, 0.3, a)),
    "heights": ((5, 6), strahl.height_field),
    "samples": ((3, 4, 5), lambda a: strahl.isosurface(a, 0.5)),
    "spacing": ((3,), lambda a: strahl.isosurface(np.eye(3)[np.newaxis].repeat(2, 0), 0.5, spacing=a)),
    "polygon": ((5, 3), strahl.polygon),
    "holes": ((5, 3), lambda a: strahl.polygon([[-9, -9, 0], [9, -9, 0], [9, 9, 0], [-9, 9, 0]], holes=[a])),
    "blob": ((3, 5), strahl.blob),
    "capsules": ((3, 8), lambda a: strahl.blob((), a)),
    "prism": ((5, 2), strahl.prism),
    "curved prism": ((7, 2), lambda a: strahl.prism(a, curve="cubic")),
    "lathe": ((5, 2), strahl.lathe),
    "sor": ((5, 2), strahl.sor),
    "sweep": ((5, 3), lambda a: strahl.sphere_sweep(a, 0.1)),
    "sweep radii": ((4,), lambda a: strahl.sphere_sweep(TETRAHEDRON, a)),
    "patch": ((4, 4, 3), strahl.bicubic_patch),
    "patch weights": ((4, 4), lambda a: strahl.bicubic_patch(NET, weights=a)),
    "nurbs": ((5, 6, 3), strahl.nurbs),
    "nurbs weights": ((4, 4), lambda a: strahl.nurbs(NET, weights=a)),
    "knots": ((8,), lambda a: strahl.nurbs(NET, knots=(a, a))),
    "trim": ((5, 2), lambda a: strahl.nurbs(NET, trim=[a])),
    "curve": ((5, 2), lambda a: strahl.nurbs(NET, holes=[[strahl.NurbsCurve(a, 2)]])),
    "quadric": ((10,), strahl.quadric),
    "polynomial": ((3,), lambda a: strahl.polynomial({(1, 0, 0): 1, (0, 0, 0): a})),
    "exponents": ((3,), lambda a: strahl.polynomial({tuple(a): 1.0})),
    "matrix": ((3, 4), BALL.transform),
    "matrices": ((2, 4, 4), BALL.instances),
    "center": ((3,), strahl.sphere),
    "radius": ((3,), lambda a: strahl.sphere(radius=a)),
    "normal": ((3,), lambda a: strahl.plane(normal=a)),
    "color": ((3,), strahl.Material),
    "axis": ((3,), lambda a: BALL.rotate(a, 30)),
    "factors": ((3,), BALL.scale),
    "light": ((3,), strahl.point_light),
    "area light": ((3,), lambda a: strahl.area_light((0, 9, 0), a, (0, 0, 1))),
    "eye": ((3,), strahl.Camera.perspective),
    "angle": ((3,), lambda a: strahl.Camera.fisheye((0, 0, 9), angle=a)),
    "background": ((3,), strahl.Background.solid),
    "sky": ((3,), strahl.Background.sky),
    "pixels": ((4, 5), lambda a: strahl.Pigment(strahl.Pattern.image(a))),
    "relief": ((4, 5, 3), lambda a: strahl.Texture(1, normal=strahl.Normal(strahl.Pattern.image(a)))),
    "pigment": ((5,), strahl.Pigment),
    "entries": ((2, 2), lambda a: strahl.Pigment.map("bozo", a)),
    "weights": ((2,), lambda a: strahl.Pigment.average(0, 1, weights=a)),
    "turbulence": ((3,), lambda a: strahl.Pigment.map(strahl.Pattern("marble").turbulence(a), {0: 0, 1: 1})),
    "brick": ((3,), lambda a: strahl.Pigment.blocks(strahl.Pattern.brick(a), [0, 1])),
    "warp": ((3,), lambda a: strahl.Pigment.map(strahl.Pattern("bozo").black_hole(a, 1).repeat("x", 1, offset=a).flatten(a), {0: 0, 1: 1})),
    "moved pattern": ((4, 4), lambda a: strahl.Pigment.map(strahl.Pattern("granite").transform(a), {0: 0, 1: 1})),
    "finish": ((3,), lambda a: strahl.Texture(1, finish=strahl.Finish(ambient=a, reflection=a, irid=a))),
    "interior": ((3,), lambda a: strahl.Material.glass().with_interior(strahl.Interior(fade_color=a, fade_power=2, fade_distance=1))),
    "fog": ((3,), lambda a: strahl.Fog(a, 1, turbulence=a)),
    "ground fog": ((3,), lambda a: strahl.Fog(1, 1, altitude=1, up=a)),
    "rainbow": ((3,), lambda a: strahl.Rainbow(a, {0: 0, 1: a})),
    "mesh camera": ((4, 3), lambda a: strahl.Camera.mesh(a, FACES, uv=NET[0, :, :2])),
    "bokeh": ((3, 3), lambda a: strahl.Camera.perspective((0, 0, 5)).focused(1, (0, 0, 0), bokeh=a, samples=4)),
    "julia": ((4,), lambda a: strahl.julia(a, max_iteration=3)),
    "terrain": ((2,), lambda a: strahl.terrain(x=a, z=a, octaves=2)),
    "cage": ((4, 3), lambda a: strahl.subdivision(a, [[0, 1, 2], [0, 2, 3], [0, 3, 1], [1, 3, 2]])),
    "corners of a cage": ((12, 2), lambda a: strahl.subdivision(NET[0, :, :3], [[0, 1, 2], [0, 2, 3], [0, 3, 1], [1, 3, 2]], uv=a)),
    "sponge": ((3,), lambda a: strahl.menger(a, (2, 2, 2), 2)),
    "formula": ((3,), lambda a: strahl.implicit("x*x + y*y + z - A", declare={"A": a})),
    "container": ((3,), lambda a: strahl.implicit("x*x + y*y + z", a)),
    "moved light": ((3,), lambda a: strahl.point_light((4, 8, 6)).translate(a)),
    "origins": ((6, 3), lambda a: SCENE.intersect(a, (0, 0, 1)).normal),
    "directions": ((6, 3), lambda a: SCENE.intersect((0, 0, 9), a).position),
    "both": ((6, 3), lambda a: SCENE.occluded(a, a)),
    "points": ((6, 3), SCENE.inside),
    "pixel": ((2,), lambda a: SCENE.explain(a, a, 8, 6)),
    "size": ((2,), lambda a: SCENE.render(a, a, region=(0, 0, 1, 1))),
    "region": ((4,), lambda a: SCENE.render(8, 6, region=a)),
    "number": ((2,), SCENE.object_name),
    "declare": ((4,), lambda a: strahl.parse("sphere { 0, 1 }", declare={"A": a})),
    "clock": ((4,), lambda a: strahl.parse("sphere { 0, 1 }", clock=a)),
    "text": ((4,), strahl.parse),
}

KNOWN = (ValueError, TypeError, IndexError, MemoryError)


@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("name", MAKERS)
def test_anything_is_answered_or_refused(name: str) -> None:
    shape, make = MAKERS[name]
    for value in _values(shape):
        try:
            made = make(value)
            if isinstance(made, strahl.Object):
                scene = strahl.Scene(made, strahl.point_light((4, 8, 6)))
                scene.intersect((0.3, 0.4, 9), [(0, 0, -1), (0.1, 0.2, -1)]).normal
                scene.render(4, 3, sampling="center")
            elif isinstance(made, (strahl.Light, strahl.Camera, strahl.Background)):
                strahl.Scene(BALL, made).render(4, 3, sampling="center")
            elif isinstance(made, (strahl.Fog, strahl.Rainbow)):
                SCENE.copy().add(made).render(4, 3, sampling="center")
            elif isinstance(made, (strahl.Material, strahl.Texture, strahl.Pigment)):
                strahl.Scene(BALL.material(made)).render(4, 3, sampling="center")
        except (*KNOWN, strahl.SceneError) as error:
            assert str(error), f"an error without a text for {value!r}"
        except BaseException as error:
            raise AssertionError(f"{name} = {value!r}: {type(error).__name__}: {error}") from error
