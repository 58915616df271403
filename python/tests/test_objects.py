"""Objects, materials, lights and cameras."""

from __future__ import annotations

import sys
import time
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

import strahl

AXIS_ALIGNED = [
    (strahl.sphere((1, 2, 3), 2), (1, 2, 3)),
    (strahl.box((-1, -2, -3), (1, 2, 3)), (0, 0, 0)),
    (strahl.cylinder((0, -1, 0), (0, 1, 0), 0.5), (0, 0, 0)),
    (strahl.cone((0, -1, 0), 1, (0, 1, 0), 0.2), (0, 0, 0)),
    (strahl.torus(2, 0.5), (2, 0, 0)),
    (strahl.ovus(1, 0.5), (0, 0.5, 0)),
    (strahl.lemon((0, -1, 0), 0.5, (0, 1, 0), 0.5, 3), (0, 0, 0)),
    (strahl.quadric([1, 1, 1, 0, 0, 0, 0, 0, 0, -1]) & strahl.sphere(radius=3), (0, 0, 0)),
    (strahl.superellipsoid(0.5, 0.5), (0, 0, 0)),
    (strahl.blob([[0, 0, 0, 2, 1]], [[0, 0, 0, 0, 2, 0, 1, 1]]), (0, 0, 0)),
    (strahl.prism([[0, 0], [1, 0], [1, 1], [0, 0]]), (0.7, 0.5, 0.3)),
    (strahl.lathe([[0, 0], [1, 0], [1, 1], [0, 1]]), (0.5, 0.5, 0.1)),
    (strahl.sor([[0.5, -0.5], [0.5, 0], [0.5, 1], [0.5, 1.5]]), (0, 0.5, 0)),
    (strahl.sphere_sweep([[0, 0, 0], [0, 2, 0]], 0.5, curve="linear"), (0, 1, 0)),
    (strahl.polynomial({(2, 0, 0): 1, (0, 2, 0): 1, (0, 0, 2): 1, (0, 0, 0): -1}), (0, 0, 0)),
    (strahl.pov("isosurface { function { x*x + y*y + z*z - 1 } contained_by { sphere { 0, 2 } } }"), (0, 0, 0)),
]


@pytest.mark.parametrize(("solid", "point"), AXIS_ALIGNED, ids=lambda thing: getattr(thing, "kind", ""))
def test_solids_have_an_inside_and_rays_hit_them(solid: strahl.Object, point: tuple[float, float, float]) -> None:
    scene = strahl.Scene(solid)
    assert scene.inside([point, (50, 60, 70)]).tolist() == [0, -1]
    start = np.array([3.0, 9.0, 20.0])
    assert scene.intersect(start, np.array(point) - start, t_max=1).hit


def test_surfaces_are_hit() -> None:
    patch = np.zeros((4, 4, 3))
    patch[..., 0], patch[..., 2] = np.meshgrid(np.linspace(-1, 1, 4), np.linspace(-1, 1, 4))
    for surface in (
        strahl.plane(),
        strahl.disc(),
        strahl.polygon([[-1, 0, -1], [1, 0, -1], [1, 0, 1], [-1, 0, 1]]),
        strahl.triangle((-1, 0, -1), (1, 0, -1), (0, 0, 2)),
        strahl.bicubic_patch(patch),
        strahl.height_field([[0, 0], [0, 0]], x=(-1, 1), z=(-1, 1)),
    ):
        hit = strahl.Scene(surface).intersect((0.1, 3, 0.2), (0, -1, 0))
        assert float(hit.t) == pytest.approx(3, abs=1e-9), surface
        assert abs(hit.normal[1]) == pytest.approx(1)
    assert strahl.disc(hole=0.5).kind == "disc"
    assert not strahl.Scene(strahl.disc(hole=0.5)).intersect((0.1, 3, 0.2), (0, -1, 0)).hit


