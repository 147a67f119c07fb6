"""The folder of a page: it is emptied of an earlier page, of nothing else, and belongs to one process."""

from __future__ import annotations

import fcntl
import shutil
from pathlib import Path
from typing import BinaryIO

MARK = ".velour-check"  # in every folder that a page was made in
MADE = ("index.html", "report.json", "pictures", "work", "new")  # what is made there


class RoomError(ValueError):
    """One sentence: why no page can be made there."""


def take(folder: Path) -> BinaryIO:
    """The folder is this process's until the file returned is closed. Raises RoomError or OSError."""
    if folder.is_dir() and any(folder.iterdir()) and not (folder / MARK).is_file():
        raise RoomError(f"{folder} holds something else than a page; empty it, or name another --output.")
    folder.mkdir(parents=True, exist_ok=True)
    mark = (folder / MARK).open("ab")
    try:
        fcntl.flock(mark, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError as error:
        mark.close()
        raise RoomError(f"Another run writes to {folder}; wait for it, or name another --output.") from error
    except OSError:
        pass  # a file system without locks
    for path in (folder / name for name in MADE):
        shutil.rmtree(path) if path.is_dir() else path.unlink(missing_ok=True)
    return mark
