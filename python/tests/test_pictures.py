"""Pictures and what they hold."""

from __future__ import annotations

import io
import json
import os
import signal
import subprocess
import sys
import threading
import time
from pathlib import Path

import numpy as np
import pytest
from conftest import ROOT

import strahl


def test_a_film_has_arrays(ball: strahl.Scene) -> None:
    film = ball.render(40, 30, layers=True, alpha=True)
    assert film.rgb.shape == (30, 40, 3) and film.rgb.dtype == np.float32
    assert np.shares_memory(film.rgb, film._core.pixels)
    with pytest.raises(ValueError, match="read-only"):
        film.rgb[0, 0] = 1
    assert film.depth.shape == (30, 40) and film.depth[15, 20] == pytest.approx(6, abs=0.01)
    assert np.isinf(film.depth[0, 0])
    assert film.normal[15, 20, 2] == pytest.approx(1, abs=0.01)
    assert film.position[15, 20, 2] == pytest.approx(1, abs=0.01)
    assert (film.object_id[15, 20], film.object_id[0, 0]) == (0, -1)
    assert film.material_id[15, 20] == 0 and film.tests[15, 20] >= 1 and film.tree_depth[15, 20] == 1
    assert film.alpha is not None and film.alpha[15, 20] == 1
    codes = film.to_srgb8()
    assert codes.shape == (30, 40, 3) and codes.dtype == np.uint8
    assert film.rays["primary"] >= 40 * 30 and "40x30" in repr(film)
    assert np.asarray(film).shape == (30, 40, 3)
    with pytest.raises(ValueError, match="layers=True"):
        ball.render(4, 4).depth


def test_a_region_is_a_part_of_the_picture(ball: strahl.Scene) -> None:
    whole = ball.render(40, 30)
    part = ball.render(40, 30, region=(10, 5, 20, 15))
    assert np.array_equal(part.rgb, whole.rgb[5:20, 10:30])
    assert (part.region, part.size) == ((10, 5, 20, 15), (40, 30))
    with pytest.raises(ValueError, match="not within"):
        ball.render(40, 30, region=(30, 0, 20, 10))


def test_settings_change_the_picture(ball: strahl.Scene) -> None:
    film = ball.render(32, 24)
    for other in (
        ball.render(32, 24, sampling="center"),
        ball.render(32, 24, shading="normals"),
        ball.render(32, 24, camera=strahl.Camera.orthographic((0, 0, 5), height=3)),
    ):
        assert other.sha256 != film.sha256
    for same in (ball.render(32, 24, threads=1), ball.render(32, 24, progress=True), ball.render(32, 24, layers=True)):
        assert same.sha256 == film.sha256


def test_impossible_pictures_are_refused(ball: strahl.Scene) -> None:
    for arguments, message in (
        ({"width": 0, "height": 4}, "between 1"),
        ({"width": -1, "height": 4}, "between 1"),
        ({"width": 4, "height": 4, "sampling": "nine"}, "unknown sampling"),
        ({"width": 4, "height": 4, "depth": 0}, "between 1"),
        ({"width": 4, "height": 4, "threads": 0}, "between 1"),
        ({"width": 4_000_000_000, "height": 4_000_000_000}, "GiB"),
    ):
        with pytest.raises(ValueError, match=message):
            ball.render(**arguments)  # type: ignore[arg-type]
    with pytest.raises(TypeError, match="whole number"):
        ball.render(4.5, 4)  # type: ignore[arg-type]


def test_pictures_are_saved(ball: strahl.Scene, tmp_path: Path) -> None:
    film = ball.render(16, 12, layers=True)
    for name in ("a.png", "a.exr", "a.ppm", "a.jpg"):
        film.save(tmp_path / name)
        assert (tmp_path / name).stat().st_size > 100
    assert (tmp_path / "a.png").read_bytes()[:4] == b"\x89PNG" == film._repr_png_()[:4]
    with pytest.raises(ValueError, match="xyz"):
        film.save(tmp_path / "a.xyz")
    with pytest.raises(OSError):
        film.save(tmp_path / "no" / "folder.png")


def test_progress_is_told_and_may_fail(slow: strahl.Scene) -> None:
    seen: list[strahl.Progress] = []
    small = slow.render(64, 64, sampling="center", progress=seen.append)
    assert small.width == 64 and all(0 <= step.fraction <= 1 for step in seen)

    def fail(_: strahl.Progress) -> None:
        raise RuntimeError("enough")

    start = time.perf_counter()
    with pytest.raises(RuntimeError, match="enough"):
        slow.render(2000, 2000, progress=fail)
    assert time.perf_counter() - start < 20


class _Stream(io.StringIO):
    encoding = "utf-8"

    def __init__(self, tty: bool) -> None:
        super().__init__()
        self.tty = tty

    def isatty(self) -> bool:
        return self.tty


def test_progress_is_a_line_on_terminals(monkeypatch: pytest.MonkeyPatch) -> None:
    from strahl import _progress

    stream = _Stream(tty=False)
    monkeypatch.setattr(sys, "stderr", stream)
    assert _progress.shown(None) is None and _progress.shown(False) is None
    stream.tty = True
    patient = _progress.shown(None)
    assert patient is not None
    patient.tick(strahl.Progress(0, 2, 3, 10))
    patient.finish()
    assert stream.getvalue() == "", "there is a line after a second only"
    line = _progress.shown(True)
    assert line is not None
    line.tick(strahl.Progress(0, 2, 0, 0))
    line.tick(strahl.Progress(1, 2, 3, 10))
    line.finish()
    first, second, blank, rest = stream.getvalue().split("\r")[1:]
    assert first.startswith("pass 1/2   0%|") and first.endswith("| 0/0 [00:00<?]")
    assert second.startswith("pass 2/2  30%|█████████   ") and second.rstrip().endswith("| 3/10 [00:00<00:00]")
    assert blank.strip() == rest == "" and len(blank) >= len(second.rstrip())


