"""Images that Blender wrote: their pixels, and what their metadata say."""

from __future__ import annotations

import hashlib
from pathlib import Path

from velour.native import images


def digest(path: Path) -> str:
    """Hash of all pixels of all view layers, with the names of their channels; no metadata."""
    said = images.header(path)
    found = hashlib.sha256(repr((said["width"], said["height"], said["channels"])).encode())
    found.update(images.read(path).tobytes())
    return found.hexdigest()


def rendered_seconds(path: Path) -> float:
    """How long Blender rendered: its metadata are "00:02.25", or "01:00:02.25" from an hour on."""
    total = 0.0
    for part in images.header(path)["texts"]["RenderTime"].split(":"):
        total = 60 * total + float(part)
    return total
