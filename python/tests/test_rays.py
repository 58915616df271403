"""Rays and points."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time

import numpy as np
import pytest

import strahl


def test_hits_are_arrays(ball: strahl.Scene) -> None:
    x = np.linspace(-1.5, 1.5, 7)
    origins = np.stack([x, 0 * x, 0 * x + 5], axis=1)
    hits = ball.intersect(origins, (0, 0, -2))
    hit = abs(x) < 1
    assert np.array_equal(hits.hit[abs(x) != 1], hit[abs(x) != 1])
    z = np.sqrt(1 - x[hit] ** 2)
    np.testing.assert_allclose(hits.t[hit], (5 - z) / 2, rtol=1e-12)
    np.testing.assert_allclose(hits.position[hit][:, 2], z, rtol=1e-12)
    np.testing.assert_allclose(hits.normal[hit], hits.position[hit], atol=1e-12)
    assert np.isinf(hits.t[~hits.hit]).all() and np.isnan(hits.normal[~hits.hit]).all()
    assert set(hits.object.tolist()) == {0, -1} and hits.uv.shape == (7, 2)
    assert hits.material[3] == 0 and hits.element[3] == 0 and hits.shading_normal.shape == (7, 3)
    assert len(hits) == 7 and ball.object_name(0) == 'sphere "ball"'
    with pytest.raises(IndexError):
        ball.object_name(99)


def test_shapes_are_kept(ball: strahl.Scene) -> None:
    directions = np.zeros((4, 5, 3)) - (0, 0, 1)
    assert ball.intersect((0, 0, 5), directions).position.shape == (4, 5, 3)
    one = ball.intersect((0, 0, 5), (0, 0, -1))
    assert one.t.shape == () and float(one.t) == 4
    none = ball.intersect(np.empty((0, 3)), (0, 0, -1))
    assert none.t.shape == (0,) and none.normal.shape == (0, 3)
    assert ball.occluded(np.empty((0, 3)), (0, 0, -1)).shape == (0,)
    assert ball.inside(np.empty((0, 3))).shape == (0,)


def test_many_rays_are_those_one_by_one(ball: strahl.Scene) -> None:
    ball = ball.copy().add(strahl.torus(2, 0.5), strahl.box((3, 3, 3), (4, 5, 6)))
    generator = np.random.default_rng(7)
    origins, directions = generator.normal(size=(2, 20000, 3)) * 3
    hits = ball.intersect(origins, directions)
    single = [ball.intersect(o, d) for o, d in zip(origins[:50], directions[:50])]
    assert [float(s.t) for s in single] == hits.t[:50].tolist()
    assert [int(s.object) for s in single] == hits.object[:50].tolist()
    again = ball.intersect(origins, directions, threads=1)
    assert np.array_equal(hits.t, again.t) and np.array_equal(hits.position, again.position, equal_nan=True)


def test_any_layout_and_type_gives_the_same(ball: strahl.Scene) -> None:
    origins = np.random.default_rng(3).integers(-4, 5, size=(100, 3))
    expected = ball.intersect(origins.astype(float), (1, 0, 0)).t
    wide = np.zeros((200, 6))
    wide[::2, ::2] = origins
    for same in (origins, origins.astype(np.int8), origins.astype(np.float32), origins.tolist(), wide[::2, ::2], np.asfortranarray(origins, dtype=float), origins.astype(">f8")):
        assert np.array_equal(ball.intersect(same, (1, 0, 0)).t, expected)


def test_one_origin_or_direction_serves_all_rays(ball: strahl.Scene) -> None:
    generator = np.random.default_rng(5)
    points = generator.normal(size=(300, 3))
    eye, down = np.array([0.5, 0.25, 6]), np.array([0.0, 0.1, -2])
    for origins, directions in ((eye, points - eye), (points + (0, 0, 6), down), (eye, down), (eye[np.newaxis], down)):
        full = np.broadcast_arrays(origins, directions)
        hits, expected = ball.intersect(origins, directions), ball.intersect(*(np.ascontiguousarray(array) for array in full))
        assert hits.shape == expected.shape and np.array_equal(hits.t, expected.t)
        assert np.array_equal(hits.position, expected.position, equal_nan=True)
        assert np.array_equal(ball.occluded(origins, directions), ball.occluded(*full))
    assert ball.intersect(np.zeros((1, 1, 3)), down).t.shape == (1, 1)


def test_hits_are_those_of_the_arrays_as_they_were(ball: strahl.Scene) -> None:
    ball = ball.copy().add(strahl.torus(3, 0.5))
    generator = np.random.default_rng(9)
    origins = generator.normal(size=(5000, 3)) * 4
    directions = -origins + generator.normal(size=origins.shape)
    before = ball.intersect(origins.copy(), directions.copy())
    expected = before.position.copy(), before.normal.copy(), before.uv.copy()
    hits = ball.intersect(origins, directions)
    origins += 1
    directions[:] = 0
    assert all(np.array_equal(a, b, equal_nan=True) for a, b in zip((hits.position, hits.normal, hits.uv), expected))


def test_hits_keep_their_numbers_when_others_are_freed(ball: strahl.Scene) -> None:
    # Memory of freed hits serves the next ones.
    generator = np.random.default_rng(10)
    for count in (70, 3000, 70, 2000, 5000, 64, 900):
        directions = generator.normal(size=(count, 3)) * 0.3 - (0, 0, 1)
        kept = ball.intersect((0, 0, 5), directions)
        for _ in range(4):
            ball.intersect((0, 0, 5), -directions)
            ball.intersect((0.1, 0, 4), directions[::2])
        hit = kept.hit
        assert 0 < hit.sum() < count
        along = kept.t[hit, np.newaxis] * directions[hit] + (0, 0, 5)
        np.testing.assert_allclose(kept.position[hit], along, atol=1e-12)
        assert np.isnan(kept.position[~hit]).all() and (kept.element[hit] == 0).all() and (kept.element[~hit] == -1).all()


CHILD = """
import numpy as np, strahl, sys
scene = strahl.parse(sys.stdin.read())
directions = np.random.default_rng(1).normal(size=(3_000_000, 3))
scene.stats()
print("go", flush=True)
try:
    scene.intersect(-3 * directions, directions)
