"""Atomic writes (a file is the old one or the new one, never a part), reads that can be cancelled, hashes."""

from __future__ import annotations

import contextlib
import errno
import hashlib
import json
import os
import secrets
import stat
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import BinaryIO

from .read_job import check

_ATTEMPTS = 16
_BLOCK = 1 << 20  # bytes between two checks for a cancel


def write_atomic(path: str | os.PathLike, write: Callable[[Path], object]) -> None:
    """Calls `write(temporary)` with a path beside `path`, then renames it; a failure leaves no trace.

    A link stays: its target is replaced.
    """
    path = Path(path)
    target = Path(os.path.realpath(path)) if path.is_symlink() else path
    temporary = _new_beside(target)
    try:
        write(temporary)
        os.replace(temporary, target)
    except BaseException as error:
        temporary.unlink(missing_ok=True)
        if isinstance(error, OSError) and error.errno and error.filename in (None, str(temporary)):
            raise OSError(error.errno, error.strerror, str(path)) from error
        raise


def _new_beside(path: Path) -> Path:
    """A new, empty file with a random name that no other machine uses in the same folder.

    Its permissions follow the umask, unlike those of mkstemp(), whose files are private. Errors name `path`.
    """
    for _ in range(_ATTEMPTS):
        temporary = path.with_name(f".{path.stem}-{secrets.token_hex(8)}{path.suffix}")
        try:
            os.close(os.open(temporary, os.O_CREAT | os.O_EXCL | os.O_WRONLY, 0o666))
        except FileExistsError:
            continue
        except OSError as error:
            raise OSError(error.errno, error.strerror, str(path)) from error
        return temporary
    raise FileExistsError(errno.EEXIST, os.strerror(errno.EEXIST), str(path))


def write_text(path: str | os.PathLike, text: str) -> None:
    write_atomic(path, lambda temporary: temporary.write_text(text, encoding="utf-8"))


def write_json(path: str | os.PathLike, report: dict) -> None:
    write_text(path, json_text(report) + "\n")


def json_text(report: dict) -> str:
    """Standard JSON. Raises ValueError for a number that is not finite, instead of writing NaN."""
    return json.dumps(report, indent=2, ensure_ascii=False, allow_nan=False)


def sha256(path: str | os.PathLike) -> str:
    """SHA-256 of the file in hexadecimal digits. Can be cancelled on the thread of a ReadJob."""
    digest = hashlib.sha256()
    for block in _blocks(path):
        digest.update(block)
    return digest.hexdigest()


def sha256_of(data: bytes) -> str:
    """Like sha256(), for bytes in memory."""
    digest, view = hashlib.sha256(), memoryview(data)
    for begin in range(0, len(view), _BLOCK):
        check()
        digest.update(view[begin : begin + _BLOCK])
    return digest.hexdigest()


def read_bytes(path: str | os.PathLike) -> bytes:
    """The whole file. Can be cancelled on the thread of a ReadJob."""
    return b"".join(_blocks(path))


def _blocks(path: str | os.PathLike) -> Iterator[bytes]:
    with open_regular(path) as file:
        while block := file.read(_BLOCK):
            check()
            yield block


@contextlib.contextmanager
def open_regular(path: str | os.PathLike) -> Iterator[BinaryIO]:
    """Opens a file for reading. Raises OSError unless it is a regular file: pipes wait for a writer, devices
    may never end."""
    # O_NONBLOCK: opening does not wait either.
    with open(
        path, "rb", opener=lambda name, flags: os.open(name, flags | getattr(os, "O_NONBLOCK", 0))
    ) as file:
        if not stat.S_ISREG(os.fstat(file.fileno()).st_mode):
            raise OSError(errno.EINVAL, "is not a regular file; choose a file", str(path))
        yield file
