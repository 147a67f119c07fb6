"""A case rendered and judged, or its references made again. What goes wrong is an outcome, no exception."""

from __future__ import annotations

import shutil
import traceback
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import NamedTuple

import numpy as np
from velour.native import VelourError, images

from support.judge import BLOCK, Estimate, estimate

from . import causes, passes_file, reference
from .blender import BlenderError, Installation, notes
from .case import Case, Outcome, Settings
from .comparison import Comparison, compare
from .passes import Passes
from .renders import read_renders

LEAST_SEEN = 1.0  # per cent of exposure that a comparison should tell


class Renders(NamedTuple):
    picture: Estimate
    passes: Passes | None  # None: not asked for


def check(case: Case, blender: Installation, settings: Settings, pictures: int) -> Iterator[Outcome]:
    """`pictures`: of the whole run, which share one chance of a false alarm."""
    passed = True
    for outcome in rendered(
        case, blender, settings, False, lambda frame, renders: judged(case, frame, renders, pictures)
    ):
        passed &= outcome.passed
        yield outcome
    if passed:
        shutil.rmtree(case.work, ignore_errors=True)  # what is left is to look into


def update(
    case: Case, blender: Installation, settings: Settings, most_bytes: int | None = None
) -> Iterator[Outcome]:
    """Writes the references of a case; refuses one of more than `most_bytes`."""
    return rendered(
        case, blender, settings, True, lambda frame, renders: written(case, frame, renders, most_bytes)
    )


def rendered(
    case: Case,
    blender: Installation,
    settings: Settings,
    update: bool,
    outcome_of: Callable[[int | None, Renders], Outcome],
) -> Iterator[Outcome]:
    """Renders the frames of a case, reads them one by one, so that one is held, and removes them."""
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
            "passes": settings.passes,
            "folder": str(pictures),
        }
        layer = blender.run("inside_render.py", task, case.work)["layer"]
    except (BlenderError, OSError) as error:
        yield _failure(case, None, error)
        return
    for frame in case.references:
        try:
            outcome = outcome_of(frame, read_frame(pictures, frame, seeds, layer))
        except Exception as error:  # trouble with one frame stops no other
            outcome = _failure(case, frame, error)
        yield outcome
    shutil.rmtree(pictures, ignore_errors=True)


def read_frame(folder: Path, frame: int | None, seeds: list[int], layer: str | None) -> Renders:
    """`layer`: of the passes; None without."""
    name = "own" if frame is None else frame
    paths = [folder / f"{name}-{seed}.exr" for seed in seeds]
    if layer is None:
        found = Renders(estimate(images.read(path) for path in paths), None)
    else:
        beside = [[path.with_name(f"{what}-{path.name}") for path in paths] for what in ("world", "sharp")]
        worlds, sharp = (files if files[0].is_file() else [] for files in beside)
        found = Renders(*read_renders(paths, worlds, sharp, layer))
    if not np.isfinite(found.picture.variance).all():
        raise ValueError(f"frame {name} has pixels that are not finite; look at its materials and lights.")
    return found


def judged(case: Case, frame: int | None, renders: Renders, pictures: int) -> Outcome:
    path, remarks = case.references[frame], []
    try:
        known = reference.read(path, renders.picture)
    except ValueError as error:
        return _outcome(case, frame, False, f"{path.name}: {error}")
    both = None
    if renders.passes:
        try:
            both = renders.passes, passes_file.read(path, known.mean.shape[:2])
        except passes_file.PassesError as error:
            remarks.append(str(error))
    comparison = compare(renders.picture, known, pictures, both)
    outcome = _outcome(case, frame, comparison.agrees, describe(comparison))
    outcome.comparison = comparison
    outcome.ours, outcome.reference = renders.picture.mean, known.mean
    outcome.notes += remarks
    if both and not comparison.agrees:
        outcome.causes = causes.find(renders.picture, known, both)
        outcome.sentence = f"{'; '.join(map(str, outcome.causes))}. It {outcome.sentence}"
    if np.isinf(comparison.sees):
        outcome.notes.append("It is black: no exposure can be told.")
    elif comparison.sees > LEAST_SEEN:
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
    place = ""
    if comparison.block:
        left, bottom = (index * BLOCK for index in comparison.block)
        place = f", most in the block {left} pixels from the left, {bottom} from below"
    alone = " alone, the colors agree" if comparison.picture_agrees else ""
    return (
        f"differs in {comparison.what}{alone}{place}:"
        f" {numbers}; if the page shows what was meant, make the reference again with --update"
    )


def write(path: Path, renders: Renders) -> int:
    """A reference, its passes last: they are bound to the picture. Returns the bytes of its files."""
    reference.write(path, renders.picture)
    written = [path, reference.error_path(path)]
    if renders.passes:
        passes_file.write(path, renders.passes)
        written.append(passes_file.passes_path(path))
    return sum(file.stat().st_size for file in written)


def written(case: Case, frame: int | None, renders: Renders, most_bytes: int | None = None) -> Outcome:
    """Writes a reference."""
    path = case.references[frame]
    size = write(path, renders)
    if most_bytes and size > most_bytes:
        sentence = (
            f"{path.name} and its error have {size} bytes, more than {most_bytes}; make the picture smaller."
        )
        return _outcome(case, frame, False, sentence)
    outcome = _outcome(case, frame, True, f"{path.name} written, {size} bytes with its error")
    outcome.ours = outcome.reference = renders.picture.mean
    return outcome


def _failure(case: Case, frame: int | None, error: Exception) -> Outcome:
    if not isinstance(error, (BlenderError, VelourError, OSError, ValueError)):
        traceback.print_exception(error)
    return _outcome(case, frame, False, f"{case.blend.name}: {str(error) or type(error).__name__}")


def _outcome(case: Case, frame: int | None, passed: bool, sentence: str) -> Outcome:
    name = case.name if frame is None else f"{case.name}, frame {frame}"
    return Outcome(name, passed, sentence, case.quantity, notes=notes(case.work / "inside_render.log"))
