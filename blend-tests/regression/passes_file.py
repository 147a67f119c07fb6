"""NAME.passes.npz beside a reference: its passes, which tell what has changed."""

from __future__ import annotations

import io
import json
from pathlib import Path

import numpy as np
from velour.core import files

from support.judge import Estimate

from . import reference
from .passes import MEASURED, Labels, Passes

_VERSION = 2
_AGAIN = "make the reference again with --update"


class PassesError(ValueError):
    """One sentence: why a reference has no causes."""


def passes_path(path: Path) -> Path:
    """`path`: of the reference's picture."""
    return path.with_suffix(".passes.npz")


def write(path: Path, passes: Passes) -> None:
    """Atomic. Call it after the picture of the reference has been written: it is bound to its bytes."""
    head = {"version": _VERSION, "picture": files.sha256(path), "seeds": passes.shape.seeds}
    arrays = {}
    for name in (*MEASURED, "world", "blurred"):
        found = getattr(passes, name)
        if found is not None:
            arrays[name] = reference.rounded_mean(found)
            arrays[f"{name}_error"] = reference.rounded_error(found)
    for name in ("objects", "materials"):
        labels = getattr(passes, name)
        arrays[name], head[name] = labels.numbers, list(labels.names)
        arrays[f"{name}_mostly"] = labels.mostly
    data = io.BytesIO()
    np.savez_compressed(data, head=np.frombuffer(json.dumps(head).encode(), np.uint8), **arrays)
    files.write_atomic(passes_path(path), lambda temporary: temporary.write_bytes(data.getvalue()))


def read(path: Path, size: tuple[int, int]) -> Passes:
    """`size`: height and width of the picture. Raises PassesError."""
    file = passes_path(path)
    if not file.is_file():
        raise PassesError(f"{path.name} has no {file.name} beside it: compared without causes; {_AGAIN}.")
    try:
        with np.load(file, allow_pickle=False) as arrays:
            found = {name: arrays[name] for name in arrays.files}
        head = json.loads(found.pop("head").tobytes())
        if head["version"] != _VERSION:
            raise PassesError(f"{file.name} has version {head['version']}, not {_VERSION}; {_AGAIN}.")
        if head["picture"] != files.sha256(path):
            sentence = f"{file.name} belongs to another {path.name}: compared without causes; {_AGAIN}."
            raise PassesError(sentence)
        return _passes(found, head, size)
    except PassesError:
        raise
    except Exception as error:  # damaged archives raise errors of many kinds
        raise PassesError(f"{file.name} cannot be read: compared without causes; {_AGAIN}.") from error


def _passes(arrays: dict[str, np.ndarray], head: dict, size: tuple[int, int]) -> Passes:
    """Raises KeyError or ValueError where something is missing or has the wrong size."""

    def known(name: str, channels: int) -> Estimate:
        mean, error = (arrays[key].astype(np.float64) for key in (name, f"{name}_error"))
        expected = (*(mean.shape[:2] if name == "world" else size), channels)
        if mean.shape != expected or error.shape != expected or not np.isfinite([mean, error]).all():
            raise ValueError(name)
        return Estimate(mean, error**2, head["seeds"], reference.STORED)

    labels = {}
    for name in ("objects", "materials"):
        numbers, mostly = (arrays[key] for key in (name, f"{name}_mostly"))
        for each in (numbers, mostly):
            if each.shape != size or each.max(initial=0) > len(head[name]):
                raise ValueError(name)
        labels[name] = Labels(numbers, tuple(head[name]), mostly)
    world = known("world", 3) if "world" in arrays else None
    blurred = known("blurred", 4) if "blurred" in arrays else None
    channels = dict(zip(MEASURED, (4, 2, 3), strict=True))
    measured = {name: known(name, count) for name, count in channels.items()}
    return Passes(**measured, **labels, world=world, blurred=blurred)
