"""The cache folder, for results that can always be recomputed."""

from __future__ import annotations

import os
from pathlib import Path

_instead: Path | None = None


def keep_in(folder: str | os.PathLike) -> None:
    """Sets the folder for the rest of this process: extensions of Blender have one of their own."""
    global _instead
    _instead = Path(folder)


def user_cache_folder() -> Path | str:
    """${XDG_CACHE_HOME:-~/.cache}/velour, or the folder given to keep_in(); it may not exist.
    "": the user has no home folder."""
    if _instead is not None:
        return _instead
    base = os.environ.get("XDG_CACHE_HOME", "")
    if not os.path.isabs(base):  # the XDG specification: a relative path counts as unset
        base = os.path.expanduser("~/.cache")
    return Path(base) / "velour" if os.path.isabs(base) else ""
