"""The cost of a render by lobes and threads, the share of tracing rays in it, and how close kernels come to
the peak arithmetic throughput of the machine. Nothing else should run meanwhile."""

from __future__ import annotations

import json
import subprocess
from collections.abc import Mapping

from .. import project
from ..project import ROOT, flags, velour
from ..run import Run
from ..scenes import SUNSET

SETTINGS = {
    "size": ((640, 480), (320, 240)),
    "spp": (800, 128),
    "small_size": ((320, 240), (320, 240)),
    "lobes_spp": (512, 128),
    "lobes": ((2, 4, 8, 16, 32), (2, 16)),
    "repeats": (3, 1),
}
PAGES = {"performance.md": "performance"}
MATERIAL, DEFAULT_LOBES = "blue-metallic-paint", 16
TARGETS = {"mis": 0.5, "product": 0.35}  # minimum ray_share of a strategy


def measure(run: Run) -> dict:
    own, load = run.settings, project.busy_threads()
    measurement = project.merl(run.data, MATERIAL)
    models = {n: run.fit(measurement, tolerance=1e-6, max_lobes=n)[0] for n in own.lobes}
    scene = {"mesh": project.mesh(run.data, "bunny"), "world": run.world(SUNSET)}
    scene |= {"seed": run.seed, "cache": run.work, "output": run.work / "out.exr"}
    first = scene | {"material": models[DEFAULT_LOBES]}

    def best(scene: Mapping, size: tuple[int, int], spp: int, **options) -> dict:
        """The report of the fastest of a few renders: only other programs make one slower."""
        words = _words(scene, size, spp, **options)
        print("rendering", *words[-3:], "...", flush=True)
        reports = [velour("render", *words) for _ in range(own.repeats)]
        return min(reports, key=lambda report: report["seconds"])

    threads = {s: [best(first, own.size, own.spp, strategy=s, threads=t) for t in (1, 2)] for s in TARGETS}
    lobes = [
        {"lobes": n} | best(scene | {"material": model}, own.small_size, own.lobes_spp, threads=2)
        for n, model in models.items()
    ]
    return {
        "conditions": run.conditions(load=load),
        "threads": threads,
        "lobes": lobes,
        "kernels": _bench("bench_lobe_mixture", "eval_neighbors|eval_on|sample_lobe"),
        "gathering": _bench("bench_material", "prepare_neighbors"),
    }


def _words(scene: Mapping, size: tuple[int, int], spp: int, **options) -> list[str]:
    return flags({**scene, "size": "{}x{}".format(*size), "spp": spp, **options})


def _bench(program: str, wanted: str) -> list[dict]:
    """The results of benchmarks of the build that scripts/performance makes, with the parts of names."""
    print(f"running {program} ...", flush=True)
    command = [ROOT / "build/bench/native/bench" / program, f"--benchmark_filter={wanted}"]
    options = ["--benchmark_format=json", "--benchmark_min_time=0.5"]
    report = subprocess.run([*command, *options], check=True, capture_output=True, text=True).stdout
    return [run | {"parts": run["name"].split("/")} for run in json.loads(report)["benchmarks"]]


def values(found: dict) -> dict:
    first = found["lobes"][0]["seconds"]
    kernels: dict[str, list[dict]] = {}
    for row in found["kernels"]:
        kernels.setdefault(row["parts"][0], []).append(row)
    lobes = [r | {"ns": 1e9 / r["samples_per_second"], "over": r["seconds"] / first} for r in found["lobes"]]
    kinds = {"0": "Gaussian", "1": "Abel-Poisson"}
    return {
        "busy": project.busy(found["conditions"]["load"]),
        "pictures": [_picture(*item) for item in found["threads"].items()],
        "by_lobes": lobes,
        "neighbors": kernels.get("eval_neighbors", []),
        "targets": kernels.get("eval_on", []),
        "drawing": [r | {"kernel": kinds[r["parts"][1]]} for r in kernels.get("sample_lobe_mixture", [])],
        "gathering": found["gathering"],
    }


def _picture(strategy: str, runs: list[dict]) -> dict:
    one, two = runs
    faster = one["seconds"] / two["seconds"]
    return two | {"strategy": strategy, "one": one["seconds"], "faster": faster, "target": TARGETS[strategy]}
