"""Files that are either the old one or the new one, never a part."""

from __future__ import annotations

import hashlib
import json
import os
import tempfile
from collections.abc import Callable, Iterator
from pathlib import Path

from .read_job import check

_BLOCK = 1 << 20  # bytes between two looks whether they are still wanted


def write_atomic(path: str | os.PathLike, write: Callable[[Path], object]) -> None:
    """Calls `write(temporary)` with a name beside `path`, then renames it; leaves no trace of a failure."""
    path = Path(path)
    descriptor, name = tempfile.mkstemp(dir=path.parent, prefix=f".{path.stem}-", suffix=path.suffix)
    os.close(descriptor)
    temporary = Path(name)
    try:
        write(temporary)
        temporary.chmod(0o666 & ~_umask())  # mkstemp's 0600 is for secrets
        os.replace(temporary, path)
    except BaseException:
        temporary.unlink(missing_ok=True)
        raise


def write_text(path: str | os.PathLike, text: str) -> None:
    write_atomic(path, lambda temporary: temporary.write_text(text, encoding="utf-8"))


def write_json(path: str | os.PathLike, report: dict) -> None:
    write_text(path, json_text(report) + "\n")


def json_text(report: dict) -> str:
    """Standard JSON: a number that is not finite is an error, not the word NaN."""
    return json.dumps(report, indent=2, ensure_ascii=False, allow_nan=False)


def _umask() -> int:
    mask = os.umask(0)
    os.umask(mask)
    return mask


def sha256(path: str | os.PathLike) -> str:
    """Of the file's bytes, in hexadecimal digits. On the thread of a ReadJob a cancel ends it."""
    digest = hashlib.sha256()
    for block in _blocks(path):
        digest.update(block)
    return digest.hexdigest()


def sha256_of(data: bytes) -> str:
    """As sha256(), of bytes."""
    digest, view = hashlib.sha256(), memoryview(data)
    for begin in range(0, len(view), _BLOCK):
        check()
        digest.update(view[begin : begin + _BLOCK])
    return digest.hexdigest()


def read_bytes(path: str | os.PathLike) -> bytes:
    """All of the file. On the thread of a ReadJob a cancel ends it."""
    return b"".join(_blocks(path))


def _blocks(path: str | os.PathLike) -> Iterator[bytes]:
    with open(path, "rb") as file:
        while block := file.read(_BLOCK):
            check()
            yield block
