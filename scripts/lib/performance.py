"""Measures the numbers of docs/results/performance.md: renders by command line, kernels by benchmarks."""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))

import call_profile
import data_files
import performance_text
import provenance
import script
from velour.core import files
from velour_cli import ROOT, velour

WORK = ROOT / "build/performance"
SEED = 1
MATERIAL = "blue-metallic-paint"
WORLD = "venice_sunset"
LOBES = (2, 4, 8, 16, 32)
DEFAULT_LOBES = 16
STRATEGIES = ("mis", "product")
THREADS = (1, 2)
REPEATS = 3


@dataclass(frozen=True)
class Sizes:
    """Size and light directions per pixel of the target pictures, the renders by lobes, and the profile."""

    picture: tuple[str, int]
    by_lobes: tuple[str, int]
    profile: tuple[str, int]


WHOLE = Sizes(("640x480", 800), ("320x240", 512), ("320x240", 1024))
QUICK = Sizes(*[("320x240", 128)] * 3)


def main() -> int:
    parser = argparse.ArgumentParser(prog="performance")
    parser.add_argument("--quick", action="store_true")
    quick = parser.parse_args().quick
    sizes = QUICK if quick else WHOLE
    load = provenance.busy_threads()
    data = data_files.folder()
    WORK.mkdir(parents=True, exist_ok=True)
    measurement = data_files.merl(data, MATERIAL)
    scene = ["--mesh", data_files.mesh(data, "bunny"), "--world", data_files.world(data, WORLD)]
    models = {lobes: _fit(measurement, lobes) for lobes in LOBES}
    scene += ["--seed", SEED, "--cache", WORK, "-o", WORK / "out.exr"]
    main_scene = [*scene, "--material", models[DEFAULT_LOBES]]
    results = {
        "conditions": provenance.conditions(SEED, THREADS[-1]),
        "load": load,
        "sizes": sizes,
        "threads": {s: {t: _picture(main_scene, sizes, s, t) for t in THREADS} for s in STRATEGIES},
        "lobes": {lobes: _by_lobes([*scene, "--material", models[lobes]], sizes) for lobes in LOBES},
        "profile": {s: _profile(main_scene, sizes, s) for s in STRATEGIES}
        if call_profile.available()
        else None,
        "kernels": _bench("bench_lobe_mixture", "eval_neighbors|eval_on|sample_lobe"),
        "gathering": _bench("bench_material", "prepare_neighbors"),
    }
    # A small version only tries the script; it must not replace the numbers of a full run.
    document = WORK / "quick.md" if quick else ROOT / "docs/results/performance.md"
    files.write_text(document, performance_text.page(results))
    print(document)
    return 0


def _fit(measurement: Path, lobes: int) -> Path:
    model = WORK / f"{MATERIAL}-{lobes}.velour"
    print(f"fitting {lobes} lobes ...", flush=True)
    options = ["--model", "scattered", "--max-lobes", lobes, "--tolerance", 1e-6, "--seed", SEED]
    velour("fit", measurement, "-o", model, *options)
    return model


def _picture(scene: list, sizes: Sizes, strategy: str, threads: int) -> dict:
    print(f"rendering with {strategy} on {threads} threads ...", flush=True)
    return _best([*scene, *_asked(sizes.picture), "--strategy", strategy, "--threads", threads])


def _by_lobes(scene: list, sizes: Sizes) -> dict:
    print("rendering by lobes ...", flush=True)
    return _best([*scene, *_asked(sizes.by_lobes), "--threads", THREADS[-1]])


def _asked(size: tuple[str, int]) -> list:
    return ["--size", size[0], "--spp", size[1]]


def _best(options: list) -> dict:
    """The report of the fastest of a few runs: only other programs make a run slower."""
    reports = [velour("render", *options) for _ in range(REPEATS)]
    return min(reports, key=lambda report: report["seconds"])


def _profile(scene: list, sizes: Sizes, strategy: str) -> dict[str, float]:
    print(f"profiling {strategy} ...", flush=True)
    options = [*_asked(sizes.profile), "--strategy", strategy, "--threads", 1, "--quiet"]
    command = [ROOT / "scripts/velour", "render", *scene, *options]
    return call_profile.profile(command, WORK / f"{strategy}.perf")


def _bench(program: str, wanted: str) -> dict[str, dict]:
    print(f"running {program} ...", flush=True)
    command = [ROOT / "build/bench/native/bench" / program, f"--benchmark_filter={wanted}"]
    options = ["--benchmark_format=json", "--benchmark_min_time=0.5"]
    report = subprocess.run([*command, *options], check=True, capture_output=True, text=True).stdout
    return {run["name"]: run for run in json.loads(report)["benchmarks"]}


if __name__ == "__main__":
    sys.exit(script.guarded("performance", main, "stopped; nothing is kept."))
