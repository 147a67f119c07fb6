"""The preset materials: a folder of models with previews and an index, and the asset library made of them."""

from __future__ import annotations

import json
import os
from pathlib import Path
from typing import NamedTuple

NAME = "Velour Presets"
INDEX_FILE = "presets.json"
LIBRARY_FILE = "velour_presets.blend"
CATALOG_FILE = "blender_assets.cats.txt"
LICENCE_FILE = "LICENSE.txt"
AUTHOR, LICENCE = "The Velour authors", "CC0-1.0"
MOST_BYTES = 20_000_000  # total size of all files


class Preset(NamedTuple):
    name: str
    model: Path
    picture: Path  # PNG, square
    catalog: str  # name of its catalog
    description: str
    tags: tuple[str, ...]
    repeats: int  # tiles per unit of texture coordinates; 0: not a texture


def folder() -> Path:
    """Folder of the add-on's own copy; it may not exist."""
    return Path(__file__).resolve().parents[1] / "presets"


def has_library(path: str | os.PathLike) -> bool:
    """Whether the folder contains the asset library."""
    return (Path(path) / LIBRARY_FILE).is_file()


def listed(path: str | os.PathLike | None = None) -> list[Preset]:
    """The presets of a folder, by default the add-on's, in the order of the index; none without one.

    Raises OSError, or ValueError for a damaged index.
    """
    home = Path(path) if path else folder()
    index = home / INDEX_FILE
    if not index.is_file():
        return []
    try:
        entries = json.loads(index.read_text(encoding="utf-8"))["presets"]
        return [_preset(home, entry) for entry in entries]
    except (KeyError, TypeError, AttributeError, json.JSONDecodeError) as error:
        raise ValueError(f"{index} is damaged ({error}); reinstall Velour.") from error


def _preset(home: Path, entry: dict) -> Preset:
    file = entry["file"]
    return Preset(
        entry["name"],
        home / f"{file}.velour",
        home / f"{file}.png",
        entry["catalog"],
        entry["description"],
        tuple(entry["tags"]),
        int(entry["repeats"]),
    )


def index_text(presets: list[Preset]) -> str:
    """Contents of the index file of `presets`."""
    entries = [
        {
            "name": preset.name,
            "file": preset.model.stem,
            "catalog": preset.catalog,
            "description": preset.description,
            "tags": list(preset.tags),
            "repeats": preset.repeats,
        }
        for preset in presets
    ]
    return json.dumps({"presets": entries}, indent=1, ensure_ascii=False) + "\n"