except KeyboardInterrupt:
    print("stopped", flush=True)
    print(bool(scene.intersect((0, 0, -5), (0, 0, 1)).hit), flush=True)
"""


@pytest.mark.skipif(sys.platform == "win32", reason="there is no SIGINT for other processes")
def test_ctrl_c_stops_questions_within_a_second() -> None:
    scene = "#for (I, 1, 30) julia_fractal { <-0.08, 0, -0.83, -0.025> quaternion max_iteration 20 precision 500 rotate I * 7 } #end"
    with subprocess.Popen([sys.executable, "-c", CHILD], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as child:
        assert child.stdin is not None and child.stdout is not None
        child.stdin.write(scene)
        child.stdin.close()
        assert child.stdout.readline() == "go\n"
        time.sleep(0.7)
        start = time.perf_counter()
        os.kill(child.pid, signal.SIGINT)
        assert child.stdout.readline() == "stopped\n"
        assert time.perf_counter() - start < 1
        assert child.stdout.readline() == "True\n"
        assert child.wait(60) == 0


def test_rays_that_are_none_hit_nothing(ball: strahl.Scene) -> None:
    nan, inf = np.nan, np.inf
    bad = [[nan, 0, 0], [inf, 0, 0], [0, 0, 0], [0, 0, -inf], [0, nan, -1]]
    hits = ball.intersect((0, 0, 5), bad)
    assert not hits.hit.any() and (hits.object == -1).all()
    assert not ball.intersect([[nan, 0, 5], [0, inf, 5]], (0, 0, -1)).hit.any()
    assert not ball.occluded((0, 0, 5), bad).any()
    assert ball.inside([[nan, 0, 0], [inf, 0, 0]]).tolist() == [-1, -1]


def test_ranges_and_shadows(ball: strahl.Scene) -> None:
    assert ball.occluded((0, 0, 5), (0, 0, -10), t_max=1).tolist() is True
    assert ball.occluded((0, 0, 5), (0, 0, -1), t_max=3.9).tolist() is False
    assert float(ball.intersect((0, 0, 5), (0, 0, -1), t_min=4.5).t) == 6
    with pytest.raises(ValueError, match="NaN"):
        ball.intersect((0, 0, 5), (0, 0, -1), t_min=float("nan"))


def test_points_are_inside_of_solids(ball: strahl.Scene) -> None:
    ball = ball.copy().add(strahl.box((0, 0, 0), (9, 9, 9)) - strahl.sphere((9, 9, 9), 2))
    assert ball.inside([[-0.5, 0, 0], [0.1, 0.1, 0.1], [5, 5, 5], [8.9, 8.9, 8.9], [20, 0, 0]]).tolist() == [0, 1, 1, -1, -1]
    assert ball.inside(np.zeros((2, 2, 3))).shape == (2, 2)


def test_wrong_arrays_are_refused(ball: strahl.Scene) -> None:
    for origins, error, message in (
        (np.zeros((5, 2)), ValueError, r"\(5, 2\)"),
        (np.zeros(()), ValueError, "shape"),
        (np.zeros((5, 3), complex), TypeError, "complex"),
        (["a", "b", "c"], TypeError, "real numbers"),
        ([[1, 2, 3], [4, 5]], ValueError, "equal length"),
        (None, TypeError, "real numbers"),
    ):
        with pytest.raises(error, match=message):
            ball.intersect(origins, (0, 0, 1))  # type: ignore[arg-type]
    with pytest.raises(ValueError, match="fit together"):
        ball.intersect(np.zeros((5, 3)), np.zeros((4, 3)))
