"""What many rays have hit."""

from __future__ import annotations

from functools import cached_property

import numpy as np
import numpy.typing as npt

from strahl import _strahl


class Hits:
    """The nearest hits of rays, as arrays with the leading shape of the rays (written (n,) below). They cannot be written to.

    Where a ray hits nothing, `t` is infinite, numbers are -1 and vectors NaN. Everything but `t` and `hit` is computed when it is first used.
    """

    def __init__(self, core: _strahl.Hits, shape: tuple[int, ...]) -> None:
        self._core = core
        self.shape: tuple[int, ...] = shape
        """The leading shape of the rays: () for a single ray."""

    def __len__(self) -> int:
        return len(self._core)

    @cached_property
    def t(self) -> npt.NDArray[np.float64]:
        """(n,) float64: where on the ray, in lengths of its direction; infinite for a miss."""
        return self._core.t.reshape(self.shape)

    @cached_property
    def hit(self) -> npt.NDArray[np.bool_]:
        """(n,) bool: whether there is a hit."""
        return np.asarray(np.isfinite(self.t))

    @cached_property
    def object(self) -> npt.NDArray[np.int32]:
        """(n,) int32: number of the object, for `Scene.object_name`; -1 for a miss."""
        return self._core.object.reshape(self.shape)

    @cached_property
    def material(self) -> npt.NDArray[np.int32]:
        """(n,) int32: number of the material; -1 for a miss."""
        return self._core.material.reshape(self.shape)

    @cached_property
    def element(self) -> npt.NDArray[np.int64]:
        """(n,) int64: number of the element in the whole scene: a triangle of a mesh, a sphere of many; -1 for a miss."""
        return self._core.element.reshape(self.shape)

    @cached_property
    def position(self) -> npt.NDArray[np.float64]:
        """(n, 3) float64: position in the world; NaN for a miss."""
        return self._core.position.reshape(*self.shape, 3)

    @cached_property
    def normal(self) -> npt.NDArray[np.float64]:
        """(n, 3) float64: unit normal, outwards on solids, to the front on open surfaces; NaN for a miss."""
        return self._core.normal.reshape(*self.shape, 3)

    @cached_property
    def shading_normal(self) -> npt.NDArray[np.float64]:
        """(n, 3) float64: unit normal for shading, interpolated on smooth meshes; NaN for a miss."""
        return self._core.shading_normal.reshape(*self.shape, 3)

    @cached_property
    def uv(self) -> npt.NDArray[np.float64]:
        """(n, 2) float64: texture coordinates; NaN for a miss."""
        return self._core.uv.reshape(*self.shape, 2)

    def __repr__(self) -> str:
        return f"<strahl.Hits {int(self.hit.sum())} of {len(self)} rays hit>"