def _ring() -> tuple[np.ndarray[Any, Any], np.ndarray[Any, Any], list[float]]:
    """The circle of radius 1 in the plane of x and y: 9 control points, weights and knots of degree 2."""
    # The last point is the first one, to the last bit.
    angles = np.arange(9) % 8 * np.pi / 4
    weights = np.where(np.arange(9) % 2, 0.5**0.5, 1.0)
    points = np.stack([np.cos(angles), np.sin(angles)], axis=1) / weights[:, np.newaxis]
    return points, weights, [0, 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 4]


def test_nurbs_are_exact_and_can_be_solids() -> None:
    ring, ring_weights, ring_knots = _ring()
    # A half circle from the south pole to the north pole, turned about z.
    half = np.array([[0, -1], [1, -1], [1, 0], [1, 1], [0, 1]])
    half_weights = np.array([1, 0.5**0.5, 1, 0.5**0.5, 1])
    net = np.empty((5, 9, 3))
    net[..., :2] = half[:, np.newaxis, :1] * ring
    net[..., 2] = half[:, 1:]
    weights = np.outer(half_weights, ring_weights)
    knots = (ring_knots, [0, 0, 0, 1, 1, 2, 2, 2])
    ball = strahl.nurbs(net, 2, weights=weights, knots=knots, name="ball")
    scene = strahl.Scene(ball - strahl.box((0, 0, 0), (2, 2, 2)))
    directions = np.random.default_rng(6).normal(size=(400, 3))
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    cut = (directions > 0).all(axis=1)
    hits = scene.intersect(directions * 5, -directions)
    assert np.abs(hits.t[~cut] - 4).max() < 1e-12 and (hits.t[cut] > 4.4).all() and cut.sum() > 20
    np.testing.assert_allclose(hits.normal[~cut], directions[~cut], atol=1e-9)
    assert scene.inside([[-0.5, -0.5, -0.5], [0.3, 0.3, 0.3], [2, 0, 0]]).tolist() == [0, -1, -1]


def test_nurbs_are_trimmed() -> None:
    x, y = np.meshgrid(np.linspace(0, 3, 4), np.linspace(0, 6, 4))
    net = np.stack([x, y, 0 * x], axis=-1)
    square = [[0.25, 0.25], [0.75, 0.25], [0.75, 0.75], [0.25, 0.75]]
    ring, ring_weights, ring_knots = _ring()
    circle = strahl.NurbsCurve(0.5 + 0.2 * ring, 2, weights=ring_weights, knots=ring_knots)
    corners = [strahl.NurbsCurve([a, b]) for a, b in zip(square, square[1:] + square[:1])]
    u, v = np.random.default_rng(8).uniform(size=(2, 2000))
    in_square = (abs(u - 0.5) < 0.25) & (abs(v - 0.5) < 0.25)
    in_circle = (u - 0.5) ** 2 + (v - 0.5) ** 2 < 0.04
    for surface, expected in (
        (strahl.nurbs(net), np.full(2000, True)),
        (strahl.nurbs(net, (3, 1), trim=[np.array(square)]), in_square),
        (strahl.nurbs(net, holes=[corners]), ~in_square),
        (strahl.nurbs(net, trim=[square], holes=[circle]), in_square & ~in_circle),
        (strahl.nurbs(net, holes=[[circle]]), ~in_circle),
    ):
        # The rows of a surface of degree 1 along v have other knots: 0, 1, 2, 3.
        scale = 3 if surface.kind == "nurbs" and expected is in_square else 1
        origins = np.stack([3 * u, 6 * v / scale, 0 * u + 5], axis=1)
        assert np.array_equal(strahl.Scene(surface).intersect(origins, (0, 0, -1)).hit, expected)
    for wrong, message in (
        (lambda: strahl.nurbs(net[:3]), "degree|control points"),
        (lambda: strahl.nurbs(net, 10), "degree must be from 1 to 9"),
        (lambda: strahl.nurbs(net, weights=np.ones((4, 3))), r"weights must have the shape \(4, 4\)"),
        (lambda: strahl.nurbs(net, weights=np.zeros((4, 4))), "weight"),
        (lambda: strahl.nurbs(net, knots=([0, 1], [0, 1])), "knots|control points"),
        (lambda: strahl.nurbs(net, trim=[corners[:2]]), "closed"),
        (lambda: strahl.nurbs(net, trim=[[]]), "corners"),
    ):
        with pytest.raises(ValueError, match=message):
            wrong()


