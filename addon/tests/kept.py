"""Files that take long to make - captures, models - are made once and kept in the build folder.

A file is kept under a hash of how it was made: of its recipe, the add-on and the library. A change of one of
them makes it again; tests in other processes, and in later runs, share it.
"""

from __future__ import annotations

import fcntl
import functools
import hashlib
import os
import shutil
import tempfile
from collections.abc import Callable
from pathlib import Path

from conftest import ADDONS, ROOT

_FOLDER = ROOT / "build/test-cache"
_MAX_BUILDS = 3  # whose files are kept

LIGHTS = 40
CORDUROY = ("corduroy", "--texels", 12, "--lights", LIGHTS, "--samples", 16, "--sides", "one")


def captured(*arguments) -> Path:
    """What `velour capture` with these arguments writes."""
    from command_line import velour

    def make(path: Path) -> None:
        done = velour("capture", *arguments, "-o", path, "--quiet")
        assert done.status == 0, done.err

    return kept("capture.btf", ("capture", *map(str, arguments)), make)


def kept(name: str, recipe: tuple[str, ...], make: Callable[[Path], None]) -> Path:
    """The file or folder that make(path) makes, or has made before. It must not be changed.

    The recipe has all that the result depends on beside add-on and library; of files, what they hold.
    """
    folder = _folder_of_build() / hashlib.sha256(repr((name, recipe)).encode()).hexdigest()[:16]
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / name
    with open(folder / ".lock", "w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)  # of two that need it one makes it
        if not path.exists():
            with tempfile.TemporaryDirectory(dir=folder) as made:
                make(Path(made) / name)
                os.rename(Path(made) / name, path)
    return path


@functools.cache
def _folder_of_build() -> Path:
    """Removes the files of all builds but those that were tested last."""
    folder = _FOLDER / _hash_of_build()
    folder.mkdir(parents=True, exist_ok=True)
    os.utime(folder)
    builds = sorted(_FOLDER.iterdir(), key=lambda path: path.stat().st_mtime, reverse=True)
    for old in builds[_MAX_BUILDS:]:
        shutil.rmtree(old, ignore_errors=True)
    return folder


def _hash_of_build() -> str:
    """Also of the instruction set, on which fits depend."""
    from velour.native import library

    digest = hashlib.sha256(library.system()["simd"].encode())
    package = ADDONS / "velour"
    for path in sorted(path for path in package.rglob("*") if path.suffix in (".py", ".so")):
        digest.update(f"{path.relative_to(package)} {path.stat().st_size} ".encode())
        digest.update(path.read_bytes())
    return digest.hexdigest()[:16]
