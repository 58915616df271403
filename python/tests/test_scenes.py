"""Loading, errors and warnings."""

from __future__ import annotations

import pickle
import warnings
from pathlib import Path

import numpy as np
import pytest

import strahl


def test_a_file_is_loaded_with_declared_names_and_clock(tmp_path: Path) -> None:
    path = tmp_path / "scene.pov"
    path.write_text("#if (WORD = \"yes\") sphere { P, R + clock } #end")
    declare = {"WORD": "yes", "R": 1, "P": (1, 2, 3)}
    scene = strahl.load(path, declare=declare, clock=0.5)
    assert scene.bounds is not None
    np.testing.assert_allclose(scene.bounds, [[-0.5, 0.5, 1.5], [2.5, 3.5, 4.5]], atol=1e-9)
    with pytest.raises(ValueError, match="2 to 5 numbers"):
        strahl.load(path, declare={"P": [1]})


def test_the_picture_size_is_known_to_the_scene() -> None:
    scene = strahl.parse("sphere { 0, image_width / image_height }", size=(300, 100))
    assert scene.bounds is not None and scene.bounds[1, 0] == pytest.approx(3)
    film = scene.render()
    assert film.rgb.shape == (100, 300, 3)
    assert scene.render(width=30).rgb.shape == (10, 30, 3)


def test_all_errors_come_with_their_place() -> None:
    with pytest.raises(strahl.SceneError) as caught:
        strahl.parse("sphere { 0, }\nbox { 1 }", name="wrong.pov")
    first, second = caught.value.diagnostics[:2]
    assert (first.file, first.line, first.severity) == ("wrong.pov", 1, "error")
    assert (second.file, second.line) == ("wrong.pov", 2)
    assert first.column == 13
    assert "sphere { 0, }\n" in str(caught.value) and "^" in str(caught.value)
    again = pickle.loads(pickle.dumps(caught.value))
    assert again.diagnostics == caught.value.diagnostics


def test_errors_of_built_scenes_name_the_line_of_the_program() -> None:
    scene = strahl.Scene(strahl.sphere(), strahl.difference())
    with pytest.raises(strahl.SceneError) as caught:
        scene.render(8, 8)
    assert caught.value.diagnostics[0].file == __file__
    assert "at least one object" in str(caught.value)


def test_a_missing_file_is_an_error() -> None:
    with pytest.raises(strahl.SceneError, match="nowhere.pov"):
        strahl.load("nowhere.pov")


def test_warnings_go_through_warnings() -> None:
    text = '#warning "look here" sphere { 0, 1 }'
    with pytest.warns(strahl.SceneWarning, match="look here") as caught:
        strahl.parse(text)
    assert caught[0].filename == __file__
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        with pytest.raises(strahl.SceneWarning) as raised:
            strahl.parse(text)
    assert raised.value.diagnostic.severity == "warning"


def test_messages_go_to_a_function() -> None:
    told: list[str] = []
    strahl.parse('#debug "hello"\nsphere { 0, 1 }', messages=told.append)
    assert "hello" in "".join(told)


def test_a_panic_is_an_exception() -> None:
    with pytest.raises(strahl.InternalError, match="asked for by a test"):
        strahl._strahl.panic_for_tests()


def test_scenes_of_files_grow() -> None:
    scene = strahl.parse("sphere { 0, 1 } light_source { -5, 1 } camera { location -5 * z }")
    before = scene.render(20, 20)
    other = scene.copy().add(strahl.box((1, 1, -1), (2, 2, 1), material=0.9), strahl.parse("torus { 3, 0.5 }"))
    assert other.stats()["objects"] == 3
    assert other.render(20, 20).sha256 != before.sha256
    assert scene.render(20, 20).sha256 == before.sha256
    assert other.object_name(2) == "torus"
    assert other.object_source(1) is not None and "test_scenes.py" in str(other.object_source(1))
    scene.add(scene)
    assert scene.stats()["objects"] == 2


def test_only_parts_of_scenes_are_added() -> None:
    with pytest.raises(TypeError, match="not int"):
        strahl.Scene(3)  # type: ignore[arg-type]
    with pytest.raises(TypeError, match="not str"):
        strahl.Scene("sphere")
