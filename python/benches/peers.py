"""The same pictures and rays with strahl, with POV-Ray (through vapory and through a text), and with Mitsuba 3: times and lines of code.

    pip install ./python vapory mitsuba      # and POV-Ray on the PATH; Mitsuba wants LLVM's library
    python python/benches/peers.py [--only NAME] [--runs 5]

Every function takes plain numbers or arrays and returns an array: a picture (h, w, 3), or the distances along rays. The time is that of the whole call, medians of
several runs in turns; for rays on a mesh it is split into the time until the mesh is ready and that of the rays. The lines are those of the function's body.
"""

from __future__ import annotations

import argparse
import inspect
import subprocess
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from rays import camera_rays, terrain

import strahl

try:
    import vapory
except ImportError:
    vapory = None
try:
    import mitsuba as mi

    mi.set_variant("llvm_ad_rgb")
except ImportError:
    mi = None

SIZE = (640, 480)
COLORS = [[0.8, 0.1, 0.1], [0.9, 0.9, 0.9], [0.2, 0.2, 0.2], [0.1, 0.2, 0.8], [0.9, 0.8, 0.2]]


def glass_strahl() -> Any:
    scene = strahl.Scene(
        strahl.plane(material=0.7),
        strahl.sphere((0, 1, 0), 1, material=strahl.Material.glass(1.5)),
        strahl.point_light((4, 8, 6)),
        strahl.Camera.perspective((0, 2, 7), (0, 1, 0), angle=40),
        background=(0.25, 0.4, 0.72),
    )
    return scene.render(*SIZE).to_srgb8()


def glass_vapory() -> Any:
    width, height = SIZE
    angle = np.degrees(2 * np.arctan(np.tan(np.radians(20)) * width / height))
    right = [-width / height, 0, 0]
    camera = vapory.Camera("location", [0, 2, 7], "right", right, "angle", angle, "look_at", [0, 1, 0])
    matte = vapory.Finish("ambient", 0.1, "diffuse", 1)
    glass = vapory.Finish(
        "ambient", 0, "diffuse", 0, "specular", 0.5, "roughness", 0.005, "reflection { 0, 1 fresnel on } conserve_energy"
    )
    scene = vapory.Scene(
        camera,
        [
            vapory.Plane([0, 1, 0], 0, vapory.Texture(vapory.Pigment("rgb", [0.7, 0.7, 0.7]), matte)),
            vapory.Sphere(
                [0, 1, 0], 1, vapory.Texture(vapory.Pigment("rgbf", [1, 1, 1, 1]), glass), vapory.Interior("ior", 1.5)
            ),
            vapory.LightSource([4, 8, 6], "rgb", [1, 1, 1]),
            vapory.Background("rgb", [0.25, 0.4, 0.72]),
        ],
        global_settings=["assumed_gamma 1"],
    )
    return scene.render(width=width, height=height, antialiasing=0.3, auto_camera_angle=False)


def atoms(count: int) -> tuple[Any, Any]:
    """Centres in a cube and a number of a colour for each."""
    generator = np.random.default_rng(1)
    return generator.uniform(-50, 50, (count, 3)), generator.integers(0, len(COLORS), count)


def atoms_strahl(centers: Any, kinds: Any) -> Any:
    scene = strahl.Scene(
        strahl.spheres(centers, 0.5, np.array(COLORS)[kinds]),
        strahl.point_light((100, 200, 150)),
        strahl.Camera.perspective((0, 0, 160), angle=40),
    )
    return scene.render(*SIZE, sampling="center").to_srgb8()


def atoms_vapory(centers: Any, kinds: Any) -> Any:
    width, height = SIZE
    angle = np.degrees(2 * np.arctan(np.tan(np.radians(20)) * width / height))
    right = [-width / height, 0, 0]
    camera = vapory.Camera("location", [0, 0, 160], "right", right, "angle", angle, "look_at", [0, 0, 0])
    matte = vapory.Finish("ambient", 0.1, "diffuse", 1)
    looks = [vapory.Texture(vapory.Pigment("rgb", color), matte) for color in COLORS]
    spheres = [vapory.Sphere(center, 0.5, looks[kind]) for center, kind in zip(centers.tolist(), kinds)]
    light = vapory.LightSource([100, 200, 150], "rgb", [1, 1, 1])
    scene = vapory.Scene(camera, [*spheres, light], global_settings=["assumed_gamma 1"])
    return scene.render(width=width, height=height, auto_camera_angle=False)


def atoms_povray(centers: Any, kinds: Any) -> Any:
    width, height = SIZE
    angle = np.degrees(2 * np.arctan(np.tan(np.radians(20)) * width / height))
    text = [
        "#version 3.7; global_settings { assumed_gamma 1 } #default { finish { ambient 0.1 diffuse 1 } }",
        f"camera {{ location <0, 0, 160> right <-{width / height}, 0, 0> angle {angle} look_at 0 }}",
        "light_source { <100, 200, 150> rgb 1 }",
        *(f"#declare T{k} = texture {{ pigment {{ rgb <{r}, {g}, {b}> }} }}" for k, (r, g, b) in enumerate(COLORS)),
        *(f"sphere {{ <{x}, {y}, {z}>, 0.5 texture {{ T{k} }} }}" for (x, y, z), k in zip(centers.tolist(), kinds)),
    ]
    with tempfile.TemporaryDirectory() as folder:
        scene, picture = Path(folder) / "atoms.pov", Path(folder) / "atoms.ppm"
        scene.write_text("\n".join(text))
        command = ["povray", f"+I{scene}", f"+O{picture}", f"+W{width}", f"+H{height}", "+FP", "-D"]
        subprocess.run(command, check=True, capture_output=True)
        return np.frombuffer(picture.read_bytes()[-3 * width * height :], np.uint8).reshape(height, width, 3)


