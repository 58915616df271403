"""Writes `strahl/_tree.py` from the schema of ray trees, `crates/strahl-render/src/explanation.rs`.

Run it after a change of the schema: ``python python/tools/tree_classes.py``. A test compares the file with what this makes.
"""

from __future__ import annotations

import keyword
import re
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
SCHEMA = ROOT / "crates/strahl-render/src/explanation.rs"
TARGET = ROOT / "python/strahl/_tree.py"

HEAD = '''"""The ray trees of a pixel as objects: the schema of ``strahl explain --format json``.

This file is made by ``python/tools/tree_classes.py`` from the schema in Rust.

Points, directions and colours are tuples of three numbers; colours are linear. Fields are named as in the formulas of the documentation.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, field, fields
from typing import Any, ClassVar, get_args, get_type_hints

Triple = tuple[float, float, float]


class _Node:
    """What all parts of a tree have."""

    def to_dict(self) -> dict[str, Any]:
        """The same as plain dictionaries and lists, as the JSON has them."""
        return dict(self._json)  # type: ignore[attr-defined]
'''

TAIL = '''
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


def read(data: dict[str, Any]) -> Explanation:
    """An explanation from its JSON."""
    explanation: Explanation = _object(Explanation, data)
    for sample in explanation.samples:
        by_number = {ray.id: ray for ray in sample.rays}
        for ray in sample.rays:
            object.__setattr__(ray, "_nodes", tuple(by_number[number] for number in ray.children))
    return explanation
'''

# What is more useful in Python than the bare data.
METHODS = {
    "Explanation": '''
    @property
    def total(self) -> Triple:
        """The linear colour before rounding: the mean of what the samples bring, or what the sampling makes of them."""
        return self.color

    @property
    def root(self) -> TreeRay:
        """The ray from the eye of the first sample."""
        return self.samples[0].root

    def to_networkx(self) -> Any:
        """A networkx.DiGraph of all rays: nodes (sample, ray) with the fields of `TreeRay`, edges from rays to those they sent. It needs networkx."""
        import networkx  # type: ignore[import-not-found,import-untyped,unused-ignore]

        graph = networkx.DiGraph(pixel=self.pixel)
        for sample in self.samples:
            for ray in sample.rays:
                values = {f.name: getattr(ray, f.name) for f in fields(ray) if not f.name.startswith("_")}
                graph.add_node((sample.sample, ray.id), **values)
            for ray in sample.rays:
                for child in ray.children:
                    graph.add_edge((sample.sample, ray.id), (sample.sample, child))
        return graph
''',
    "Sample": '''
    @property
    def root(self) -> TreeRay:
        """The primary ray."""
        return self.rays[0]
''',
    "TreeRay": '''
    @property
    def nodes(self) -> tuple[TreeRay, ...]:
        """The rays it sent."""
        return self._nodes

    def walk(self) -> Iterator[TreeRay]:
        """This ray and all that came of it, depth first."""
        waiting = [self]
        while waiting:
            ray = waiting.pop()
            yield ray
            waiting.extend(reversed(ray._nodes))
''',
}

PLAIN = {"String": "str", "&'static str": "str", "bool": "bool", "f64": "float", "f32": "float", "Triple": "Triple"}
PLAIN |= {name: "int" for name in ("u8", "u16", "u32", "u64", "usize")}


def python_type(rust: str) -> str:
    """The type of a field in Python."""
    if rust in PLAIN:
        return PLAIN[rust]
    if found := re.fullmatch(r"Option<(.*)>", rust):
        return f"{python_type(found[1])} | None"
    if found := re.fullmatch(r"Vec<(.*)>", rust):
        return f"list[{python_type(found[1])}]"
    if found := re.fullmatch(r"\[(.*); (\d)\]", rust):
        return f"tuple[{', '.join([python_type(found[1])] * int(found[2]))}]"
    if not re.fullmatch(r"[A-Z]\w*", rust):
        raise ValueError(f"unknown type {rust} in {SCHEMA}")
    return rust


def parts(body: str) -> list[tuple[str, str, str, bool]]:
    """Name, type, documentation and whether it is flattened, of each field."""
    found, doc, flat = [], [], False
    for line in body.splitlines():
        line = line.strip()
        if line.startswith("///"):
            doc.append(line[3:].strip())
        elif line == "#[serde(flatten)]":
            flat = True
        elif hit := re.fullmatch(r"(?:pub )?(\w+): (.*),", line):
            found.append((hit[1], hit[2], " ".join(doc), flat))
            doc, flat = [], False
    return found


def make() -> str:
    """The text of the file."""
    source = SCHEMA.read_text()
    structs = re.findall(r"((?:^///[^\n]*\n)+)((?:^#[^\n]*\n)*)^pub struct (\w+) \{\n(.*?)^\}", source, re.M | re.S)
    enums = {
        name: re.findall(r"^    (\w+) \{(.*?)\}", body, re.M | re.S)
        for name, body in re.findall(r"^pub enum (\w+) \{\n(.*?)^\}", source, re.M | re.S)
    }
    text = [HEAD]
    for doc, _, name, body in structs:
        title = " ".join(line.removeprefix("///").strip() for line in doc.strip().splitlines())
        text.append(f'\n\n@dataclass(frozen=True, kw_only=True)\nclass {name}(_Node):\n    """{title}"""\n')
        for field, rust, explained, flat in parts(body):
            if not flat:
                text.append(line(field, python_type(rust), explained))
                continue
            # The variants of an enum side by side: what a variant hasn't is None.
            variants = [parts(variant) for _, variant in enums[rust]]
            seen: dict[str, tuple[str, str, int]] = {}
            for variant in variants:
                for inner, kind, told, _ in variant:
                    count = seen[inner][2] + 1 if inner in seen else 1
                    base = python_type(kind)
                    known = seen.get(inner, (base, told, 0))
                    seen[inner] = (known[0], known[1], count)
            for inner, (kind, told, count) in seen.items():
                everywhere = count == len(variants)
                if not everywhere and not kind.endswith("| None"):
                    kind += " | None"
                text.append(line(inner, kind, told, default=not everywhere))
        if name == "TreeRay":
            text.append("    _nodes: tuple[TreeRay, ...] = field(default=(), repr=False, compare=False)\n")
        text.append("    _json: dict[str, Any] = field(repr=False, compare=False)\n")
        text.append(METHODS.get(name, ""))
    text.append("\n")
    text.append(TAIL)
    return "".join(text).replace("Any, ClassVar, get_args", "Any, get_args")


def line(name: str, kind: str, told: str, default: bool = False) -> str:
    """A field of a class."""
    name += "_" * keyword.iskeyword(name)
    end = " = None" if default or kind.endswith("| None") else ""
    doc = f'    """{told}"""\n' if told else ""
    return f"    {name}: {kind}{end}\n{doc}"


if __name__ == "__main__":
    TARGET.write_text(make())
