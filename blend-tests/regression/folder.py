"""A user's .blend files and the pictures beside them: NAME.exr, or NAME_0012.exr of frame 12."""

from __future__ import annotations

import os
import re
from collections.abc import Iterable
from pathlib import Path

from .case import Case

_PASSES = ".passes.npz"
_FRAME = r"_(\d{4,}|-\d{3,})(?=\.exr|$)"  # ends the name of the reference of a frame


class FolderError(ValueError):
    """One sentence."""


def cases(paths: Iterable[Path], work: Path, frames: list[int] | None = None) -> list[Case]:
    """In the order given, each file once. `frames`: that references are to be made of, whatever there is.
    A file that is gone, but for its reference, is one, too."""
    blends = dict.fromkeys(blend for path in paths for blend in [*_blends(path), *_lost(path)])
    return [
        Case(name, blend, _references(blend, frames), work / f"{number:03d}")
        for number, (name, blend) in enumerate(named(blends).items(), 1)
    ]


def named(blends: Iterable[Path]) -> dict[str, Path]:
    """Files by their paths in the folder that holds them all, without .blend: no two have one name."""
    blends = list(blends)
    base = os.path.commonpath([blend.parent for blend in blends]) if blends else ""
    return {str(blend.relative_to(base).with_suffix("")): blend for blend in blends}


def left_out(paths: Iterable[Path], checked: Iterable[Path]) -> int:
    """Number of .blend files at any depth of the folders that are not among those checked."""
    found = {blend for path in paths if path.is_dir() for blend in _absolute(path).rglob("*.blend")}
    return len(found.difference(checked))


def parent(path: Path) -> Path:
    """The folder that a path of the command line names, or that its .blend lies in."""
    return path if path.is_dir() else _blends(path)[0].parent


def own_reference(blend: Path) -> Path:
    """Path of the reference of the frame that the file was saved at."""
    return blend.with_suffix(".exr")


def _blends(path: Path) -> list[Path]:
    if path.is_dir():
        found = sorted(_absolute(path).glob("*.blend"))
        if not found:
            raise FolderError(f"{path} holds no .blend file; name a folder that does.")
        return found
    if path.suffix != ".blend" or not path.is_file():
        raise FolderError(f"{path} is neither a folder nor a .blend file.")
    return [_absolute(path)]


def _lost(path: Path) -> list[Path]:
    """Files that have references with passes in a folder, but are not there."""
    names = {each.name.removesuffix(_PASSES) for each in path.glob(f"*{_PASSES}")} if path.is_dir() else set()
    lost = {name for name in names if not (path / f"{name}.blend").is_file()}
    blends = {_absolute(path / f"{re.sub(_FRAME, '', name)}.blend") for name in lost}
    return sorted(blend for blend in blends if not blend.is_file())


def _absolute(path: Path) -> Path:
    """Links stay: references lie beside a link, and Blender looks there for relative paths."""
    return Path(os.path.abspath(path))


def _references(blend: Path, frames: list[int] | None) -> dict[int | None, Path]:
    if frames:
        return {frame: blend.with_name(f"{blend.stem}_{frame:04d}.exr") for frame in frames}
    found: dict[int | None, Path] = {}
    if own_reference(blend).is_file():
        found[None] = own_reference(blend)
    pattern = re.compile(re.escape(blend.stem) + _FRAME + r"\.exr")
    for path in sorted(blend.parent.iterdir()):
        match = pattern.fullmatch(path.name)
        # shot_0012.exr is that of shot_0012.blend, where there is one, not frame 12 of shot.blend.
        if match and not path.with_suffix(".blend").is_file():
            found[int(match[1])] = path
    return found
