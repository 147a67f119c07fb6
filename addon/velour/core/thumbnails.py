"""Thumbnails of measurements and models, cached by the content of the files."""

from __future__ import annotations

import contextlib
import csv
import functools
import hashlib
import json
import zipfile
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import NamedTuple

import numpy as np

from ..native import Btf, Measurement, Model, Scene, VelourError, library
from .ball import ball_job, ball_scene, shown
from .files import sha256, write_atomic, write_text
from .measurement_files import MeasurementFile

SIDE = 128  # pixels
_SAMPLES = 128
_TILES = 6  # tiles of a BTF from pole to pole
_MOST_BTF_BYTES = 1 << 30  # in memory
_VERSION = 1  # changes when thumbnails are made differently
_FACTS = ("kind", "format", "model", "isotropic", "texels")  # keys of info(), if present


class Thumbnail(NamedTuple):
    """`pixels` [SIDE x SIDE x 4] uint8, sRGB, opaque, row 0 at the bottom; None: there is no picture."""

    pixels: np.ndarray | None
    facts: dict  # the _FACTS of info()
    sentence: str | None  # why there is no picture


def thumbnail(file: MeasurementFile, cache: Path, check: Callable[[], object], threads: int = 1) -> Thumbnail:
    """The thumbnail cached below the folder `cache`, or a new one. Its sentence tells what is wrong with it.

    `check` is called ten times a second; it cancels by raising.
    """
    try:
        kept = thumbnail_folder(cache)
        digest = _digest(file, kept, check)
        return _kept(kept, digest) or _made(file, kept, digest, check, threads)
    except OSError as error:
        return Thumbnail(None, {}, f"{file.path} cannot be read ({error.strerror}); check the file.")
    except VelourError as error:
        if error.cancelled:
            raise
        return Thumbnail(None, {}, str(error))


def thumbnail_folder(cache: Path) -> Path:
    """Folder of the cached thumbnails; it may not exist."""
    return cache / f"thumbnails-{_VERSION}"


def _made(
    file: MeasurementFile, kept: Path, digest: str, check: Callable[[], object], threads: int
) -> Thumbnail:
    check()
    info = library.file_info(file.path)
    facts = {name: info[name] for name in _FACTS if name in info}
    if info["kind"] == "observation":
        return Thumbnail(None, facts, f"{file.path} is a scene usage file, not a material.")
    check()
    with ball_scene(functools.partial(_add, file.path, info["kind"]), _TILES) as scene:
        check()
        with ball_job(scene, SIDE, _SAMPLES, threads) as job:
            job.start().wait(lambda _state: check())
            linear = job.read_pass("Combined")
    made = Thumbnail(np.rint(shown(linear) * 255).astype(np.uint8), facts, None)
    with contextlib.suppress(OSError):  # the cache may not be writable
        _keep(_path(kept, digest), made)
    return made


def _add(path: str, kind: str, scene: Scene) -> int:
    if kind == "model":
        with Model.load(path) as model:
            return scene.add_model_material(model)
    if kind == "btf":
        with Btf.load(path) as btf:
            return scene.add_btf_material(btf, _MOST_BTF_BYTES)
    with Measurement.load(path) as measurement:
        return scene.add_measurement_material(measurement)


# ---- the cache: pictures by the hash of the file's content, hashes by its name, size and time


def _digest(file: MeasurementFile, kept: Path, check: Callable[[], object]) -> str:
    """SHA-256 of the content, read once for each state of the file."""
    if file.path.lower().endswith(".csv"):
        return _digest_of_set(Path(file.path), check)
    state = hashlib.sha256(repr(tuple(file)).encode("utf-8", "surrogateescape")).hexdigest()
    note = kept / "files" / state
    with contextlib.suppress(OSError, UnicodeDecodeError):
        digest = note.read_text(encoding="ascii")
        if len(digest) == 64 and digest.isalnum():
            return digest
    digest = sha256(file.path)
    with contextlib.suppress(OSError):
        note.parent.mkdir(parents=True, exist_ok=True)
        write_text(note, digest)
    return digest


def _digest_of_set(index: Path, check: Callable[[], object]) -> str:
    """SHA-256 of the index and of the sizes and times of its pictures, of which it does not tell the content:
    they are too many to be read."""
    digest = hashlib.sha256(sha256(index).encode())
    for number, name in enumerate(_pictures(index)):
        if number % 1000 == 0:
            check()
        with contextlib.suppress(OSError, ValueError):  # a missing picture does not matter to the digest
            state = (index.parent / name).stat()
            digest.update(f"{number} {state.st_size} {state.st_mtime_ns}\n".encode())
    return digest.hexdigest()


def _pictures(index: Path) -> Iterator[str]:
    """The names in the column "file", parsed as in the library; none from an index that it refuses."""
    with (
        open(index, encoding="utf-8-sig", errors="surrogateescape", newline="") as file,
        contextlib.suppress(csv.Error),
    ):
        lines = (line for line in file if line.strip() and not line.lstrip().startswith("#"))
        rows = csv.reader(lines, skipinitialspace=True)
        columns = [column.strip() for column in next(rows, ())]
        if "file" in columns:
            at = columns.index("file")
            yield from (row[at].strip() for row in rows if at < len(row))


def _kept(kept: Path, digest: str) -> Thumbnail | None:
    """The cached thumbnail; None if it is missing, incomplete or a foreign file."""
    try:
        with np.load(_path(kept, digest), allow_pickle=False) as arrays:
            pixels, facts = arrays["pixels"], json.loads(arrays["facts"].tobytes().decode())
    except (OSError, EOFError, KeyError, ValueError, zipfile.BadZipFile):
        return None
    if pixels.shape != (SIDE, SIDE, 4) or pixels.dtype != np.uint8 or not isinstance(facts, dict):
        return None
    return Thumbnail(pixels, facts, None)


def _keep(path: Path, made: Thumbnail) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    facts = np.frombuffer(json.dumps(made.facts).encode(), np.uint8)
    write_atomic(path, lambda temporary: np.savez_compressed(temporary, pixels=made.pixels, facts=facts))


def _path(kept: Path, digest: str) -> Path:
    return kept / f"{digest}.npz"
