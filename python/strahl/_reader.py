"""Reads the JSON of ray trees into the classes of `strahl._tree`."""

from __future__ import annotations

import json
import math
from dataclasses import fields
from typing import Any, get_args, get_type_hints

from strahl._tree import Explanation

_HINTS: dict[type, dict[str, Any]] = {}


def _hints(of: type) -> dict[str, Any]:
    if of not in _HINTS:
        _HINTS[of] = get_type_hints(of)
    return _HINTS[of]


def _value(hint: Any, value: Any) -> Any:
    """A value of the JSON as its type wants it."""
    if value is None:
        # Infinities and NaN are null in JSON.
        return math.nan if hint is float else None
    options = [option for option in get_args(hint) if option is not type(None)]
    if isinstance(value, dict):
        of = hint if isinstance(hint, type) else next(o for o in options if isinstance(o, type))
        return _object(of, value)
    if isinstance(value, list):
        parts = options
        if getattr(hint, "__origin__", None) not in (list, tuple):
            hint = parts[0]
            parts = list(get_args(hint))
        items = [_value(parts[0], item) for item in value]
        return tuple(items) if getattr(hint, "__origin__", None) is tuple else items
    return value


def _object(of: type, data: dict[str, Any]) -> Any:
    hints = _hints(of)
    values = {}
    for field_ in fields(of):
        name = field_.name.rstrip("_")
        if name in data:
            values[field_.name] = _value(hints[field_.name], data[name])
    return of(_json=data, **values)


def read(text: str) -> Explanation:
    """An explanation from its JSON."""
    explanation: Explanation = _object(Explanation, json.loads(text))
    for sample in explanation.samples:
        by_number = {ray.id: ray for ray in sample.rays}
        for ray in sample.rays:
            object.__setattr__(ray, "_nodes", tuple(by_number[number] for number in ray.children))
    return explanation
