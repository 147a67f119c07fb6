"""The cache folder, for results that can always be recomputed."""

from __future__ import annotations

import os
from pathlib import Path

_instead: Path | None = None


def keep_in(folder: str | os.PathLike) -> None:
    """Sets the folder for the rest of this process: extensions of Blender have one of their own."""
    global _instead
    _instead = Path(folder)


def user_cache_folder() -> Path:
    """${XDG_CACHE_HOME:-~/.cache}/velour, or the folder given to keep_in(); it may not exist."""
    if _instead is not None:
        return _instead
    base = os.environ.get("XDG_CACHE_HOME", "")
    # The XDG specification: a relative path counts as unset.
    return (Path(base) if os.path.isabs(base) else Path.home() / ".cache") / "velour"