def test_patches_can_be_rational() -> None:
    # A quarter of a cylinder: the weights of a quarter circle of degree 2, raised to 3, times a line.
    half = 0.5**0.5
    arc = np.array([[1, 0], [1 + 2 * half, 2 * half], [2 * half, 1 + 2 * half], [0, 1]])
    weights = np.array([1, (1 + 2 * half) / 3, (1 + 2 * half) / 3, 1])
    arc[1:3] /= 1 + 2 * half
    net = np.empty((4, 4, 3))
    net[..., :2] = arc
    net[..., 2] = np.arange(4)[:, np.newaxis]
    angles = np.linspace(0.1, 1.4, 30)
    around = np.stack([np.cos(angles), np.sin(angles), 0 * angles], axis=1)
    scene = strahl.Scene(strahl.bicubic_patch(net, weights=np.tile(weights, (4, 1))))
    hits = scene.intersect(3 * around + (0, 0, 1.5), -around)
    np.testing.assert_allclose(hits.t, 2, atol=1e-12)
    with pytest.raises(ValueError, match="weights must have the shape"):
        strahl.bicubic_patch(net, weights=weights)


def test_solids_combine() -> None:
    a, b = strahl.sphere((0, 0, 0), 1, name="a"), strahl.sphere((1, 0, 0), 1, name="b")
    points = [[-0.5, 0, 0], [0.5, 0, 0], [1.5, 0, 0], [5, 0, 0]]
    for solid, expected in (
        (a | b, [True, True, True, False]),
        (a & b, [False, True, False, False]),
        (a - b, [True, False, False, False]),
        (strahl.merge(a, b), [True, True, True, False]),
        (-a & strahl.box((-9, -9, -9), (9, 9, 9)), [False, False, True, True]),
    ):
        assert (strahl.Scene(solid).inside(points) >= 0).tolist() == expected, solid
    assert (a | b | a).parts == 3 and (a - b - a).parts == 3
    assert (a | (b | a)).parts == 2 and (a - (b - a)).parts == 2
    assert ((a | b).named("pair") | a).parts == 2
    assert "difference" in repr(a - b) and "'a'" in repr(a)
    with pytest.raises(TypeError):
        a | 3  # type: ignore[operator]
    with pytest.raises(TypeError, match="int"):
        strahl.union([3])  # type: ignore[list-item]


def test_deep_nesting_is_refused_and_lists_are_not() -> None:
    ball = strahl.sphere()
    nested = ball
    with pytest.raises(ValueError, match="nested"):
        for _ in range(2000):
            nested = strahl.union(nested, ball)
    many = strahl.union(ball.translate((i, 0, 0)) for i in range(2000))
    assert many.parts == 2000


def test_transformations_chain() -> None:
    box = strahl.box((0, 0, 0), (1, 1, 1)).scale((2, 1, 1)).rotate((0, 0, 1), 90).translate((5, 0, 0))
    bounds = strahl.Scene(box).bounds
    assert bounds is not None
    np.testing.assert_allclose(bounds, [[4, 0, 0], [5, 2, 1]], atol=1e-6)
    matrix = np.array([[0, -1, 0, 5], [2, 0, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]])
    same = strahl.Scene(strahl.box((0, 0, 0), (1, 1, 1)).transform(matrix)).bounds
    assert same is not None
    np.testing.assert_allclose(same, bounds, atol=1e-6)
    for wrong in (np.zeros((3, 4)), np.eye(3), np.ones((4, 4)), np.full((3, 4), np.nan)):
        with pytest.raises(ValueError):
            strahl.sphere().transform(wrong)
    with pytest.raises(ValueError):
        strahl.sphere().scale(0)
    with pytest.raises(ValueError, match="axis"):
        strahl.sphere().rotate((0, 0, 0), 5)


