"""Ray trees, heat maps and comparisons."""

from __future__ import annotations

import json
import runpy
from types import SimpleNamespace

import numpy as np
import pytest
from conftest import ROOT

import strahl


@pytest.fixture
def glass() -> strahl.Scene:
    """A glass ball on a floor."""
    return strahl.Scene(
        strahl.plane((0, -1, 0)),
        strahl.sphere(material=strahl.Material.glass(1.5), name="ball"),
        strahl.point_light((4, 8, 6), name="key"),
        strahl.Camera.perspective((0, 0, 7)),
    )


def test_a_tree_adds_up_to_the_pixel(glass: strahl.Scene) -> None:
    film = glass.render(33, 25)
    tree = glass.explain(16, 12, 33, 25)
    assert np.array_equal(np.float32(tree.total), film.rgb[12, 16])
    assert tree.film == tuple(film.rgb[12, 16].tolist()) and tree.rgb8 == tuple(film.to_srgb8()[12, 16].tolist())
    root = tree.root
    assert root.kind == "primary" and root.parent is None and root.hit is not None
    assert root.hit.object == 'sphere "ball"' and root.hit.n2 == 1.5
    assert root.hit.source is not None and root.hit.source.startswith(__file__)
    rays = list(root.walk())
    assert len(rays) == len(tree.samples[0].rays) and rays[0] is root
    assert [node.id for node in root.nodes] == root.children
    # The lecture's formula: what is seen is the hit's own light and what its rays bring, by their shares.
    total = np.array(root.local)
    for node in root.nodes:
        total += np.array(node.share) * np.array(node.total)
    np.testing.assert_allclose(np.array(root.attenuation) * total + root.fog, root.total, rtol=1e-9)
    light = next(ray.lights[0] for ray in rays if ray.lights)
    assert light.light == 'light 1 "key"' and light.position == (4, 8, 6)


def test_the_data_is_that_of_the_json(glass: strahl.Scene) -> None:
    tree = glass.explain(16, 12, 33, 25)
    data = tree.to_dict()
    assert data["samples"][0]["rays"][0]["kind"] == "primary"
    assert json.loads(json.dumps(data)) == data


def test_every_field_of_the_schema_is_an_attribute() -> None:
    scene = strahl.parse(
        "#version 3.7; sphere { 0, 1 pigment { rgbf <1, 0.5, 0.5, 0.3> } finish { phong 0.5 reflection 0.2 } } light_source { -5, 1 } camera { location -4 * z }"
    )

    def check(node: object, data: object) -> int:
        if isinstance(data, dict):
            return 1 + sum(check(getattr(node, name + "_" * (name == "pass")), value) for name, value in data.items())
        if isinstance(data, list):
            assert isinstance(node, (list, tuple)) and len(node) == len(data)
            return sum(check(part, value) for part, value in zip(node, data))
        assert data is None or node == data
        return 1

    tree = scene.explain(20, 15, 40, 30)
    assert check(tree, tree.to_dict()) > 100
    assert tree.root.hit is not None and tree.root.hit.layers is not None
    assert tree.root.hit.layers[0].finish.phong == 0.5 and tree.root.hit.kd is None


def test_the_classes_are_those_of_the_schema() -> None:
    tool = runpy.run_path(str(ROOT / "python/tools/tree_classes.py"))
    assert tool["TARGET"].read_text() == tool["make"](), "run python/tools/tree_classes.py"


def test_trees_are_graphs(glass: strahl.Scene, monkeypatch: pytest.MonkeyPatch) -> None:
    class DiGraph:
        def __init__(self, **attributes: object) -> None:
            self.graph, self.nodes, self.edges = attributes, {}, []

        def add_node(self, name: object, **attributes: object) -> None:
            self.nodes[name] = attributes

        def add_edge(self, a: object, b: object) -> None:
            self.edges.append((a, b))

    monkeypatch.setitem(__import__("sys").modules, "networkx", SimpleNamespace(DiGraph=DiGraph))
    tree = glass.explain(16, 12, 33, 25)
    graph = tree.to_networkx()
    rays = sum(len(sample.rays) for sample in tree.samples)
    assert len(graph.nodes) == rays and len(graph.edges) == rays - len(tree.samples)
    assert graph.nodes[1, tree.root.id]["total"] == tree.root.total


def test_pixels_outside_are_refused(glass: strahl.Scene) -> None:
    with pytest.raises(ValueError):
        glass.explain(33, 0, 33, 25)
    with pytest.raises(ValueError):
        glass.explain(-1, 0, 33, 25)


def test_heat_maps_are_arrays(glass: strahl.Scene) -> None:
    for metric in ("tests", "steps", "rays", "depth", "time"):
        values = glass.heatmap(32, 24, metric=metric)  # type: ignore[arg-type]
        assert values.shape == (24, 32) and values.dtype == np.float64
        # So small a scene has no nodes.
        assert values.max() > 0 or metric == "steps"
    assert glass.heatmap(32, 24, metric="rays").sum() == glass.render(32, 24, sampling="center").rays["total"]
    with pytest.raises(ValueError, match="metric"):
        glass.heatmap(8, 8, metric="heat")  # type: ignore[arg-type]


def test_accelerators_make_the_same_picture(glass: strahl.Scene) -> None:
    rows = glass.compare(["bvh", "grid", "list"], 32, 24)
    assert [row["accelerator"] for row in rows] == ["bvh", "grid", "list"]
    assert len({row["sha256"] for row in rows}) == 1 and rows[0]["rays"] == rows[2]["rays"]
    assert rows[2]["tests_per_ray"] > 0 and rows[0]["trace_s"] > 0
    assert rows[0]["sha256"] == glass.render(32, 24, sampling="center").sha256
    with pytest.raises(ValueError, match="accelerator"):
        glass.compare(["fast"], 8, 8)


def test_comparisons_are_data_frames(glass: strahl.Scene) -> None:
    pandas = pytest.importorskip("pandas")
    table = glass.compare(["bvh", "grid"], 16, 12).to_dataframe()
    assert isinstance(table, pandas.DataFrame) and list(table.index) == ["bvh", "grid"]
    assert table.sha256.nunique() == 1 and (table.rays > 0).all()
