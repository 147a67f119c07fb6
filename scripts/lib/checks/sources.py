"""The files of the project, without git: sources may come from an archive, or belong to another user."""

from __future__ import annotations

import os
from fnmatch import fnmatch
from pathlib import Path


def sources(root: Path) -> list[str]:
    """Paths below `root` of all files that .gitignore does not match, sorted."""
    ignored = [".git", *(line.rstrip("/") for line in (root / ".gitignore").read_text().splitlines())]
    found = []

    def is_kept(path: Path) -> bool:
        place = f"/{path.relative_to(root)}"
        return not any(fnmatch(place if pattern[:1] == "/" else path.name, pattern) for pattern in ignored)

    for folder, folders, files in os.walk(root):
        folders[:] = [name for name in folders if is_kept(Path(folder, name))]
        found += [Path(folder, name) for name in files if is_kept(Path(folder, name))]
    return sorted(str(path.relative_to(root)) for path in found)
