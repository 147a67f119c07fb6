"""Writes the pictures of a chapter, and its numbers between the markers of its page."""

from __future__ import annotations

import re
from pathlib import Path

from bench.page import filled, replaced
from bench.project import ROOT, conditions
from PIL import Image
from velour.core import files

GUIDE = ROOT / "docs/guide"
MOST_BYTES = 150_000  # of a picture
_OF_PANELS = 2000  # maximum number of colors of panels; more are a render, which a palette would degrade
_PALETTES = (256, 128, 64)  # numbers of colors, the best first
_QUALITIES = (94, 90, 86, 80)
_PAGES = {"install": "preset", "tile": "cloth"}  # pages of chapters that have none of their own
_TAKEN = "Taken on {date}, commit {commit}, Blender {blender}.\n"
_PARTS = {
    "first_material": {
        "fit": "The paint of the pictures: {lobes} lobes, {bytes_size} in place of the\n"
        "{measurement_bytes_size} of the measurement, relative error {error:.3f}.\n"
    },
    "tolerance": {
        "tolerances": "| Max Error | Max Lobes | Lobes | Size | Relative error |\n"
        "*fits* | {tolerance:g} | {max_lobes} | {lobes} | {bytes_size} | {error:.3f} |\n"
    },
    "scene_model": {
        "scene": "The table of the pictures: {scene} bytes of parameters in place of {full},"
        " {full_times:.0f} times fewer.\n"
    },
    "tile": {
        "tile": "The weave of the pictures: the capture has {capture_bytes_size}, the material"
        " {model_bytes_size},\n{capture_times:.0f} times less. **Size** tells 1:{ratio:.0f}:"
        " that is beside the captured values alone, as half floats.\n"
        "With its silhouette the material has {outlined_bytes_size}.\n"
    },
}


def write(chapter: str, facts: dict) -> None:
    page = GUIDE / f"{_PAGES.get(chapter, chapter)}.md"
    text, values = page.read_text(encoding="utf-8"), _with_sizes({**conditions(0, 0), **facts})
    values["fits"] = [_with_sizes(fit) for fit in facts.get("fits", ())]
    for whole, part in (("full", "scene"), ("capture_bytes", "model_bytes")):
        if whole in facts:
            values[f"{whole.removesuffix('_bytes')}_times"] = facts[whole] / facts[part]
    for name, template in {"taken": _TAKEN, **_PARTS.get(chapter, {})}.items():
        text = replaced(text, name, filled(template, values))
    files.write_text(page, text)


def _with_sizes(values: dict) -> dict:
    """With each number of bytes as text, too."""
    sizes = {f"{name}_size": _size(value) for name, value in values.items() if name.endswith("bytes")}
    return values | sizes


def _size(count: int) -> str:
    if count >= 1_000_000:
        return f"{count / 1e6:.3g} MB"
    return f"{count / 1000:.1f} kB" if count < 100_000 else f"{count / 1000:.0f} kB"


def keep(path: Path, folder: Path) -> Path:
    """Saves a picture at the best quality within MOST_BYTES: panels as PNG with a palette, renders as JPEG
    without chroma subsampling, for the text of panels. Returns the file."""
    with Image.open(path) as opened:
        picture = opened.convert("RGB")
    is_render = picture.getcolors(_OF_PANELS) is None
    kinds = ("jpg", "png") if is_render else ("png", "jpg")
    to, other = (folder / f"{path.stem}.{kind}" for kind in kinds)
    folder.mkdir(parents=True, exist_ok=True)
    for level in _QUALITIES if is_render else _PALETTES:
        if is_render:
            picture.save(to, quality=level, subsampling=0)
        else:
            picture.quantize(level, method=Image.Quantize.MEDIANCUT).save(to, optimize=True)
        size = to.stat().st_size
        if size <= MOST_BYTES:
            print(f"  {to.name}: {picture.width} x {picture.height}, {size // 1000} kB", flush=True)
            other.unlink(missing_ok=True)
            return to
    raise SystemExit(f"guide: {to} has {size} bytes; {MOST_BYTES} is the most for a page.")


def link(picture: Path) -> None:
    """Updates the links to a picture in all pages: its file type may have changed."""
    for page in GUIDE.glob("*.md"):
        text = page.read_text(encoding="utf-8")
        linked = re.sub(rf"\(images/{picture.stem}\.\w+\)", f"(images/{picture.name})", text)
        if linked != text:
            files.write_text(page, linked)
