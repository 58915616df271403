"""What the parts of ray trees have in common."""

from __future__ import annotations

from typing import Any


class Node:
    """What all parts of a tree have."""

    _json: dict[str, Any]

    def to_dict(self) -> dict[str, Any]:
        """The same as plain dictionaries and lists, as the JSON has them."""
        return dict(self._json)
