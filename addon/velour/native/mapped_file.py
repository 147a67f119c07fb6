"""Which files this process has mapped."""

from __future__ import annotations

from pathlib import Path

_MAPS = "/proc/self/maps"  # Linux; elsewhere nothing is known


def is_replaced(path: Path) -> bool:
    """Whether the process goes on with a file of this name that is no longer the one on disk."""
    try:
        with open(_MAPS, encoding="utf-8", errors="surrogateescape") as file:
            maps = file.read()
    except OSError:
        return False
    return path.exists() and f" {path.resolve()} (deleted)\n" in maps
