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

import numpy as np
from conftest import ADDONS, ROOT

_FOLDER = ROOT / "build/test-cache"
_MAX_BUILDS = 3  # whose files are kept

# Over a tile's lowest point, by tile and sides: where views differ least. Captures find it in some seconds.
_REFERENCE_HEIGHTS = {
    ("corduroy", "one"): 0.0002718962205108255,
    ("net", "one"): 0.0015812499914318323,
    ("net", "two"): 0.0012374999932944775,
}


def captured(tile: str, texels: int, views: int, lights: int, samples: int, sides="one", seed=0) -> Path:
    """What `velour capture` of a tile writes."""
    from velour.native import Scene, Tile, capture_job, directions

    options = {"texels": texels, "samples": samples, "sides": sides, "seed": seed}
    height = _REFERENCE_HEIGHTS[tile, sides]

    def make(path: Path) -> None:
        with Scene() as scene, Tile.create(tile) as made:
            mesh, materials = made.add_to(scene)
            scene.add_instance(mesh, np.eye(3, 4), materials)
            scene.commit()
            info = made.info()
            place = {"origin": (0, 0), "period": info["period"], "source": tile}
            place["reference_height"] = info["heights"][0] + height
            towards = {"views": directions(str(views)), "lights": directions(str(lights))}
            with capture_job(scene, path, **place, **towards, **options) as job:
                job.run()

    return kept("capture.btf", (tile, views, lights, height, *options.items()), make)


def kept(name: str, recipe: tuple, make: Callable[[Path], None]) -> Path:
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