def test_wrong_numbers_are_named() -> None:
    nan = float("nan")
    for make, message in (
        (lambda: strahl.sphere((0, 0), 1), "center must have 3 numbers"),
        (lambda: strahl.sphere((0, 0, nan), 1), "center must be finite"),
        (lambda: strahl.sphere(radius=nan), "radius"),
        (lambda: strahl.torus(1, -1), "minor radius"),
        (lambda: strahl.plane(normal=(0, 0, 0)), "plane is degenerate"),
        (lambda: strahl.quadric([1, 2]), "10 coefficients"),
        (lambda: strahl.prism([[0, 0], [1, 0]], curve="round"), "no spline"),
        (lambda: strahl.mesh([[0, 0, 0]], [[0, 0, 0], [0, 1, 2]]), "row 1 has the vertex 1"),
        (lambda: strahl.mesh(np.zeros((3, 3), np.float32), [[0, -1, 2]]), "row 0 has the vertex -1"),
        (lambda: strahl.mesh(np.zeros((3, 3)), np.array([[0, 2**64 - 1, 2]], np.uint64)), "row 0 has the vertex"),
        (lambda: strahl.mesh(np.zeros((3, 3)), np.empty((0, 3), int)), "no triangles"),
        (lambda: strahl.mesh(np.zeros((3, 2)), [[0, 1, 2]]), r"\(n, 3\)"),
        (lambda: strahl.mesh([[0, 0, 0], [0, nan, 0], [1, 1, 1]], [[0, 1, 2]]), "vertices: row 1 is not finite"),
        (lambda: strahl.mesh(np.array([[0, 0, 0], [np.inf, 0, 0]], np.float32), [[0, 1, 1]]), "vertices: row 1 is not finite"),
        (lambda: strahl.mesh(np.eye(3), [[0, 1, 2]], normals=np.zeros((2, 3))), "as many rows as vertices"),
        (lambda: strahl.mesh(np.eye(3), [[0, 1, 2]], solid=True), "not closed"),
        (lambda: strahl.sphere().instances(np.zeros((2, 3))), r"\(n, 3, 4\)"),
        (lambda: strahl.sphere().instances([np.eye(4), np.diag([1, 1, 0, 1])]), "number 1"),
        (lambda: strahl.spheres([[0, 0, 0]], [1, 2]), r"\(1,\)"),
        (lambda: strahl.spheres([[0, 0, 0]], [float("inf")]), "sphere 0"),
        (lambda: strahl.Material("blue"), "#rrggbb"),
        (lambda: strahl.Material((1, 2)), "3 numbers"),
        (lambda: strahl.Material(ior=0), "ior"),
        (lambda: strahl.Material(model="cook"), "unknown shading model"),
        (lambda: strahl.Camera.perspective((0, 0, 0), (0, 0, 0), angle=0), "camera"),
        (lambda: strahl.spot_light((0, 0, 0), (0, 0, 0)), "direction"),
        (lambda: strahl.height_field([1, 2, 3]), "shape"),
    ):
        with pytest.raises(ValueError, match=message):
            make()
    with pytest.raises(TypeError, match="whole numbers"):
        strahl.mesh(np.zeros((3, 3)), [[0.0, 1.0, 2.0]])


