"""Whether the dissertation's own reference, uniform samples of the measurement, agrees with ours."""

from __future__ import annotations

from dataclasses import asdict

import numpy as np
from velour.native import images

from ..agreement import LEVEL, agreement
from ..project import BUILT
from ..reference import FIRST_SEED, Reference, silhouette
from ..run import Run, words_of
from ..scenes import SUNSET, Scene, Subject, subjects
from ..tail_bound import Moments
from ..uniform_check import uniform_agreement

PAGES = {"figures/check.md": "figures_check"}
SETTINGS = {
    "size": ((80, 60), (16, 12)),
    "batches": (16, 2),
    "uniform_spp": (400_000, 2000),  # in all batches together
    "spp": (2048, 64),  # the other strategies, in each batch
    "moment_rays": (8192, 64),
    "moment_runs": (4, 2),
}
TOO_BRIGHT = 1.02  # factor of the control, which must be refused
# Independent samples, one direction per camera ray: the variance is known only for independent samples.
UNIFORM = {"strategy": "uniform", "sequence": "random", "split": 1}
_PROGRAM = BUILT / "bench/uniform_moments"


def measure(run: Run) -> dict:
    if not _PROGRAM.is_file():
        raise FileNotFoundError("The check of the uniform reference needs the program uniform_moments.")
    own, shown = run.settings, subjects(run)
    run.expect(own.uniform_spp // own.batches, count=own.batches * len(shown))
    run.expect(own.spp, count=2 * own.batches * len(shown))
    return {"conditions": run.conditions(), "checks": [_check(run, subject) for subject in shown]}


def _check(run: Run, subject: Subject) -> dict:
    """Results of comparisons with `product`."""
    own, scene = run.settings, subject.scene(SUNSET, run.data).measured(subject.measurement)
    each = own.uniform_spp // own.batches

    def stack(spp: int, number: int, **strategy) -> np.ndarray:
        return Reference(run, scene, spp, number * FIRST_SEED, **strategy).add(own.batches).stack()

    product, mis = (stack(own.spp, k, strategy=name) for k, name in ((3, "product"), (4, "mis")))
    uniform = stack(each, 2, **UNIFORM)
    where = silhouette(run, scene, own.size)
    moments, error = uniform_moments(run, scene, own.size, own.moment_rays, range(1, 1 + own.moment_runs))

    def verdict(brightness: float) -> dict:
        others = brightness * product
        found = uniform_agreement(uniform.mean(axis=0), others, where, moments, own.batches * each)
        return asdict(found) | {"holds": found.holds, "sidak_z": found.sidak_z}

    return {
        "figure": f"{subject.figure} {subject.name}",
        "uniform": verdict(1.0),
        "control": verdict(TOO_BRIGHT),
        # With error bars from the spread of the renders.
        "by_spread": {name: _spread(a, product, where) for name, a in (("uniform", uniform), ("mis", mis))},
        "moment_error": float(np.median(error[where])),
        "worst_moment_error": float(error[where].max()),
    }


def _spread(a: np.ndarray, product: np.ndarray, where: np.ndarray) -> dict:
    found = agreement(a, product, where)
    return asdict(found) | {"holds": found.holds}


def uniform_moments(
    run: Run, scene: Scene, size: tuple[int, int], rays: int, seeds: range
) -> tuple[Moments, np.ndarray]:
    """Moments of the luminance of one uniform sample of each pixel, by a program that estimates them with
    importance sampling, as means over a run per seed with `rays` camera rays per pixel; the largest sample is
    that of all runs. Also the relative standard error of the second moments, from the spread of the runs.
    `scene` must have the default camera."""
    runs = np.array([_moments(run, scene, size, rays, seed) for seed in seeds], np.float64)
    mean, second, third = (runs[..., k].mean(axis=0) for k in range(3))
    error = runs[..., 1].std(axis=0, ddof=1) / len(runs) ** 0.5 / np.maximum(second, 1e-300)
    return Moments(mean, second, third, runs[..., 3].max(axis=0)), error


def _moments(run: Run, scene: Scene, size: tuple[int, int], rays: int, seed: int) -> np.ndarray:
    options = {name: value for name, value in scene.options.items() if name != "up"}
    options |= {"size": "{}x{}".format(*size), "rays": rays, "seed": seed}
    out = run.stem("moments", options | {"program": _PROGRAM}).with_suffix(".exr")
    label = f"{scene.name}, moments of uniform samples, {rays} rays"
    run.program(label, _PROGRAM, *words_of(options), threads=run.threads, output=out)
    return images.read(out)


def values(found: dict) -> dict:
    checks, pairs, spreads = found["checks"], [], []
    for check in checks:
        figure = {"figure": check["figure"]}
        pairs += [figure | {"pair": name} | _agree(check[name]) for name in ("uniform", "control")]
        spreads += [figure | {"pair": name} | _agree(of) for name, of in check["by_spread"].items()]
    control = f"{TOO_BRIGHT - 1:.0%} too bright"
    return {"level": LEVEL, "control": control, "pairs": pairs, "checks": checks, "spreads": spreads}


def _agree(found: dict) -> dict:
    return found | {"agree": "yes" if found["holds"] else "no"}
