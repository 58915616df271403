"""Builds a mesh of ten million triangles from arrays: how long it takes, and how much memory beside the arrays.

    python python/benches/mesh.py [--triangles 10000000] [--kind f32|f64|i64]

Linux only. The peak is that of the resident memory, which is reset before the call.
"""

from __future__ import annotations

import argparse
import time
from pathlib import Path

import numpy as np
from rays import terrain

import strahl


def resident(line: str) -> int:
    """A line of the process's status in bytes."""
    status = Path("/proc/self/status").read_text()
    return int(next(row for row in status.splitlines() if row.startswith(line)).split()[1]) * 1024


def main() -> None:
    """Prints the figures."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--triangles", type=int, default=10_000_000)
    parser.add_argument("--kind", choices=["f32", "f64", "i64"], default="f32")
    options = parser.parse_args()
    vertices, faces = terrain(round((options.triangles / 2) ** 0.5))
    points = vertices.astype(np.float64) if options.kind == "f64" else vertices
    corners = faces.astype(np.int64) if options.kind == "i64" else faces
    arrays = points.nbytes + corners.nbytes
    del vertices, faces

    def measured(what: str, call: object) -> object:
        assert callable(call)
        Path("/proc/self/clear_refs").write_text("5")
        before, start, busy = resident("VmRSS"), time.perf_counter(), time.process_time()
        result = call()
        wall, work = time.perf_counter() - start, time.process_time() - busy
        peak, after = resident("VmHWM") - before, resident("VmRSS") - before
        print(f"{what}: {wall:.2f} s ({work:.2f} s of processor time), peak {peak / 1e6:.0f} MB, kept {after / 1e6:.0f} MB")
        return result

    print(f"{len(corners)} triangles; the arrays take {arrays / 1e6:.0f} MB, the mesh {(12 * len(points) + 12 * len(corners)) / 1e6:.0f} MB")
    mesh = measured("mesh", lambda: strahl.mesh(points, corners))
    assert isinstance(mesh, strahl.Object)
    scene = strahl.Scene(mesh)
    measured("compile", scene.stats)


if __name__ == "__main__":
    main()