CHILD = """
import strahl, sys, time
scene = strahl.parse(sys.stdin.read())
scene.stats()
print("go", flush=True)
try:
    scene.render(2000, 2000)
except KeyboardInterrupt:
    print("stopped", flush=True)
    print(scene.render(8, 8, sampling="center").sha256[:4] != "", flush=True)
"""


@pytest.mark.skipif(sys.platform == "win32", reason="there is no SIGINT for other processes")
def test_ctrl_c_stops_a_render_within_a_second() -> None:
    scene = "light_source { 9, 1 area_light x, y, 65, 65 } #for (I, 1, 99) sphere { I * x / 9, 1 pigment { rgbf 0.9 } interior { ior 1.5 } } #end camera { location <5, 0, -9> look_at 5 * x }"
    command = [sys.executable, "-c", CHILD]
    with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as child:
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


def test_other_threads_run_meanwhile(ball: strahl.Scene, slow: strahl.Scene) -> None:
    reference = ball.render(200, 150).sha256
    results: list[str] = []

    def work() -> None:
        results.append(ball.render(200, 150).sha256)

    threads = [threading.Thread(target=work) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert results == [reference] * 4


def test_a_small_picture_does_not_wait_for_a_large_one(ball: strahl.Scene, slow: strahl.Scene) -> None:
    enough = threading.Event()
    ended: list[BaseException] = []

    def tell(_: strahl.Progress) -> None:
        if enough.is_set():
            raise RuntimeError("enough")

    def large() -> None:
        try:
            slow.render(2000, 2000, progress=tell)
        except BaseException as error:
            ended.append(error)

    reference = ball.render(60, 40).sha256
    slow.stats()
    thread = threading.Thread(target=large)
    thread.start()
    time.sleep(0.3)
    try:
        assert ball.render(60, 40).sha256 == reference
        assert thread.is_alive() and not ended
    finally:
        enough.set()
        thread.join()
    assert [str(error) for error in ended] == ["enough"]


def test_python_runs_while_a_picture_is_made(slow: strahl.Scene) -> None:
    films: list[strahl.Film] = []
    thread = threading.Thread(target=lambda: films.append(slow.render(24, 18, sampling="center")))
    slow.stats()
    thread.start()
    turns = 0
    while thread.is_alive():
        time.sleep(0.001)
        turns += 1
    # A render that kept Python's lock would leave one turn.
    assert films and turns > 5


def _resident() -> int:
    pages = int(Path("/proc/self/statm").read_text().split()[1])
    return pages * os.sysconf("SC_PAGE_SIZE")


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="reads /proc")
def test_a_thousand_renders_keep_memory_flat(ball: strahl.Scene) -> None:
    for _ in range(100):
        ball.render(32, 24, sampling="center", layers=True)
    before = _resident()
    for _ in range(1000):
        film = ball.render(32, 24, sampling="center", layers=True)
        assert film.depth.shape == (24, 32)
    assert _resident() - before < 8 << 20


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="reads /proc")
def test_scenes_rays_and_trees_are_freed() -> None:
    generator = np.random.default_rng(7)
    centers = generator.uniform(-5, 5, (3000, 3))
    corners = np.repeat(centers, 3, axis=0) + generator.normal(size=(9000, 3)) * 0.05
    faces = np.arange(9000, dtype=np.uint32).reshape(-1, 3)

    def once() -> None:
        solid = strahl.spheres(centers, 0.05, np.abs(centers)) | strahl.mesh(corners, faces)
        scene = strahl.Scene(solid, strahl.point_light((9, 9, 9)), strahl.Camera.perspective((0, 0, 20)))
        assert scene.intersect(centers + 10, (-1, -1, -1)).normal.shape == (3000, 3)
        assert scene.render(32, 24).sha256 and scene.explain(16, 12, 32, 24)._repr_html_()
        with pytest.raises(strahl.SceneError):
            strahl.parse("sphere { }")

    for _ in range(20):
        once()
    before = _resident()
    for _ in range(100):
        once()
    # What one round makes takes more than a megabyte.
    assert _resident() - before < 16 << 20


SCENES = [*sorted((ROOT / "scenes/gallery").rglob("*.pov")), ROOT / "scenes/demo.pov", ROOT / "scenes/spheres.nff"]


@pytest.mark.filterwarnings("ignore::strahl.SceneWarning")
@pytest.mark.parametrize("path", SCENES, ids=lambda path: path.stem)
def test_films_have_the_bits_of_the_program(path: Path, program: str) -> None:
    # Small, because there are many; surfaces of two parameters are slow without optimisation.
    width, height = (8, 6) if path.stem == "parametric" else (24, 18)
    command = [program, "render", str(path), "--size", f"{width}x{height}", "--no-output", "--quiet", "--stats", "-"]
    done = subprocess.run(command, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    expected = json.loads(done.stdout)
    film = strahl.load(path, size=(width, height)).render(width, height)
    assert film.sha256 == next(value for key, value in _leaves(expected) if key == "sha256")


def _leaves(tree: object) -> list[tuple[str, object]]:
    if not isinstance(tree, dict):
        return []
    return [leaf for key, value in tree.items() for leaf in ([(key, value)] if not isinstance(value, dict) else _leaves(value))]
