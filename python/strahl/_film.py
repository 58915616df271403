"""Pictures."""

from __future__ import annotations

import os
from functools import cached_property
from typing import Any

import numpy as np
import numpy.typing as npt

from strahl import _strahl


class Film:
    """A finished picture: linear colours and, if they were asked for, further layers.

    Arrays have the rows of the picture from the top, so ``film.rgb[y, x]`` is the pixel in column x and row y. They cannot be written to; make a
    copy to change one. With ``region`` they hold that part of the picture only.
    """

    def __init__(self, core: _strahl.Film, seconds: float) -> None:
        self._core = core
        self.seconds: float = seconds
        """Seconds that the picture took, without compiling the scene."""

    @property
    def region(self) -> tuple[int, int, int, int]:
        """x, y, width and height of the part of the picture that the film holds, in pixels."""
        return self._core.region

    @property
    def size(self) -> tuple[int, int]:
        """Width and height of the whole picture in pixels."""
        return self._core.size

    @property
    def width(self) -> int:
        """Columns of the arrays."""
        return self._core.region[2]

    @property
    def height(self) -> int:
        """Rows of the arrays."""
        return self._core.region[3]

    @property
    def rays(self) -> dict[str, int]:
        """Number of rays traced: primary, shadow, reflection, transparency, total, hits."""
        return self._core.rays

    @cached_property
    def rgb(self) -> npt.NDArray[np.float32]:
        """(h, w, 3) float32: linear Rec. 709 colours, 0 is black and 1 the white of the screen; no copy is made."""
        return self._core.pixels.reshape(self.height, self.width, 3)

    @cached_property
    def alpha(self) -> npt.NDArray[np.float32] | None:
        """(h, w) float32: how much each pixel covers what lies behind the picture, 1 is opaque; None without ``alpha=True``."""
        alpha = self._core.alpha
        return None if alpha is None else alpha.reshape(self.height, self.width)

    def _layer(self, name: str, *more: int) -> npt.NDArray[Any]:
        values = getattr(self._core, name)()
        if values is None:
            raise ValueError("the film has no layers: render with layers=True")
        array: npt.NDArray[Any] = values.reshape(self.height, self.width, *more)
        return array

    @cached_property
    def depth(self) -> npt.NDArray[np.float32]:
        """(h, w) float32: distance from the eye, infinite for the background. Layers are those of the first ray of each pixel."""
        return self._layer("depth")

    @cached_property
    def normal(self) -> npt.NDArray[np.float32]:
        """(h, w, 3) float32: unit normal for shading, towards the viewer; zero for the background."""
        return self._layer("normal", 3)

    @cached_property
    def position(self) -> npt.NDArray[np.float32]:
        """(h, w, 3) float32: position in the world; zero for the background."""
        return self._layer("position", 3)

    @cached_property
    def object_id(self) -> npt.NDArray[np.int32]:
        """(h, w) int32: number of the object, for `Scene.object_name`; -1 for the background."""
        return self._layer("object")

    @cached_property
    def material_id(self) -> npt.NDArray[np.int32]:
        """(h, w) int32: number of the material; -1 for the background."""
        return self._layer("material")

    @cached_property
    def tree_depth(self) -> npt.NDArray[np.int32]:
        """(h, w) int32: deepest level of the ray tree; 1 is the ray from the eye."""
        return self._layer("tree_depth")

    @cached_property
    def tests(self) -> npt.NDArray[np.int32]:
        """(h, w) int32: objects tested for the ray tree."""
        return self._layer("tests")

    @cached_property
    def sha256(self) -> str:
        """Checksum of the bits of `rgb`: the one that ``strahl render --stats`` prints, in 64 hexadecimal digits."""
        return self._core.sha256()

    def to_srgb8(self) -> npt.NDArray[np.uint8]:
        """(h, w, 3) uint8: sRGB codes, as a PNG holds them and screens want them. Values outside of 0 to 1 are clipped."""
        return self._core.to_srgb8().reshape(self.height, self.width, 3)

    def save(self, path: str | os.PathLike[str], *, bit_depth: int | None = None) -> None:
        """Writes the picture; the ending of the name chooses the format: png, exr, hdr, ppm, jpg, tga, bmp.

        OpenEXR gets the linear colours and all layers, the others sRGB codes; ``bit_depth`` of PNG and PPM is 8 or 16. The file appears when it is
        complete. Raises OSError if it can't be written and ValueError for an unknown format.
        """
        self._core.save(os.fspath(path), bit_depth)

    def _repr_png_(self) -> bytes:
        return self._core.png()

    def __array__(self, dtype: Any = None, copy: bool | None = None) -> npt.NDArray[Any]:
        if dtype is None or np.dtype(dtype) == np.float32:
            return self.rgb.copy() if copy else self.rgb
        return self.rgb.astype(dtype)

    def __repr__(self) -> str:
        total = self.rays["total"]
        return f"<strahl.Film {self.width}x{self.height}, {total} rays in {self.seconds:.2f} s>"
