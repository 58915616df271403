"""What pictures cost: heat maps and comparisons of accelerators."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt


class HeatMap(np.ndarray[Any, np.dtype[np.float64]]):
    """(h, w) float64: the cost of each pixel, as `Scene.heatmap` measures it. It is an array like any other, and can become a data frame."""

    metric: str
    """What is counted: ``"tests"``, ``"steps"``, ``"rays"``, ``"depth"`` or ``"time"`` (microseconds)."""
    _columns: dict[str, npt.NDArray[Any]] | None

    @classmethod
    def _of(cls, metric: str, columns: dict[str, npt.NDArray[Any]]) -> HeatMap:
        self = columns[metric].astype(np.float64).view(cls)
        self.metric, self._columns = metric, columns
        return self

    def __array_finalize__(self, source: object) -> None:
        # What is computed from a map or cut out of it has no columns: its entries are other pixels, or none.
        self.metric, self._columns = getattr(source, "metric", ""), None

    def to_dataframe(self) -> Any:
        """A pandas.DataFrame with a row for each pixel: x, y, and what all metrics say of it. It needs pandas."""
        import pandas  # type: ignore[import-not-found,import-untyped,unused-ignore]

        if self._columns is None:
            raise ValueError("only what Scene.heatmap returns can become a data frame, not a part of it")
        y, x = np.indices(self.shape)
        columns = {name: values.ravel() for name, values in self._columns.items()}
        return pandas.DataFrame({"x": x.ravel(), "y": y.ravel(), **columns})


class Comparison(list[dict[str, Any]]):
    """The rows of `Scene.compare`: a list of dictionaries, one for each accelerator."""

    def to_dataframe(self) -> Any:
        """A pandas.DataFrame with the accelerators as its index. It needs pandas."""
        import pandas  # type: ignore[import-not-found,import-untyped,unused-ignore]

        return pandas.DataFrame(self).set_index("accelerator")