def test_meshes_come_from_arrays() -> None:
    vertices = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]])
    faces = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]
    meshes = [
        strahl.mesh(vertices, faces),
        *(strahl.mesh(vertices.astype(np.float32), np.array(faces, kind)) for kind in "bBhHiIlLqQ"),
        strahl.mesh(vertices.astype(">f4"), np.asfortranarray(faces)[:, ::-1][:, ::-1]),
        strahl.mesh(np.asfortranarray(vertices), np.array(faces, np.int64)),
        strahl.from_trimesh(SimpleNamespace(vertices=vertices, faces=np.array(faces))),
    ]
    films = {strahl.Scene(mesh).render(16, 16).sha256 for mesh in meshes}
    assert len(films) == 1
    smooth = strahl.mesh(vertices, faces, normals=vertices - 0.25, uv=vertices[:, :2])
    hit = strahl.Scene(smooth).intersect((5, 5, 5), (-1, -1, -1) / np.sqrt(3))
    assert hit.hit and hit.normal == pytest.approx([3**-0.5] * 3)
    with pytest.raises(TypeError, match="no faces"):
        strahl.from_trimesh(SimpleNamespace(vertices=vertices))


def test_closed_meshes_are_solids() -> None:
    vertices = np.array([[0, 0, 0], [3, 0, 0], [0, 3, 0], [0, 0, 3]], np.float32)
    faces = np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]], np.uint32)
    drilled = strahl.mesh(vertices, faces, solid=True) - strahl.sphere((0.5, 0.5, 0.5), 0.3)
    assert strahl.Scene(drilled).inside([[0.5, 0.5, 0.5], [0.1, 0.1, 0.1], [2, 2, 2]]).tolist() == [-1, 0, -1]


def test_a_mesh_owns_its_numbers() -> None:
    vertices = np.array([[-1, 0, -1], [1, 0, -1], [0, 0, 2]], np.float32)
    faces = np.array([[0, 1, 2]], np.uint32)
    scene = strahl.Scene(strahl.mesh(vertices, faces))
    vertices[:], faces[:] = np.nan, 77
    assert float(scene.intersect((0, 3, 0), (0, -1, 0)).t) == 3


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="reads /proc")
def test_a_mesh_is_copied_once() -> None:
    # Each array is larger than what allocators keep for later.
    count = 4_000_000
    vertices = np.zeros((count, 3), np.float32)
    vertices[:, 0] = np.arange(count)
    faces = np.stack([np.arange(count)] * 3, axis=1).astype(np.uint32)
    size = vertices.nbytes + faces.nbytes
    _peak_bytes()
    before = _peak_bytes()
    kept = strahl.mesh(vertices, faces)
    assert 0.9 * size < _peak_bytes() - before < 1.2 * size
    assert kept.kind == "mesh"


def _peak_bytes() -> int:
    """The most memory that this process has had since this function was called last."""
    status = Path("/proc/self/status").read_text()
    peak = int(next(line for line in status.splitlines() if line.startswith("VmHWM:")).split()[1])
    try:
        Path("/proc/self/clear_refs").write_text("5")
    except OSError as error:
        pytest.skip(f"the peak cannot be reset: {error}")
    return peak * 1024


def test_instances_share_an_object() -> None:
    generator = np.random.default_rng(5)
    places = np.tile(np.eye(4), (50, 1, 1))
    places[:, :3, 3] = generator.uniform(-20, 20, (50, 3))
    thing = strahl.sphere(radius=0.5) | strahl.box((1, 0, 0), (2, 1, 1))
    copies = strahl.union(thing.transform(place) for place in places)
    shared = thing.instances(places)
    camera = strahl.Camera.perspective((0, 0, 60))
    lights = strahl.directional_light((-1, -2, -3))
    films = [strahl.Scene(objects, camera, lights).render(64, 48) for objects in (copies, shared)]
    np.testing.assert_allclose(films[0].rgb, films[1].rgb, atol=1e-6)
    assert films[0].rgb.max() > 0
    scene = strahl.Scene(shared)
    assert scene.stats()["primitives"] < strahl.Scene(copies).stats()["primitives"] and shared.parts == 50
    # Twice in a scene, and moved as a whole.
    twice = strahl.Scene(shared, shared.translate((100, 0, 0)), thing.instances(places[:1, :3]))
    assert twice.intersect(places[:, :3, 3] + (100, 0, 30), (0, 0, -1)).hit.all()


