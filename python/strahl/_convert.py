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
    three = real(value, name)
    if three.shape != (3,):
        raise ValueError(f"{name} must have 3 numbers, not the shape {three.shape}")
    if not np.isfinite(three).all():
        raise ValueError(f"{name} must be finite, not {value!r}")
    return cast(Triple, tuple(three.tolist()))


def number(value: float, name: str) -> float:
    """One finite number, or an error."""
    try:
        result = float(value)
    except (TypeError, ValueError):
        raise TypeError(f"{name} must be a number, not {value!r}") from None
    if not np.isfinite(result):
        raise ValueError(f"{name} must be finite, not {value!r}")
    return result


def positive(value: float, name: str) -> float:
    """One positive number, or an error."""
    result = number(value, name)
    if result <= 0:
        raise ValueError(f"{name} must be positive, not {value!r}")
    return result


def not_negative(value: float, name: str) -> float:
    """One number of 0 or more, or an error."""
    result = number(value, name)
    if result < 0:
        raise ValueError(f"{name} must not be negative, not {value!r}")
    return result


def color(value: ColorLike, name: str) -> Triple:
    """A linear colour, or an error."""
    if isinstance(value, str):
        return _srgb(value, name)
    three = real(value, name)
    if three.shape == ():
        three = np.repeat(three, 3)
    if three.shape != (3,):
        raise ValueError(f"{name} must be 3 numbers or one, not the shape {three.shape}")
    if not np.isfinite(three).all():
        raise ValueError(f"{name} must be finite, not {value!r}")
    return cast(Triple, tuple(three.tolist()))


def color_ft(value: ColorLike, name: str) -> tuple[float, float, float, float, float]:
    """A colour that may let light through: red, green, blue, and after them filter and transmit if there are 5 numbers."""
    if not isinstance(value, str) and np.shape(value) == (5,):
        five = real(value, name)
        if not np.isfinite(five).all():
            raise ValueError(f"{name} must be finite, not {value!r}")
        return cast(tuple[float, float, float, float, float], tuple(five.tolist()))
    return (*color(value, name), 0.0, 0.0)


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


def numbers(value: Any, name: str) -> npt.NDArray[Any]:
    """An array of real numbers of any kind, or an error."""
    try:
        array = np.asarray(value)
    except ValueError:
        raise ValueError(f"{name} must be an array of numbers with rows of equal length") from None
    if array.dtype.kind not in "biuf":
        raise TypeError(f"{name} must be real numbers, not {array.dtype}")
    return array


def real(value: Any, name: str) -> npt.NDArray[np.float64]:
    """An array of real numbers as float64, which is not copied if it is one already."""
    return numbers(value, name).astype(np.float64, copy=False)


def rows_of_floats(value: Any, name: str, columns: int) -> npt.NDArray[np.float32] | npt.NDArray[np.float64]:
    """A contiguous array (n, columns) of finite numbers, or ValueError: float32 stays float32, all other kinds become float64.

    Nothing is copied that has this layout already.
    """
    array = numbers(value, name)
    if array.dtype != np.float32:
        array = array.astype(np.float64, copy=False)
    if array.ndim != 2 or array.shape[1] != columns:
        if array.size == 0:
            return np.empty((0, columns))
        raise ValueError(f"{name} must have the shape (n, {columns}), not {array.shape}")
    # The extremes of an array with a NaN are NaN; unlike np.isfinite they take no memory.
    if array.size and not (np.isfinite(array.min()) and np.isfinite(array.max())):
        row = int((~np.isfinite(array).all(axis=1)).argmax())
        raise ValueError(f"{name}: row {row} is not finite: {array[row]}")
    return np.ascontiguousarray(array)


def finite_rows(value: Any, name: str, columns: int) -> npt.NDArray[np.float64]:
    """A contiguous array (n, columns) of finite numbers as float64, or ValueError."""
    return rows_of_floats(value, name, columns).astype(np.float64, copy=False)


def faces_of(faces: npt.ArrayLike) -> npt.NDArray[Any]:
    """A contiguous array of uint32, int32 or int64, which is not copied if it is one already."""
    array = np.asarray(faces)
    if array.ndim != 2 or array.shape[1] != 3:
        raise ValueError(f"faces must have the shape (m, 3), not {array.shape}")
    if array.dtype.kind not in "iu":
        raise TypeError(f"faces must be whole numbers, not {array.dtype}")
    if array.dtype not in (np.uint32, np.int32, np.int64):
        array = array.astype(np.int64)
    return np.ascontiguousarray(array)


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
    name = frame.f_code.co_filename
    return _cell(name) or name, frame.f_lineno


def _cell(name: str) -> str | None:
    """What a notebook calls the cell that it has compiled under a name: ``In[3]``."""
    if "IPython" not in sys.modules:
        return None
    shell = getattr(sys.modules["IPython"], "get_ipython", lambda: None)()
    label = getattr(getattr(shell, "compile", None), "format_code_name", lambda _: None)(name)
    return label[1] if label else None
