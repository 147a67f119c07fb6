"""The library of presets: where it lies, and what it is called in users' preferences."""

from __future__ import annotations

import os
from pathlib import Path

NAME = "Velour Presets"
LIBRARY_FILE = "velour_presets.blend"
CATALOG_FILE = "blender_assets.cats.txt"
LICENCE_FILE = "LICENSE.txt"
AUTHOR, LICENCE = "The Velour authors", "CC0-1.0"
MOST_BYTES = 20_000_000  # of all files


def folder() -> Path:
    """Of the add-on's own copy; it need not be there."""
    return Path(__file__).resolve().parents[1] / "presets"


def is_built(path: str | os.PathLike) -> bool:
    return (Path(path) / LIBRARY_FILE).is_file()
