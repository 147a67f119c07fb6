"""The dissertation's figures 7.11 to 7.13: its strategy and numbers of samples, compared with references."""

from __future__ import annotations

import sys
from dataclasses import dataclass
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))

import figure_check
import figure_check_text
import figure_scenes
import figures_sheet
import figures_text
import numpy as np
import script
import uniform_moments
from fit_error import fit_error
from reference import Reference
from renders import Picture, Renders, Settings
from scenes import Scene
from velour_cli import ROOT

WORLD = "venice_sunset"
# Half of the directions from the environment, with the dissertation's densities and random numbers or ours.
HALF = {"heuristic": "balance", "share": 0.5}
SAMPLERS = {"dissertation": HALF | {"strategy": "mis-dissertation"}, "default": HALF | {"strategy": "mis"}}
BEST = {"strategy": "product"}
# Minimum ratio of the smallest error of the dissertation's strategy to the reference's own error.
MARGIN = 10.0


@dataclass(frozen=True)
class Extent:
    """How much is rendered."""

    size: tuple[int, int] = (640, 480)
    spp: tuple[int, ...] = (200, 400, 600, 800, 1000)
    batch_spp: int = 2048
    batches: tuple[int, int] = (4, 24)  # initial and maximum number
    floor_renders: int = 4  # renders each of model and measurement, for the fit's error
    floor_spp: int = 128
    check_size: tuple[int, int] = (80, 60)
    check_batches: int = 16
    uniform_spp: int = 400_000  # in all batches together
    check_spp: int = 2048  # the other strategies, in each batch
    moment_rays: int = 8192
    moment_runs: int = 4


QUICK = Extent(
    size=(96, 72),
    spp=(8, 32),
    batch_spp=64,
    batches=(2, 3),
    floor_renders=2,
    floor_spp=16,
    check_size=(16, 12),
    check_batches=2,
    uniform_spp=2000,
    check_spp=64,
    moment_rays=64,
    moment_runs=2,
)


@dataclass(frozen=True)
class Figure:
    """Contents of one row of the contact sheet."""

    subject: figure_scenes.Subject
    pictures: dict[tuple[str, int], Picture]
    errors: dict[tuple[str, int], tuple[float, float]]  # rmse, relmse
    reference: Reference
    differences: np.ndarray  # [render, row, column, channel]: model minus measurement, same light directions

    @property
    def floor(self) -> tuple[float, float]:
        """rmse and relmse of the fit alone."""
        return fit_error(self.differences, self.reference.mean())

    def smallest(self, sampler: str) -> float:
        return _smallest(self.errors, sampler)

    def margin(self, sampler: str) -> float:
        return self.smallest(sampler) / self.reference.noise()[0]


def main() -> int:
    args = script.arguments(
        "figures", ROOT / "docs/results/figures", check="the uniform reference's check alone"
    )
    extent = QUICK if args.quick else Extent()
    run = script.start(args, Settings(args.work / "kept", extent.size, args.threads, args.seed))
    subjects = figure_scenes.subjects(run.data, run.renders)
    for _ in subjects:
        if not args.check:
            _announce(run.renders, extent)
        figure_check.announce(run.renders, extent)
    if not args.check:
        _make_figures(subjects, run, args, extent)
    if uniform_moments.built():
        _make_checks(subjects, run, args.output, extent)
    else:
        print("The check of the uniform reference is left out: the program uniform_moments is not built.")
    return 0


def _make_figures(subjects: list, run: script.Run, args, extent: Extent) -> None:
    figures = [_figure(subject, subject.scene(WORLD, run.data), run.renders, extent) for subject in subjects]
    for figure in figures:
        figure.reference.save(args.work / f"reference-{figure.subject.figure}")
    figures_sheet.draw(args.output / "contact_sheet.png", figures, extent.spp)
    figures_text.write(args.output, figures, run.conditions, extent)
    print(args.output / "README.md")


def _make_checks(subjects: list, run: script.Run, output: Path, extent: Extent) -> None:
    scenes = [subject.scene(WORLD, run.data).measured(subject.measurement) for subject in subjects]
    checks = [
        figure_check.check(subject, scene, run.renders, extent)
        for subject, scene in zip(subjects, scenes, strict=True)
    ]
    figure_check_text.write(output, checks, run.conditions, extent)
    print(output / "check.md")


def _announce(renders: Renders, extent: Extent) -> None:
    for spp in extent.spp:
        renders.expect(spp, count=len(SAMPLERS))
    renders.expect(extent.batch_spp, count=extent.batches[0])
    renders.expect(extent.floor_spp, count=2 * extent.floor_renders)


def _figure(subject: figure_scenes.Subject, scene: Scene, renders: Renders, extent: Extent) -> Figure:
    measured = scene.measured(subject.measurement)
    pictures = {
        (sampler, spp): renders.render(scene, spp, **options)
        for sampler, options in SAMPLERS.items()
        for spp in extent.spp
    }
    reference = Reference(renders, measured, extent.batch_spp, **BEST).add(extent.batches[0])
    differences = np.array(
        [
            np.subtract(
                *(
                    renders.render(which, extent.floor_spp, seed=seed, **BEST).pixels
                    for which in (scene, measured)
                )
            )
            for seed in range(renders.settings.seed, renders.settings.seed + extent.floor_renders)
        ]
    )
    errors = _converge(pictures, reference, extent.batches[1])
    return Figure(subject, pictures, errors, reference, differences)


def _converge(pictures: dict, reference: Reference, most: int) -> dict[tuple[str, int], tuple[float, float]]:
    """Adds renders to the reference until its error is small beside the dissertation's. Returns errors."""
    while True:
        mean = reference.mean()
        errors = {name: picture.errors(mean) for name, picture in pictures.items()}
        margin = _smallest(errors, "dissertation") / reference.noise()[0]
        print(
            f"    reference of {reference.spp} spp: the smallest error is {margin:.1f} times its own",
            flush=True,
        )
        if margin >= MARGIN or len(reference.pictures) >= most:
            return errors
        reference.add()


def _smallest(errors: dict[tuple[str, int], tuple[float, float]], sampler: str) -> float:
    return min(rmse for (of, _), (rmse, _) in errors.items() if of == sampler)


if __name__ == "__main__":
    sys.exit(script.guarded("figures", main))
