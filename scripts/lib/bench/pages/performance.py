"""Where the time of a render goes, its cost by lobes and threads, and how close kernels come to the peak
arithmetic throughput of the machine. Nothing else should run meanwhile."""

from __future__ import annotations

import json
import re
import shutil
import subprocess
from collections.abc import Iterator, Mapping

from .. import data_files, page, provenance
from ..run import Run, flags
from ..scenes import SUNSET
from ..velour_cli import ROOT, velour

SETTINGS = {
    "size": ((640, 480), (320, 240)),
    "spp": (800, 128),
    "small_size": ((320, 240), (320, 240)),
    "lobes_spp": (512, 128),
    "profile_spp": (1024, 128),
    "lobes": ((2, 4, 8, 16, 32), (2, 16)),
    "repeats": (3, 1),
}
MATERIAL, DEFAULT_LOBES = "blue-metallic-paint", 16
TARGETS = {"mis": 0.5, "product": 0.35}  # minimum ray_share of a strategy
# The first pattern that matches counts the function. Functions without a match belong to loading, which is
# omitted.
_PARTS = [
    ("tracing rays (Embree)", r"libembree|EmbreeScene|RayLog"),
    ("products of lobes", r"SkyProposals|multiply_|keep_products|select_|expm1|log2f|lround|exp2f"),
    ("drawing from the sky", r"EquirectangularImage|draw_(rows|columns)|sky_directions|Lighting::sample"),
    ("looking the sky up", r"look_up|coordinates_simd"),
    ("evaluating mixtures", r"eval_mixture|eval_density|Material::eval"),
    ("drawing from mixtures", r"sample_mixture|Material::sample|choose_|directions_simd"),
    ("gathering the views' lobes", r"LobeMixture|ScatteredLobes|bracketing|nearest_|prepare|atan"),
    ("random numbers", r"Point|sobol|PathNumbers|points_simd"),
    ("surface points, camera rays", r"Mesh::(pos|sha|tan)|Scene::surf|Vertex|Camera|Tile|Film|Pixel"),
    ("combining, queueing rays", r"DirectLight|LightTerms|ShadowQueue"),
]


def measure(run: Run) -> dict:
    own, load = run.settings, provenance.busy_threads()
    measurement = data_files.merl(run.data, MATERIAL)
    models = {n: run.fit(measurement, tolerance=1e-6, max_lobes=n)[0] for n in own.lobes}
    scene = {"mesh": data_files.mesh(run.data, "bunny"), "world": data_files.world(run.data, SUNSET)}
    scene |= {"seed": run.seed, "cache": run.work, "output": run.work / "out.exr"}
    first = scene | {"material": models[DEFAULT_LOBES]}

    def best(scene: Mapping, size: tuple[int, int], spp: int, **options) -> dict:
        """The report of the fastest of a few renders: only other programs make one slower."""
        words = _words(scene, size, spp, **options)
        print("rendering", *words[-3:], "...", flush=True)
        return min(
            (velour("render", *words) for _ in range(own.repeats)), key=lambda report: report["seconds"]
        )

    return {
        "conditions": run.conditions(load=load),
        "threads": {
            strategy: [best(first, own.size, own.spp, strategy=strategy, threads=t) for t in (1, 2)]
            for strategy in TARGETS
        },
        "lobes": [
            {"lobes": n} | best(scene | {"material": model}, own.small_size, own.lobes_spp, threads=2)
            for n, model in models.items()
        ],
        "profile": {s: _profile(run, first, s) for s in TARGETS} if _may_profile() else None,
        "kernels": _bench("bench_lobe_mixture", "eval_neighbors|eval_on|sample_lobe"),
        "gathering": _bench("bench_material", "prepare_neighbors"),
    }


def _words(scene: Mapping, size: tuple[int, int], spp: int, **options) -> list[str]:
    return flags({**scene, "size": "{}x{}".format(*size), "spp": spp, **options})


def _may_profile() -> bool:
    """Whether perf is installed and permitted."""
    probe = ["perf", "record", "-e", "cpu-clock", "-o", "/dev/null", "true"]
    return bool(shutil.which("perf")) and subprocess.run(probe, capture_output=True).returncode == 0


def _profile(run: Run, scene: Mapping, strategy: str) -> dict[str, float]:
    """Share of each part in the processor time of all parts of a render, by perf's samples."""
    words = _words(scene, run.settings.small_size, run.settings.profile_spp, strategy=strategy, threads=1)
    data = run.work / f"{strategy}.perf"
    record = ["perf", "record", "-q", "-e", "cpu-clock", "-F", "1999", "-o", data, "--"]
    command = [*record, ROOT / "scripts/velour", "render", *words, "--quiet"]
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
    report = ["perf", "report", "-i", data, "-g", "none", "--percent-limit", "0"]
    fields = ["--field-separator", "\t", "--sort", "dso,symbol"]
    text = subprocess.run([*report, *fields], check=True, capture_output=True, text=True).stdout
    totals = dict.fromkeys((name for name, _ in _PARTS), 0.0)
    for line in text.splitlines():
        percent, library, function, *_ = *line.strip().split("\t"), "", "", ""
        if not line.startswith("#") and re.search(r"libvelour|libembree|libm\.|libc\.", library):
            found = (
                name for name, known in _PARTS if re.search(known, f"{library.strip()} {function.strip()}")
            )
            if part := next(found, None):
                totals[part] += float(percent.strip().rstrip("%"))
    return {name: total / sum(totals.values()) for name, total in totals.items()}