def test_a_million_spheres_take_less_than_a_second() -> None:
    generator = np.random.default_rng(1)
    centers = generator.uniform(-50, 50, (1_000_000, 3))
    colors = generator.integers(0, 4, (1_000_000, 3)) / 3
    start = time.perf_counter()
    atoms = strahl.spheres(centers, 0.3, colors)
    assert time.perf_counter() - start < 3
    assert atoms.parts == 1_000_000


def test_spheres_have_their_colours() -> None:
    scene = strahl.Scene(
        strahl.spheres([[-1, 0, 0], [1, 0, 0]], [0.5, 0.9], [[1, 0, 0], [0, 0, 1]]),
        strahl.directional_light((0, 0, -1)),
        strahl.Camera.orthographic((0, 0, 5), height=4),
    )
    film = scene.render(40, 40)
    assert film.rgb[20, 10, 0] > 0.5 > film.rgb[20, 10, 2]
    assert film.rgb[20, 30, 2] > 0.5 > film.rgb[20, 30, 0]
    atoms = SimpleNamespace(positions=np.zeros((2, 3)), numbers=np.array([1, 8]))
    assert strahl.from_ase(atoms, radii=[1, 2], colors=np.ones((2, 3))).parts == 2


def test_height_fields_have_their_heights() -> None:
    z, x = np.mgrid[0:5, 0:7]
    heights = 3.0 + 0.5 * x - 0.25 * z
    scene = strahl.Scene(strahl.height_field(heights, x=(0, 6), z=(0, 4)))
    places = np.array([[0.3, 10, 0.2], [5.5, 10, 3.25], [2, 10, 1]])
    hits = scene.intersect(places, (0, -1, 0))
    np.testing.assert_allclose(hits.position[:, 1], 3 + 0.5 * places[:, 0] - 0.25 * places[:, 2], atol=1e-3)


def test_isosurfaces_of_arrays_are_where_the_samples_say() -> None:
    x, y, z = np.mgrid[0:6, 0:7, 0:8]
    # Trilinear functions are interpolated exactly: x y z = 20 along the diagonal.
    product = strahl.Scene(strahl.isosurface((x * y * z).astype(float), 20))
    hits = product.intersect((0.5, 0.5, 0.5), [(1, 1, 1), (-1, 1, 1)])
    assert float(hits.t[0]) == pytest.approx(20 ** (1 / 3) - 0.5, abs=1e-13) and not hits.hit[1]
    assert hits.normal[0] == pytest.approx([-(3**-0.5)] * 3)

    axis = np.linspace(-2, 2, 41)
    distance = np.sqrt(sum(a**2 for a in np.meshgrid(axis, axis, axis, indexing="ij")))
    place = {"origin": (-2, -2, -2), "spacing": 0.1}
    ball = strahl.isosurface(distance, 1.5, inside="below", smooth=True, name="ball", **place)  # type: ignore[arg-type]
    scene = strahl.Scene(ball)
    directions = np.random.default_rng(2).normal(size=(500, 3))
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    hits = scene.intersect(-5 * directions, directions)
    # The error of interpolation is the square of the spacing over 8, times the second derivatives.
    assert np.abs(hits.t - 3.5).max() < 0.1**2 / 8 * 2 / 1.3
    assert (-hits.normal * directions).sum(axis=1).min() > 0.999
    assert scene.inside([[0, 0, 0], [1.4, 0, 0], [1.6, 0, 0]]).tolist() == [0, 0, -1]
    assert scene.explain(8, 8, 16, 16).root.hit is not None and scene.object_name(0) == 'grid_isosurface "ball"'

    # The walls close what reaches them, unless it is open.
    shell = {"inside": "above", "spacing": 0.1, "origin": (-2, -2, -2)}
    closed, opened = (strahl.Scene(strahl.isosurface(distance, 1.5, open=o, **shell)) for o in (False, True))  # type: ignore[arg-type]
    assert float(closed.intersect((0.03, 0.04, 9), (0, 0, -1)).t) == pytest.approx(7)
    assert float(opened.intersect((0.03, 0.04, 9), (0, 0, -1)).t) == pytest.approx(7.5, abs=0.01)


