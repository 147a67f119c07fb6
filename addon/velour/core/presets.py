"""The preset library: its files, and its name in the user's preferences."""

from __future__ import annotations

import os
from pathlib import Path

NAME = "Velour Presets"
LIBRARY_FILE = "velour_presets.blend"
CATALOG_FILE = "blender_assets.cats.txt"
LICENCE_FILE = "LICENSE.txt"
AUTHOR, LICENCE = "The Velour authors", "CC0-1.0"
MOST_BYTES = 20_000_000  # total size of all files


def folder() -> Path:
    """Folder of the add-on's own copy; it may not exist."""
    return Path(__file__).resolve().parents[1] / "presets"


def is_built(path: str | os.PathLike) -> bool:
    return (Path(path) / LIBRARY_FILE).is_file()
