"""Rays and points."""

from __future__ import annotations

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