def test_isosurfaces_take_any_layout_and_refuse_what_is_none() -> None:
    values = np.random.default_rng(4).integers(0, 200, (5, 6, 7))
    films = set()
    for same in (values, values.astype(np.uint8), values.astype(np.float64), np.asfortranarray(values), values.tolist()):
        films.add(strahl.Scene(strahl.isosurface(same, 100), strahl.directional_light((-1, -2, -3))).render(24, 24).sha256)
    assert len(films) == 1
    nan = np.zeros((3, 3, 3))
    nan[1, 2, 0] = np.nan
    for arguments, message in (
        ((np.zeros((3, 3)), 1), "shape"),
        ((np.zeros((3, 3, 1)), 1), "shape"),
        ((nan, -1), "sample 15 is not finite"),
        ((np.zeros((3, 3, 3)), 1), "no sample is on the inner side"),
        ((np.zeros((3, 3, 3)), np.nan), "level"),
    ):
        with pytest.raises(ValueError, match=message):
            strahl.isosurface(*arguments)
    with pytest.raises(ValueError, match="spacing"):
        strahl.isosurface(values, 100, spacing=(1, 0, 1))
    with pytest.raises(ValueError, match="above"):
        strahl.isosurface(values, 100, inside="left")  # type: ignore[arg-type]


def test_texts_of_povray_are_objects_materials_cameras_and_skies() -> None:
    marble = strahl.Material.pov("texture { pigment { marble } }", name="marble")
    stones = strahl.Material.pov('#include "colors.inc"\n---\npigment { Red }')
    ball = strahl.pov("sphere { 0, 1 }", material=marble)
    scene = strahl.Scene(
        ball | strahl.sphere((2, 0, 0), material=stones),
        strahl.Camera.pov("camera { location -8 * z look_at 0 }"),
        strahl.Background.pov("sky_sphere { pigment { rgb <0, 0.5, 1> } }"),
        strahl.point_light((5, 5, -5)),
    )
    film = scene.render(32, 24)
    assert film.rgb[0, 0].tolist() == [0, 0.5, 1]
    explanation = scene.explain(16, 12, 32, 24)
    assert explanation.root.hit is not None and "marble" in explanation.root.hit.material
    assert strahl.pov("sphere { 0, 1 } box { 2, 3 }").parts == 2
    for wrong in (lambda: strahl.pov("#declare A = 1;"), lambda: strahl.Camera.pov("sphere { 0, 1 }")):
        with pytest.raises(ValueError):
            wrong()


def test_lights_and_cameras_make_different_pictures() -> None:
    things = [strahl.plane(), strahl.sphere((0, 1, 0))]
    lights = [
        strahl.point_light((4, 8, 6)),
        strahl.point_light((4, 8, 6), 50, falloff="inverse-square"),
        strahl.point_light((4, 8, 6), falloff=(10, 2)),
        strahl.directional_light((-1, -2, -1)),
        strahl.spot_light((4, 8, 6), (0, 0, 0), inner=5, outer=8),
        strahl.parallel_light((4, 8, 6), (0, 0, 0), shadows=False),
        strahl.beam_light((4, 8, 6), (0, 0, 0)),
        strahl.area_light((4, 8, 6), (3, 0, 0), (0, 3, 0), size=(5, 5)),
    ]
    camera = strahl.Camera.perspective((0, 3, 8), (0, 1, 0))
    films = [strahl.Scene(things, light, camera).render(48, 36).sha256 for light in lights]
    assert len(set(films)) == len(films)
    cameras = [
        camera,
        camera.focused(0.5, (0, 1, 1)),
        strahl.Camera.orthographic((0, 3, 8), (0, 1, 0), height=5),
        strahl.Camera.fisheye((0, 3, 8), (0, 1, 0)),
        strahl.Camera.spherical((0, 3, 8), (0, 1, 0)),
        strahl.Camera.cylinder((0, 3, 8), (0, 1, 0)),
        strahl.Camera.cylinder((0, 3, 8), (0, 1, 0), moving=True),
        strahl.Camera.cylinder((0, 3, 8), (0, 1, 0), upright=False),
        strahl.Camera.ultra_wide_angle((0, 3, 8), (0, 1, 0)),
        strahl.Camera.omnimax((0, 3, 8), (0, 1, 0)),
        strahl.Camera.panoramic((0, 3, 8), (0, 1, 0)),
    ]
    scene = strahl.Scene(things, lights[0], background=strahl.Background.gradient(0, "#88f"))
    films = [scene.render(48, 36, camera=camera).sha256 for camera in cameras]
    assert len(set(films)) == len(films)
    assert camera.eye == (0, 3, 8) and "perspective" in repr(camera)
    with pytest.raises(ValueError, match="falloff"):
        strahl.point_light((0, 0, 0), falloff="linear")


