"""Which files this process has mapped."""

from __future__ import annotations

import ctypes
import mmap
from pathlib import Path

_MAPS = "/proc/self/maps"  # Linux; elsewhere nothing is known


def is_replaced(path: Path, function) -> bool:
    """Whether `function` (of ctypes) lies in another file than the one that is at `path` now.

    The system's name of the mapping proves nothing: an update may move the old file before deleting it. Nor
    do the numbers of stat(), which differ for devices of btrfs and overlays. So the file is mapped as well,
    and both mappings are compared.
    """
    with open(path, "rb") as file, mmap.mmap(file.fileno(), 1, access=mmap.ACCESS_COPY) as mapped:
        first = ctypes.c_char.from_buffer(mapped)
        try:
            now = _file_at(ctypes.addressof(first))
        finally:
            del first  # otherwise `mapped` cannot be closed
    return _file_at(ctypes.cast(function, ctypes.c_void_p).value) != now


def _file_at(address: int) -> tuple[str, str] | None:
    """Device and inode of the file that is mapped there; None: not known."""
    try:
        with open(_MAPS, encoding="utf-8", errors="surrogateescape") as file:
            lines = file.readlines()
    except OSError:
        return None
    for line in lines:
        span, _access, _offset, device, inode = line.split(maxsplit=5)[:5]
        begin, end = (int(bound, 16) for bound in span.split("-"))
        if begin <= address < end:
            return device, inode
    return None
