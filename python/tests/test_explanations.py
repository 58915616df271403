"""Ray trees, heat maps and comparisons."""

from __future__ import annotations

import json
import runpy
import subprocess
from html import unescape
from pathlib import Path
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


def test_trees_are_pages(glass: strahl.Scene) -> None:
    scene = glass.copy().add(strahl.sphere((0, 0, 2), 0.5, name='</script><b>"'))
    tree = scene.explain(16, 12, 33, 25)
    page = tree.to_html("a & b", language="de")
    assert page.startswith("<!doctype html>") and "<title>a &amp; b 16,12" in page and 'lang="de"' in page
    assert "http://" not in page.replace("http://www.w3.org/", "") and "https://" not in page
    frame = tree._repr_html_()
    assert frame.startswith("<iframe ") and frame.endswith("></iframe>") and frame.count("<") == 2
    source = unescape(frame[frame.index('srcdoc="') + 8 : frame.rindex('"')])
    assert source == tree.to_html() and "</script><b>" not in source
    data = source[source.index('id="data">') + 10 :].partition("</script>")[0]
    assert json.loads(data) == tree.to_dict()
    assert "<strahl.Explanation of pixel (16, 12)" in repr(tree) and len(repr(tree)) < 200


def test_the_page_is_that_of_the_program(program: str, tmp_path: Path) -> None:
    path = tmp_path / "ball.pov"
    path.write_text("sphere { 0, 1 pigment { rgb <1, 0.5, 0> } finish { reflection 0.3 } } light_source { -5, 1 } camera { location -4 * z }")
    command = [program, "explain", str(path), "--pixel", "20,15", "--size", "40x30", "--format", "html"]
    done = subprocess.run(command, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    tree = strahl.load(path).explain(20, 15, 40, 30)
    assert _parts(tree.to_html(str(path))) == _parts(done.stdout)


def _parts(page: str) -> tuple[str, object, str]:
    before, _, rest = page.partition('id="data">')
    data, _, after = rest.partition("</script>")
    tree = json.loads(data)
    # float32 numbers may be written with more digits.
    tree["film"] = np.float32(tree["film"]).tolist()
    return before, tree, after.rstrip()


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


def test_trees_are_graphs_of_networkx(glass: strahl.Scene) -> None:
    networkx = pytest.importorskip("networkx")
    tree = glass.explain(16, 12, 33, 25, sampling="center")
    graph = tree.to_networkx()
    assert networkx.is_arborescence(graph) and graph.number_of_nodes() == len(tree.samples[0].rays)
    lengths = networkx.single_source_shortest_path_length(graph, (1, tree.root.id))
    assert all(graph.nodes[node]["depth"] == length + 1 for node, length in lengths.items())


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
    assert isinstance(values, strahl.HeatMap) and values.metric == "time" and (values * 2).sum() == 2 * values.sum()
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


def test_comparisons_and_heat_maps_are_data_frames(glass: strahl.Scene) -> None:
    pandas = pytest.importorskip("pandas")
    heat = glass.heatmap(32, 24, metric="rays")
    frame = heat.to_dataframe()
    assert list(frame.columns) == ["x", "y", "tests", "steps", "rays", "depth", "time"] and len(frame) == 32 * 24
    row = frame[(frame.x == 17) & (frame.y == 5)]
    assert row.rays.item() == heat[5, 17] and frame.rays.sum() == heat.sum()
    with pytest.raises(ValueError, match="not a part"):
        heat[:5].to_dataframe()
    table = glass.compare(["bvh", "grid"], 16, 12).to_dataframe()
    assert isinstance(table, pandas.DataFrame) and list(table.index) == ["bvh", "grid"]
    assert table.sha256.nunique() == 1 and (table.rays > 0).all()