def mesh_strahl(vertices: Any, faces: Any) -> Callable[[Any, Any], Any]:
    scene = strahl.Scene(strahl.mesh(vertices, faces))
    scene.stats()
    return lambda origins, directions: scene.intersect(origins, directions).t


def mesh_mitsuba(vertices: Any, faces: Any) -> Callable[[Any, Any], Any]:
    mesh = mi.Mesh("terrain", len(vertices), len(faces))
    parameters = mi.traverse(mesh)
    parameters["vertex_positions"] = vertices.ravel()
    parameters["faces"] = faces.ravel()
    parameters.update()
    scene = mi.load_dict({"type": "scene", "mesh": mesh})

    def distances(origins: Any, directions: Any) -> Any:
        length = np.linalg.norm(directions, axis=1)
        unit = directions / length[:, None]
        rays = mi.Ray3f(mi.Point3f(origins.T.astype(np.float32)), mi.Vector3f(unit.T.astype(np.float32)))
        return np.array(scene.ray_intersect_preliminary(rays).t) / length

    return distances


def lines(function: Callable[..., Any]) -> int:
    """Lines of the body of a function, without empty ones."""
    source = inspect.getsource(function).splitlines()
    return sum(bool(line.strip()) for line in source) - 1


def seconds(call: Callable[[], Any]) -> tuple[float, Any]:
    """How long a call takes, and what it returns."""
    start = time.perf_counter()
    answer = call()
    return time.perf_counter() - start, answer


def pictures(title: str, runs: int, contenders: dict[str, tuple[Callable[..., Any], Any]], arguments: tuple[Any, ...]) -> None:
    """Prints a table of pictures."""
    found: dict[str, list[float]] = {name: [] for name in contenders}
    first: Any = None
    for _ in range(runs):
        for name, (function, known) in contenders.items():
            if known is None:
                continue
            taken, picture = seconds(lambda: function(*arguments))
            found[name].append(taken)
            if first is None:
                first = picture
            difference = np.abs(np.asarray(picture, float) - first).mean()
            assert difference < 12, f"{name} shows something else: {difference}"
    print(f"\n{title}\n\n| | s | lines |\n|---|---|---|")
    for name, (function, _) in contenders.items():
        if found[name]:
            print(f"| {name} | {np.median(found[name]):.3f} | {lines(function)} |")


def mesh_rays(runs: int) -> None:
    """Prints a table of rays on a mesh."""
    vertices, faces = terrain(707)
    origins, directions = camera_rays(1000)
    contenders = {"strahl": (mesh_strahl, strahl), "Mitsuba 3 (llvm_ad_rgb)": (mesh_mitsuba, mi)}
    built: dict[str, list[float]] = {name: [] for name in contenders}
    asked: dict[str, list[float]] = {name: [] for name in contenders}
    answers: dict[str, Any] = {}
    for _ in range(runs):
        for name, (function, known) in contenders.items():
            if known is not None:
                taken, ask = seconds(lambda: function(vertices, faces))
                built[name].append(taken)
                ask(origins, directions)
                taken, answers[name] = seconds(lambda: ask(origins, directions))
                asked[name].append(taken)
    print(f"\n{len(faces)} triangles, {len(origins)} camera rays from arrays to an array\n")
    print("| | mesh s | rays s | lines | rays with another answer | median relative difference |\n|---|---|---|---|---|---|")
    exact = answers["strahl"]
    for name, (function, _) in contenders.items():
        if built[name]:
            t = answers[name]
            both = np.isfinite(t) & np.isfinite(exact)
            error = np.abs(t[both] / exact[both] - 1)
            other = int((np.isfinite(t) != np.isfinite(exact)).sum() + (error > 1e-4).sum())
            numbers = f"{np.median(built[name]):.3f} | {np.median(asked[name]):.3f} | {lines(function)} | {other} | {np.median(error):.0e}"
            print(f"| {name} | {numbers} |")


def main() -> None:
    """Prints all tables."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--only", choices=["glass", "atoms", "million", "mesh"])
    parser.add_argument("--runs", type=int, default=5)
    options = parser.parse_args()

    def wanted(name: str) -> bool:
        return options.only in (None, name)

    if wanted("glass"):
        names = {"strahl": (glass_strahl, strahl), "vapory and POV-Ray": (glass_vapory, vapory)}
        pictures("A glass ball, 640x480, antialiased", options.runs, names, ())
    everyone = {"strahl": (atoms_strahl, strahl), "vapory and POV-Ray": (atoms_vapory, vapory), "POV-Ray by a text": (atoms_povray, True)}
    if wanted("atoms"):
        pictures("100,000 atoms from arrays, 640x480, one ray per pixel", options.runs, everyone, atoms(100_000))
    if wanted("million"):
        pictures("1,000,000 atoms from arrays, 640x480, one ray per pixel", 1, everyone, atoms(1_000_000))
    if wanted("mesh"):
        mesh_rays(options.runs)


if __name__ == "__main__":
    main()
