"""Every public name is documented, arrays with their shapes and types."""

from __future__ import annotations

import inspect
import re
from collections.abc import Iterator
from typing import Any

import pytest

import strahl

# Methods that Python itself or a notebook calls.
SPECIAL = re.compile(r"_")


def _public() -> Iterator[tuple[str, Any, Any]]:
    """Name, thing and what has the documentation: functions, classes, their methods and properties."""
    for name in strahl.__all__:
        thing = getattr(strahl, name)
        if inspect.isfunction(thing) or inspect.isbuiltin(thing):
            yield name, thing, thing
        elif inspect.isclass(thing):
            yield name, thing, thing
            for member in dir(thing):
                value = inspect.getattr_static(thing, member)
                if SPECIAL.match(member) or getattr(value, "__objclass__", None) in (list, tuple, dict, BaseException, ValueError, UserWarning, Warning):
                    continue
                function = getattr(value, "__func__", None) or getattr(value, "fget", None) or getattr(value, "func", None) or value
                if inspect.isfunction(function) and function.__module__.startswith("strahl"):
                    yield f"{name}.{member}", function, function


PUBLIC = {name: (thing, documented) for name, thing, documented in _public()}


def test_there_are_public_names() -> None:
    assert len(PUBLIC) > 200, len(PUBLIC)
    for name in ("Film.rgb", "Hits.t", "Scene.render", "Scene.intersect", "Object.translate", "Pattern.image", "Camera.mesh", "mesh", "terrain"):
        assert name in PUBLIC, name


@pytest.mark.parametrize("name", PUBLIC)
def test_public_names_are_documented(name: str) -> None:
    thing, documented = PUBLIC[name]
    text = inspect.getdoc(documented) or ""
    assert text.strip().endswith((".", "]", ")", ":")) and len(text) > 10, text
    if inspect.isfunction(thing):
        returned = str(thing.__annotations__.get("return", ""))
        if "NDArray" in returned:
            assert re.search(r"\(.*\)", text), f"the shape of the array is missing: {text}"
            assert re.search(r"float32|float64|int32|int64|uint8|bool", text), f"the type of the array is missing: {text}"
        if any("ArrayLike" in str(kind) for argument, kind in thing.__annotations__.items() if argument != "return"):
            assert re.search(r"\((?:\.\.\.|(?:\w+|\.\.\.), ?\w*(?:, ?\w+)*)\)", text), f"the shape of an argument is missing: {text}"
