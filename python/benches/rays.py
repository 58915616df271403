"""Compares the speed of a million rays asked from Python with that of the same rays asked from Rust.

    cargo build --release -p strahl --example ray_queries
    python python/benches/rays.py target/release/examples/ray_queries [RUNS]

Both load the same mesh and get the same rays, in turns. Rust has its rays and the place for the answers before the clock starts; Python's time is that of the whole
call: arrays to rays, the search, answers to an array. The numbers of hits must agree. The second table has processor time, which other programs on the machine disturb
less; it is not there on Windows.
"""

from __future__ import annotations

import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np
import numpy.typing as npt

import strahl

Floats = npt.NDArray[np.float64]
ROUNDS = 3


def terrain(side: int) -> tuple[npt.NDArray[np.float32], npt.NDArray[np.uint32]]:
    """A bumpy sheet over the unit square with 2 side² triangles."""
    x, z = np.meshgrid(np.linspace(0, 1, side + 1), np.linspace(0, 1, side + 1))
    y = 0.1 * np.sin(9 * x) * np.cos(7 * z) + 0.02 * np.sin(61 * x + 40 * z)
    vertices = np.stack([x, y, z], axis=-1).reshape(-1, 3).astype(np.float32)
    a = (np.arange(side)[:, None] * (side + 1) + np.arange(side)).reshape(-1)
    b, c, d = a + 1, a + side + 1, a + side + 2
    faces = np.concatenate([np.stack([a, c, b], axis=1), np.stack([b, c, d], axis=1)])
    return vertices, faces.astype(np.uint32)


def write_ply(path: Path, vertices: npt.NDArray[np.float32], faces: npt.NDArray[np.uint32]) -> None:
    """Writes a mesh as a binary PLY file."""
    header = (
        "ply\nformat binary_little_endian 1.0\n"
        f"element vertex {len(vertices)}\nproperty float x\nproperty float y\nproperty float z\n"
        f"element face {len(faces)}\nproperty list uchar uint vertex_indices\nend_header\n"
    )
    rows = np.empty(len(faces), dtype=[("count", "u1"), ("corners", "<u4", 3)])
    rows["count"], rows["corners"] = 3, faces
    path.write_bytes(header.encode() + vertices.astype("<f4").tobytes() + rows.tobytes())


def camera_rays(side: int) -> tuple[Floats, Floats]:
    """The rays of a picture with side² pixels, row by row."""
    x, y = np.meshgrid(np.linspace(-0.5, 0.5, side), np.linspace(0.3, -0.3, side))
    directions = np.stack([x, y - 0.5, -np.ones_like(x)], axis=-1).reshape(-1, 3)
    return np.broadcast_to(np.array([0.5, 0.8, 1.6]), directions.shape).copy(), directions


def random_rays(count: int) -> tuple[Floats, Floats]:
    """Rays from points above the sheet into all directions."""
    generator = np.random.default_rng(1)
    origins = generator.uniform((0, 0.15, 0), (1, 0.4, 1), (count, 3))
    return origins, generator.normal(size=(count, 3))


def timed(runs: int, ask: Callable[[], object]) -> list[float]:
    """The seconds of each run; one before them warms up."""
    ask()
    seconds = []
    for _ in range(runs):
        start = time.perf_counter()
        ask()
        seconds.append(time.perf_counter() - start)
    return seconds


def processor(who: int, call: Callable[[], object]) -> float:
    """The processor time that a call takes, of this process or of those that it starts."""
    import resource

    before = resource.getrusage(who)
    call()
    after = resource.getrusage(who)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def main(program: str, runs: int) -> None:
    """Prints the tables."""
    busy: list[str] = []
    with tempfile.TemporaryDirectory() as folder:
        mesh, file = Path(folder) / "terrain.ply", Path(folder) / "rays.f64"
        write_ply(mesh, *terrain(500))
        scene = strahl.load(mesh, studio=False)
        print("| rays | question | Rust s | Python s | of Rust's speed |\n|---|---|---|---|---|")
        for name, (origins, directions) in (("camera", camera_rays(1000)), ("random", random_rays(1_000_000))):
            np.concatenate([origins, directions], axis=1).astype("<f8").tofile(file)
            rust: dict[str, list[float]] = {"intersect": [], "occluded": []}
            python: dict[str, list[float]] = {"intersect": [], "occluded": []}
            for _ in range(ROUNDS):
                done = subprocess.run([program, mesh, file, str(runs)], capture_output=True, text=True, check=True)
                for line in done.stdout.splitlines():
                    question, hits, *seconds = line.split()
                    rust[question] += map(float, seconds)
                    answer = scene.intersect(origins, directions).hit if question == "intersect" else scene.occluded(origins, directions)
                    assert int(answer.sum()) == int(hits), "the answers differ"
                python["intersect"] += timed(runs, lambda: scene.intersect(origins, directions).t)
                python["occluded"] += timed(runs, lambda: scene.occluded(origins, directions))
            if sys.platform != "win32":
                import resource

                def rust_runs(count: int) -> float:
                    command: list[str | Path] = [program, mesh, file, str(count)]
                    return processor(resource.RUSAGE_CHILDREN, lambda: subprocess.run(command, capture_output=True, check=True))

                def both() -> None:
                    scene.intersect(origins, directions).t
                    scene.occluded(origins, directions)

                # What loading takes is in both numbers.
                one = (min(rust_runs(21) for _ in range(2)) - min(rust_runs(1) for _ in range(2))) / 20
                other = float(np.median([processor(resource.RUSAGE_SELF, both) for _ in range(15)]))
                busy.append(f"| {name} | {one:.3f} | {other:.3f} | {one / other:.2f} |")
            for question in rust:
                one, other = float(np.median(rust[question])), float(np.median(python[question]))
                print(f"| {name} | {question} | {one:.3f} | {other:.3f} | {one / other:.2f} |")
    print("\nProcessor time of both questions\n\n| rays | Rust s | Python s | of Rust's speed |\n|---|---|---|---|")
    print("\n".join(busy))


if __name__ == "__main__":
    main(sys.argv[1], int(sys.argv[2]) if len(sys.argv) > 2 else 7)
