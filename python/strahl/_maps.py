"""Transformations, which objects, lights and textures have in common."""

from __future__ import annotations

from math import radians
from typing import Any, Protocol, TypeVar

import numpy as np
import numpy.typing as npt

from strahl import _strahl
from strahl._convert import Vector, number, real, vector


class _Placed(Protocol):
    def _moved(self: Any, by: _strahl.Map) -> Any: ...


_T = TypeVar("_T", bound=_Placed)


class Movable:
    """What can be moved. Every method returns a new thing; transformations come after those that it has already."""

    __slots__ = ()

    def translate(self: _T, offset: Vector) -> _T:
        """Moved by a vector."""
        moved: _T = self._moved(_strahl.Map.translation(vector(offset, "offset")))
        return moved

    def rotate(self: _T, axis: Vector, degrees: float) -> _T:
        """Turned about an axis through the origin, counter-clockwise as seen from the tip of the axis with right-handed coordinates."""
        direction = vector(axis, "axis")
        if direction == (0, 0, 0):
            raise ValueError("axis must not be zero")
        moved: _T = self._moved(_strahl.Map.rotation(direction, radians(number(degrees, "degrees"))))
        return moved

    def scale(self: _T, factors: float | Vector) -> _T:
        """Scaled about the origin, by one factor or by three; none may be zero."""
        three = np.broadcast_to(real(factors, "factors"), 3) if np.ndim(factors) == 0 else factors
        moved: _T = self._moved(_strahl.Map.scaling(vector(three, "factors")))  # type: ignore[arg-type]
        return moved

    def transform(self: _T, matrix: npt.ArrayLike) -> _T:
        """Mapped by a matrix (3, 4) or (4, 4) that multiplies column vectors (x, y, z, 1); its last row must be 0 0 0 1."""
        (row,) = matrices(real(matrix, "matrix")[np.newaxis], "matrix", "")
        moved: _T = self._moved(_strahl.Map.matrix(row.tolist()))
        return moved

    def __repr__(self) -> str:
        return f"<strahl.{type(self).__name__}>"


def matrices(array: npt.NDArray[np.float64], name: str, more: str) -> npt.NDArray[np.float64]:
    """Rows of the 12 numbers of each matrix."""
    if array.shape[1:] == (4, 4):
        if (array[:, 3] != (0, 0, 0, 1)).any():
            raise ValueError(f"the last row of {name} must be 0 0 0 1: projections are no transformations")
        array = array[:, :3]
    if array.shape[1:] != (3, 4):
        shape = array.shape if more else array.shape[1:]
        raise ValueError(f"{name} must have the shape ({more}3, 4) or ({more}4, 4), not {shape}")
    return np.ascontiguousarray(array).reshape(-1, 12)
