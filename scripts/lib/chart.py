"""Error against seconds for every strategy on seven scenes, the resulting tables, and other renderers."""

from __future__ import annotations

import sys
from dataclasses import dataclass
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))

import chart_scenes
import chart_text
import peer_cycles
import peer_mitsuba
import product_bound
import script
from chart_result import DEFAULT, DISSERTATION, Contender, Result, point_of
from reference import Reference
from renders import Renders, Settings
from velour.native.table import STRATEGIES
from velour_cli import ROOT

# The dissertation's strategies have their own random numbers.
CURVES = {name: Contender(name, "sobol") for name in STRATEGIES}
# Curves that targets compare closely have more seeds. Curves that no target names end a step earlier.
COMPARED = (DEFAULT, "mis-ggx", "product")
LONG = (*COMPARED, "uniform", DISSERTATION)
BEST = {"strategy": "product"}


@dataclass(frozen=True)
class Extent:
    """How much is rendered."""

    size: tuple[int, int] = (320, 240)
    worlds: tuple[str, ...] = (chart_scenes.STUDIO, chart_scenes.SUNSET)
    skipped: tuple[str, ...] = ()  # curves
    spp: tuple[int, ...] = (16, 64, 256, 1024)
    level_spp: int = 800  # the default strategy's error here is the level of the equal-error table
    equal_spp: int = 256  # one of `spp`, at which targets compare equal samples
    seeds: int = 3  # compared curves; others have one seed
    reference_spp: int = 2048  # per batch
    reference_batches: int = 4
    bound_hits: int = 200
    peer_materials: int = 3
    peer_size: tuple[int, int] = (160, 120)
    peer_rays: tuple[int, ...] = (8, 32, 128)  # camera rays per pixel, with eight light directions each
    peer_reference_rays: int = 256
    cycles_rays: tuple[int, int] = (64, 512)


QUICK = Extent(
    size=(48, 36),
    worlds=(chart_scenes.SUNSET,),
    skipped=("cosine", "table", "srbf", "ggx", "light", "dissertation"),
    spp=(8, 32),
    level_spp=16,
    equal_spp=32,
    seeds=2,
    reference_spp=64,
    reference_batches=2,
    bound_hits=8,
    peer_materials=1,
    peer_size=(32, 24),
    peer_rays=(2, 4),
    peer_reference_rays=8,
    cycles_rays=(1, 512),
)


def main() -> int:
    args = script.arguments("chart", ROOT / "docs/results/chart")
    extent = QUICK if args.quick else Extent()
    run = script.start(args, Settings(args.work / "kept", extent.size, args.threads, args.seed))
    scenes = chart_scenes.scenes(run.data, run.renders, extent.worlds)
    for _ in scenes:
        _announce(run.renders, extent)
    results = [_result(scene, run.renders, extent) for scene in scenes]
    peers = {
        "mitsuba": peer_mitsuba.compare(run.data, run.renders, extent),
        "cycles": peer_cycles.throughput(scenes[0], run.renders, extent),
    }
    sun = chart_scenes.sun_lobes(scenes[-1].scene, run.renders)
    chart_text.write(args.output, results, peers, sun, run.conditions, extent)
    print(args.output / "README.md")
    return 0


def _announce(renders: Renders, extent: Extent) -> None:
    for name in _curves(extent):
        for spp, seeds in _ladder(name, extent):
            renders.expect(spp, count=seeds)
    renders.expect(extent.reference_spp, count=extent.reference_batches)


def _curves(extent: Extent) -> dict[str, Contender]:
    return {name: curve for name, curve in CURVES.items() if name not in extent.skipped}


def _ladder(name: str, extent: Extent) -> list[tuple[int, int]]:
    """Pairs (spp, number of seeds) of a curve."""
    seeds = extent.seeds if name in COMPARED else 1
    steps = {*extent.spp, extent.level_spp} if name == DEFAULT else {*extent.spp}
    return [(spp, seeds) for spp in sorted(steps) if name in LONG or spp < max(steps)]


def _result(scene: chart_scenes.ChartScene, renders: Renders, extent: Extent) -> Result:
    reference = Reference(renders, scene.scene, extent.reference_spp, **BEST).add(extent.reference_batches)
    mean, noise = reference.mean(), reference.noise()
    first = renders.settings.seed
    curves = {
        name: [
            point_of(renders.render(scene.scene, spp, seed=seed, **curve.options), spp, seed, mean, noise)
            for spp, seeds in _ladder(name, extent)
            for seed in range(first, first + seeds)
        ]
        for name, curve in _curves(extent).items()
    }
    return Result(
        scene,
        curves,
        reference,
        level_spp=extent.level_spp,
        bound=product_bound.of(scene.scene, renders, extent.bound_hits),
        ggx=renders.ggx(scene.measurement),
    )


if __name__ == "__main__":
    sys.exit(script.guarded("chart", main))
