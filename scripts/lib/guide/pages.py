"""Writes the numbers of a chapter between the markers of its page."""

from __future__ import annotations

import re
from pathlib import Path

from bench.page import replaced, table
from bench.provenance import conditions
from bench.velour_cli import ROOT
from velour.core import files

GUIDE = ROOT / "docs/guide"


def write(chapter: str, facts: dict) -> None:
    page = GUIDE / f"{_PAGES.get(chapter, chapter)}.md"
    text = page.read_text(encoding="utf-8")
    parts = {
        "taken": _taken(facts),
        **{name: part(facts) for name, part in _PARTS.get(chapter, {}).items()},
    }
    for name, part in parts.items():
        text = replaced(text, name, part, "guide")
    files.write_text(page, text)


def link(picture: Path) -> None:
    """Updates the links to a picture in all pages: its file type may have changed."""
    for page in GUIDE.glob("*.md"):
        text = page.read_text(encoding="utf-8")
        linked = re.sub(rf"\(images/{picture.stem}\.\w+\)", f"(images/{picture.name})", text)
        if linked != text:
            files.write_text(page, linked)


def _taken(facts: dict) -> str:
    c = conditions(0, 0)
    return f"Taken on {c['date']}, commit {c['commit']}, Blender {facts['blender']}.\n"


def _first_material(facts: dict) -> str:
    return (
        f"The paint of the pictures: {facts['lobes']} lobes, {_kb(facts['bytes'])} in place of the\n"
        f"{_kb(facts['measurement_bytes'])} of the measurement, relative error {facts['error']:.3f}.\n"
    )


def _tolerances(facts: dict) -> str:
    rows = (row | {"size": _kb(row["bytes"])} for row in facts["fits"])
    titles = "Max Error | Max Lobes | Lobes | Size | Relative error"
    return table(rows, titles, "{tolerance:g} | {max_lobes} | {lobes} | {size} | {error:.3f}")


def _scene(facts: dict) -> str:
    full, scene = facts["full"], facts["scene"]
    share = f"{full / scene:.0f} times fewer"
    return f"The table of the pictures: {scene} bytes of parameters in place of {full}, {share}.\n"


def _tile(facts: dict) -> str:
    return (
        f"The weave of the pictures: the capture has {_mb(facts['capture_bytes'])}, the material"
        f" {_mb(facts['model_bytes'])},\n{facts['capture_bytes'] / facts['model_bytes']:.0f} times less."
        f" **Size** tells 1:{facts['ratio']:.0f}: that is beside the captured values alone, as half floats.\n"
        f"With its silhouette the material has {_mb(facts['outlined_bytes'])}.\n"
    )


_PAGES = {"install": "preset", "tile": "cloth"}  # pages of chapters that have none of their own
_PARTS = {
    "first_material": {"fit": _first_material},
    "tolerance": {"tolerances": _tolerances},
    "scene_model": {"scene": _scene},
    "tile": {"tile": _tile},
}


def _kb(count: int) -> str:
    return f"{count / 1000:.1f} kB" if count < 100_000 else f"{count / 1000:.0f} kB"


def _mb(count: int) -> str:
    return f"{count / 1e6:.3g} MB"