def test_visibility() -> None:
    ball = strahl.sphere()
    scene = strahl.Scene(ball.visible_to(camera=False), ball.translate((5, 0, 0)).visible_to(shadows=False))
    assert scene.intersect([[0, 0, 9], [5, 0, 9]], (0, 0, -1)).hit.tolist() == [False, True]
    assert scene.occluded([[0, 0, 9], [5, 0, 9]], (0, 0, -1)).tolist() == [True, False]


def _can(radius: float = 1) -> list[strahl.Object]:
    """A tube about z from -1 to 1 of radius 1, and its lids of this radius."""
    ring, ring_weights, ring_knots = _ring()
    tube = np.empty((2, 9, 3))
    tube[..., :2] = ring
    tube[..., 2] = [[-1], [1]]
    side = strahl.nurbs(tube, (2, 1), weights=np.stack([ring_weights] * 2), knots=(ring_knots, [0, 0, 1, 1]))
    border = strahl.NurbsCurve(radius * ring, 2, weights=ring_weights, knots=ring_knots)
    square = np.array([[[-2, -2, 0], [2, -2, 0]], [[-2, 2, 0], [2, 2, 0]]])
    lid = strahl.nurbs(square, 1, knots=([-2, -2, 2, 2], [-2, -2, 2, 2]), trim=[border])
    return [side, lid.translate((0, 0, 1)), strahl.union(lid).translate((0, 0, -1))]


def test_surfaces_that_close_a_volume_are_a_solid() -> None:
    rng = np.random.default_rng(16)
    points = rng.uniform(-1.2, 1.2, (4000, 3))
    distance = np.maximum(np.hypot(points[:, 0], points[:, 1]), abs(points[:, 2]))
    for radius in (1, 1 - 1e-6):
        solid = strahl.brep(_can(radius), name="can", material="#aaccee")
        assert solid.kind == "brep"
        expected = np.where(distance < 1, 0, -1)
        assert np.array_equal(strahl.Scene(solid).inside(points), expected)
    cut = strahl.Scene(strahl.brep(*_can()) - strahl.sphere((0, 0, 1), 0.5))
    hits = cut.intersect([[0, 0, 5], [0.7, 0, 5], [5, 0, 0.9]], [[0, 0, -1], [0, 0, -1], [-1, 0, 0]])
    np.testing.assert_allclose(hits.t, [4.5, 4, 4], atol=1e-9)
    np.testing.assert_allclose(hits.normal, [[0, 0, 1], [0, 0, 1], [1, 0, 0]], atol=1e-9)
    for wrong, message in (
        (lambda: strahl.brep(), "no faces"),
        (lambda: strahl.brep(_can()[:2]), "face 0 .* has a border at <.*>, but no other face"),
        (lambda: strahl.brep(_can(1.01)), "not closed"),
        (lambda: strahl.brep(strahl.sphere()), "must be a nurbs surface, not sphere"),
    ):
        with pytest.raises(ValueError, match=message):
            wrong()
