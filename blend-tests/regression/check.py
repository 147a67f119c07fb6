"""A case rendered and judged, or its references made anew. What goes wrong is an outcome, no exception."""

from __future__ import annotations

import shutil
from pathlib import Path

import numpy as np
from velour.native import VelourError, images

from support.judge import BLOCK, Estimate, estimate

from . import reference
from .blender import BlenderError, Installation, notes
from .case import Case, Outcome, Settings
from .comparison import Comparison, compare

LEAST_SEEN = 1.0  # per cent of exposure that a comparison should tell


def check(case: Case, blender: Installation, settings: Settings, pictures: int) -> list[Outcome]:
    """`pictures`: of the whole run, which share one chance of a false alarm."""
    found = _rendered(case, blender, settings, update=False)
    if isinstance(found, Outcome):
        return [found]
    outcomes = [_judged(case, frame, renders, pictures) for frame, renders in found.items()]
    if all(outcome.passed for outcome in outcomes):
        shutil.rmtree(case.work, ignore_errors=True)  # what is left is to look into
    return outcomes


def update(
    case: Case, blender: Installation, settings: Settings, most_bytes: int | None = None
) -> list[Outcome]:
    """Writes the references of a case; refuses one of more than `most_bytes`."""
    found = _rendered(case, blender, settings, update=True)
    if isinstance(found, Outcome):
        return [found]
    return [_updated(case, frame, renders, most_bytes) for frame, renders in found.items()]


def _rendered(case: Case, blender: Installation, settings: Settings, update: bool) -> dict | Outcome:
    """Estimate by frame, or what is in the way."""
    seeds, pictures = settings.seed_list(update), case.work / "renders"
    try:
        shutil.rmtree(pictures, ignore_errors=True)
        pictures.mkdir(parents=True)
        task = {
            "blend": str(case.blend),
            "scripts": settings.scripts,
            "frames": list(case.references),
            "seeds": seeds,
            "samples": settings.samples,
            "folder": str(pictures),
        }
        blender.run("inside_render.py", task, case.work)
        return {frame: _estimate(pictures, frame, seeds) for frame in case.references}
    except (BlenderError, VelourError, OSError, ValueError) as error:
        return _outcome(case, None, False, f"{case.blend.name}: {error}")


def _estimate(folder: Path, frame: int | None, seeds: list[int]) -> Estimate:
    name = "own" if frame is None else frame
    found = estimate(images.read(folder / f"{name}-{seed}.exr") for seed in seeds)
    if not np.isfinite(found.variance).all():
        raise ValueError(f"frame {name} has pixels that are not finite; look at its materials and lights.")
    return found


def _judged(case: Case, frame: int | None, renders: Estimate, pictures: int) -> Outcome:
    path = case.references[frame]
    try:
        known = reference.read(path, renders)
    except ValueError as error:
        return _outcome(case, frame, False, f"{path.name}: {error}")
    comparison = compare(renders, known, pictures)
    outcome = _outcome(case, frame, comparison.agrees, describe(comparison))
    outcome.comparison = comparison
    outcome.ours, outcome.reference = renders.mean, known.mean
    if comparison.sees > LEAST_SEEN:
        outcome.notes.append(
            f"Too noisy to tell {LEAST_SEEN:g} % of exposure ({comparison.sees:.1f} %):"
            " give the scene more samples, or the check more --seeds."
        )
    if not reference.error_path(path).is_file():
        outcome.notes.append(f"{path.name} has no standard error beside it: taken as noisy as it looks.")
    return outcome


def describe(comparison: Comparison) -> str:
    numbers = (
        f"{comparison.percent:.2f} %, {comparison.z:.1f} standard errors of at most {comparison.limit:.1f}"
    )
    if comparison.agrees:
        return f"largest block difference {numbers}; sees {comparison.sees:.2f} % of exposure"
    left, bottom = (index * BLOCK for index in comparison.block)
    return (
        f"differs in {comparison.what}, most in the block {left} pixels from the left, {bottom} from below:"
        f" {numbers}; if the page shows what was meant, make the reference anew with --update"
    )


def _updated(case: Case, frame: int | None, renders: Estimate, most_bytes: int | None) -> Outcome:
    path = case.references[frame]
    reference.write(path, renders)
    size = sum(file.stat().st_size for file in (path, reference.error_path(path)))
    if most_bytes and size > most_bytes:
        sentence = (
            f"{path.name} and its error have {size} bytes, more than {most_bytes}; make the picture smaller."
        )
        return _outcome(case, frame, False, sentence)
    outcome = _outcome(case, frame, True, f"{path.name} and its error written, {size} bytes")
    outcome.ours = outcome.reference = renders.mean
    return outcome


def _outcome(case: Case, frame: int | None, passed: bool, sentence: str) -> Outcome:
    name = case.name if frame is None else f"{case.name}, frame {frame}"
    return Outcome(name, passed, sentence, case.quantity, notes=notes(case.work / "inside_render.log"))
