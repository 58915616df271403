"""Checks and converts arguments."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from typing import Any, TypeAlias, cast

import numpy as np
import numpy.typing as npt

Vector: TypeAlias = Sequence[float] | npt.NDArray[Any]
"""Three numbers: a tuple, a list or an array of shape (3,)."""

ColorLike: TypeAlias = float | str | Sequence[float] | npt.NDArray[Any]
"""A linear colour: three numbers, one number for a grey, or sRGB as ``"#rrggbb"``."""

Triple: TypeAlias = tuple[float, float, float]
Place: TypeAlias = tuple[str, int] | None


def vector(value: Vector, name: str) -> Triple:
    """Three finite numbers, or ValueError."""
    numbers = real(value, name)
    if numbers.shape != (3,):
        raise ValueError(f"{name} must have 3 numbers, not the shape {numbers.shape}")
    if not np.isfinite(numbers).all():
        raise ValueError(f"{name} must be finite, not {value!r}")
    return cast(Triple, tuple(numbers.tolist()))


def number(value: float, name: str) -> float:
    """One finite number, or an error."""
    try:
        result = float(value)
    except (TypeError, ValueError):
        raise TypeError(f"{name} must be a number, not {value!r}") from None
    if not np.isfinite(result):
        raise ValueError(f"{name} must be finite, not {value!r}")
    return result


def color(value: ColorLike, name: str) -> Triple:
    """A linear colour, or an error."""
    if isinstance(value, str):
        return _srgb(value, name)
    numbers = real(value, name)
    if numbers.shape == ():
        numbers = np.repeat(numbers, 3)
    if numbers.shape != (3,):
        raise ValueError(f"{name} must be 3 numbers or one, not the shape {numbers.shape}")
    if not np.isfinite(numbers).all():
        raise ValueError(f"{name} must be finite, not {value!r}")
    return cast(Triple, tuple(numbers.tolist()))


def _srgb(text: str, name: str) -> Triple:
    digits = text.removeprefix("#")
    if len(digits) == 3:
        digits = "".join(2 * digit for digit in digits)
    try:
        if not text.startswith("#") or len(digits) != 6:
            raise ValueError
        codes = np.frombuffer(bytes.fromhex(digits), np.uint8) / 255
    except ValueError:
        raise ValueError(f"{name}: {text!r} is no colour; write '#rrggbb' or numbers") from None
    linear = np.where(codes <= 0.04045, codes / 12.92, ((codes + 0.055) / 1.055) ** 2.4)
    return cast(Triple, tuple(linear.tolist()))


def real(value: Any, name: str) -> npt.NDArray[np.float64]:
    """An array of real numbers as float64, which is not copied if it is one already."""
    try:
        array = np.asarray(value)
    except ValueError:
        raise ValueError(f"{name} must be an array of numbers with rows of equal length") from None
    if array.dtype.kind not in "biuf":
        raise TypeError(f"{name} must be real numbers, not {array.dtype}")
    return array.astype(np.float64, copy=False)


def rows(value: Any, name: str, columns: int) -> npt.NDArray[np.float64]:
    """An array (n, columns), contiguous, or ValueError."""
    array = real(value, name)
    if array.ndim != 2 or array.shape[1] != columns:
        if array.size == 0:
            return np.empty((0, columns))
        raise ValueError(f"{name} must have the shape (n, {columns}), not {array.shape}")
    return np.ascontiguousarray(array)


def finite_rows(value: Any, name: str, columns: int) -> npt.NDArray[np.float64]:
    """The same, and all numbers are finite."""
    array = rows(value, name, columns)
    bad = ~np.isfinite(array).all(axis=1)
    if bad.any():
        raise ValueError(f"{name}: row {int(bad.argmax())} is not finite: {array[bad.argmax()]}")
    return array


def integer(value: Any, name: str, least: int) -> int:
    """A whole number from `least` up to 2**32 - 1."""
    import operator

    try:
        result = operator.index(value)
    except TypeError:
        raise TypeError(f"{name} must be a whole number, not {value!r}") from None
    if not least <= result < 1 << 32:
        raise ValueError(f"{name} must be between {least} and {2**32 - 1}, not {result}")
    return result


def caller() -> Place:
    """File and line of the first frame outside of the package: what ray trees show as the source of an object."""
    frame = sys._getframe(1)
    while frame.f_globals.get("__name__", "").startswith("strahl.") and frame.f_back is not None:
        frame = frame.f_back
    return frame.f_code.co_filename, frame.f_lineno
