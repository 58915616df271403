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

import json
from collections.abc import Iterator
from dataclasses import dataclass, field, fields
from html import escape
from typing import Any

from strahl import _strahl
from strahl._node import Node

Triple = tuple[float, float, float]
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

    def to_html(self, title: str = "", *, language: str = "en") -> str:
        """A page with the ray trees: the one of ``strahl explain --format html``, which has everything in it. ``language`` is ``"en"`` or ``"de"``."""
        return _strahl.explanation_page(json.dumps(self.to_dict()), self.pixel, title, language)

    def _repr_html_(self) -> str:
        # Names of objects come from scenes, so the page runs in a frame that cannot reach the notebook.
        style = "width: 100%; height: 480px; border: 1px solid rgb(128 128 128 / 40%); resize: vertical; overflow: auto"
        return f'<iframe sandbox="allow-scripts" style="{style}" srcdoc="{escape(self.to_html())}"></iframe>'

    def __repr__(self) -> str:
        rays = sum(len(sample.rays) for sample in self.samples)
        return f"<strahl.Explanation of pixel {self.pixel} with {len(self.samples)} samples and {rays} rays, total {self.total}>"

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
        waiting: list[TreeRay] = [self]
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
        text.append(f'\n\n@dataclass(frozen=True, kw_only=True)\nclass {name}(Node):\n    """{title}"""\n')
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
    return "".join(text)


def line(name: str, kind: str, told: str, default: bool = False) -> str:
    """A field of a class."""
    name += "_" * keyword.iskeyword(name)
    end = " = None" if default or kind.endswith("| None") else ""
    doc = f'    """{told}"""\n' if told else ""
    return f"    {name}: {kind}{end}\n{doc}"


if __name__ == "__main__":
    TARGET.write_text(make())
