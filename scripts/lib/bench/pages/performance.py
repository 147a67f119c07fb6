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

CSV = "performance_kernels.csv"
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
_BENCHMARKS = ROOT / "build/bench/native/bench"
# Program, benchmark, and what the parts of a run's name mean after that of the benchmark.
_KERNELS = (
    ("bench_lobe_mixture", "eval_neighbors", "lobes directions"),
    ("bench_lobe_mixture", "eval_on", "kernel"),
    ("bench_lobe_mixture", "sample_lobe_mixture", "kernel lobes directions"),
    ("bench_material", "prepare_neighbors", "lobes"),
)
_KINDS = {"0": "Gaussian", "1": "Abel-Poisson"}
_COUNTERS = ("ns_per_lobe", "ns_per_lobe_direction", "share_of_peak", "ns_per_direction", "cpu_time")
TARGETS = {"mis": 0.5, "product": 0.35}  # minimum ray_share of a strategy


def measure(run: Run) -> dict:
    for program, _, _ in _KERNELS:
        if not (_BENCHMARKS / program).is_file():
            raise FileNotFoundError(
                f"there is no {_BENCHMARKS / program}; run scripts/performance, which builds it."
            )
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
        "rows": [row for kernel in _KERNELS for row in _bench(*kernel)],
        "threads": threads,
        "lobes": lobes,
    }


def _words(scene: Mapping, size: tuple[int, int], spp: int, **options) -> list[str]:
    return flags({**scene, "size": "{}x{}".format(*size), "spp": spp, **options})


def _bench(program: str, task: str, names: str) -> list[dict]:
    """The rows of a benchmark of the build that scripts/performance makes."""
    print(f"running {program}, {task} ...", flush=True)
    command = [_BENCHMARKS / program, f"--benchmark_filter={task}"]
    options = ["--benchmark_format=json", "--benchmark_min_time=0.5"]
    report = subprocess.run([*command, *options], check=True, capture_output=True, text=True).stdout
    rows = []
    for run in json.loads(report)["benchmarks"]:
        parts = dict(zip(names.split(), run["name"].split("/")[1:], strict=False))
        if "kernel" in parts:
            parts["kernel"] = _KINDS.get(parts["kernel"], parts["kernel"])
        rows.append({"task": task, **parts} | {name: run[name] for name in _COUNTERS if name in run})
    return rows


def values(found: dict) -> dict:
    first, rows = found["lobes"][0]["seconds"], found["rows"]
    lobes = [r | {"ns": 1e9 / r["samples_per_second"], "over": r["seconds"] / first} for r in found["lobes"]]
    return {
        "busy": project.busy(found["conditions"]["load"]),
        "pictures": [_picture(*item) for item in found["threads"].items()],
        "by_lobes": lobes,
        "kernel": next(row for row in rows if _is_shown(row)),
        "targets": [row for row in rows if row["task"] == "eval_on"],
    }


def _is_shown(row: dict) -> bool:
    return (row["task"], row["lobes"], row["directions"]) == ("eval_neighbors", 16, 16)


def _picture(strategy: str, runs: list[dict]) -> dict:
    one, two = runs
    faster = one["seconds"] / two["seconds"]
    return two | {"strategy": strategy, "one": one["seconds"], "faster": faster, "target": TARGETS[strategy]}