def _bench(program: str, wanted: str) -> list[dict]:
    """The results of benchmarks of the build that scripts/performance makes, with the parts of names."""
    print(f"running {program} ...", flush=True)
    command = [ROOT / "build/bench/native/bench" / program, f"--benchmark_filter={wanted}"]
    options = ["--benchmark_format=json", "--benchmark_min_time=0.5"]
    report = subprocess.run([*command, *options], check=True, capture_output=True, text=True).stdout
    return [run | {"parts": run["name"].split("/")} for run in json.loads(report)["benchmarks"]]


def write(run: Run, found: dict) -> None:
    conditions, kernels = found["conditions"], found["kernels"]
    profile = "## Where the time goes\n\nNot measured: `perf` is missing, or may not look at this system.\n"
    if found["profile"]:
        shares = found["profile"].values()
        rows = [{"part": part, "s": [100 * own[part] for own in shares]} for part, _ in _PARTS]
        titles = f"per cent of the time of a render | {' | '.join(found['profile'])}"
        cells = "{part} | " + " | ".join(f"{{s[{k}]:.1f}}" for k in range(len(shares)))
        profile = page.text("performance_profile", conditions | {"profile": page.table(rows, titles, cells)})
    first = found["lobes"][0]["seconds"]
    page.write_rows(run.output / "performance_kernels.csv", list(_kernel_rows(found)), conditions)
    values = {
        "neighbors": _neighbors(float(conditions["load"])),
        "pictures": page.table(
            (_picture(*item) for item in found["threads"].items()),
            "strategy | 1 thread, s | 2 threads, s | times faster | million samples/s | ray_share",
            "{strategy} | {one:.1f} | {seconds:.1f} | {faster:.2f} | {samples_per_second:M.1f} | "
            "{ray_share:.2f} (at least {target})",
        ),
        "profile_part": profile,
        "lobes_table": page.table(
            (r | {"ns": 1e9 / r["samples_per_second"], "over": r["seconds"] / first} for r in found["lobes"]),
            "lobes a view | seconds | ns a sample | relative to the first | ray_share",
            "{lobes} | {seconds:.2f} | {ns:.1f} | {over:.2f} | {ray_share:.2f}",
        ),
        "evaluation": page.table(
            (r for r in _of(kernels, "eval_neighbors") if r["parts"][1] == "16"),
            "directions | ns a lobe | ns a lobe and direction | share of peak",
            "{parts[2]} | {ns_per_lobe:.2f} | {ns_per_lobe_direction:.3f} | {share_of_peak:.2f}",
        ),
        "by_target": page.table(
            _of(kernels, "eval_on"),
            "instruction set | ns a lobe and direction",
            "{parts[1]} | {ns_per_lobe_direction:.3f}",
        ),
    }
    page.write(run.output, "performance.md", page.text("performance", conditions | values))


def _kernel_rows(found: Mapping) -> Iterator[dict]:
    """Rows of the CSV: values and densities, samples of mixtures, gathering of the lobes of neighbors."""
    kinds = {"0": "Gaussian", "1": "Abel-Poisson"}
    names = ("task", "kernel", "lobes", "directions")
    evaluation = ("ns_per_lobe", "ns_per_lobe_direction", "share_of_peak")
    empty = dict.fromkeys((*names, *evaluation, "ns_per_direction", "ns_per_camera_ray"))
    for run in _of(found["kernels"], "eval_neighbors"):
        _, lobes, directions, *_ = run["parts"]
        values = dict(zip(names, ("evaluate", "Gaussian", lobes, directions), strict=True))
        yield empty | values | {name: run[name] for name in evaluation}
    for run in _of(found["kernels"], "sample_lobe_mixture"):
        _, kernel, lobes, directions, *_ = run["parts"]
        values = dict(zip(names, ("sample", kinds[kernel], lobes, directions), strict=True))
        yield empty | values | {"ns_per_direction": run["ns_per_direction"]}
    for run in found["gathering"]:
        numbers = {"ns_per_lobe": run["ns_per_lobe"], "ns_per_camera_ray": run["cpu_time"]}
        yield empty | {"task": "gather", "lobes": run["parts"][1]} | numbers


def _neighbors(load: float) -> str:
    if load < 0.2:
        return "Nothing else ran."
    return f"""**Other programs kept {load:.1f} processors busy**: seconds and speed-up by threads are not the
machine's; take the page again when nothing else runs."""


def _picture(strategy: str, runs: list[dict]) -> dict:
    one, two = runs
    faster = one["seconds"] / two["seconds"]
    return two | {"strategy": strategy, "one": one["seconds"], "faster": faster, "target": TARGETS[strategy]}


def _of(runs: list[dict], kernel: str) -> Iterator[dict]:
    return (run for run in runs if run["parts"][0] == kernel)
