"""Locates the test data and prepares files from them."""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
from pathlib import Path

from .velour_cli import ROOT

_EXPANDED = ROOT / "build/merl"
_SMOOTH = ROOT / "build/meshes"


class NoDataError(RuntimeError):
    """Its message is a sentence that names the missing data."""


def folder() -> Path:
    data = Path(os.environ.get("VELOUR_DATA", ROOT.parent / "shared/data"))
    if not data.is_dir():
        raise NoDataError(f"skipped, there is no test data in {data}; set VELOUR_DATA to its folder.")
    return data


def merl_names(data: Path) -> list[str]:
    return sorted(path.name.removesuffix(".nbrdf.npz") for path in (data / "brdf").glob("*.nbrdf.npz"))


def merl(data: Path, name: str) -> Path:
    """A MERL-layout file, expanded on first use. Concurrent callers may each expand it; it appears whole."""
    path = _EXPANDED / f"{name}.binary"
    if not path.is_file():
        _EXPANDED.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryDirectory(dir=_EXPANDED, prefix="partial-") as own:
            expand = [sys.executable, data / "brdf/expand_merl.py", own, name]
            subprocess.run(expand, check=True, stdout=subprocess.DEVNULL)
            os.replace(Path(own) / path.name, path)
    return path


def materials(data: Path) -> list[tuple[str, Path]]:
    """Names and files of all measurements in the data."""
    found = [(name, merl(data, name)) for name in merl_names(data)]
    for ending in ("bsdf", "brdf"):
        found += [(path.stem, path) for path in sorted((data / "brdf").glob(f"*.{ending}"))]
    return found


def mesh(data: Path, name: str) -> Path:
    """The mesh as one smoothing group: meshes of the data have neither normals nor smoothing groups."""
    source, path = data / f"mesh/{name}.obj", _SMOOTH / f"{name}.obj"
    if not path.is_file() or path.stat().st_mtime < source.stat().st_mtime:
        _SMOOTH.mkdir(parents=True, exist_ok=True)
        with tempfile.NamedTemporaryFile(dir=_SMOOTH, prefix="partial-", delete=False) as file:
            file.write(b"s 1\n" + source.read_bytes())
        os.replace(file.name, path)
    return path


def world(data: Path, name: str) -> Path:
    return data / f"hdr/{name}_1k.hdr"
