"""The text of docs/results/performance.md from the numbers of scripts/performance."""

from __future__ import annotations

import provenance
from markdown_table import table

_TARGETS = {"mis": 0.5, "product": 0.35}


def page(results: dict) -> str:
    """The whole page."""
    sizes = results["sizes"]
    pictures = _pictures(results["threads"], sizes.picture)
    profile = _profile(results["profile"], sizes.profile)
    head = _head(results["conditions"], results["load"])
    lobes = _lobes(results["lobes"], sizes.by_lobes)
    return "\n".join([head, pictures, profile, lobes, _kernels(results), _LIMIT])


def _head(conditions: dict, load: float) -> str:
    return f"""# Performance: where the time goes, and what the limit is

Written by `scripts/performance`. {provenance.sentence(conditions)}
Of three runs of each render the fastest counts. `ray_share`, profile and kernels count processor time.
{_neighbors(load)}

Scene: the bunny (69 thousand triangles), `venice_sunset` (1024x512), blue-metallic-paint, split 8, default
camera, direct light.
"""


def _neighbors(load: float) -> str:
    if load < 0.2:
        return "Nothing else ran."
    return f"""**Other programs kept {load:.1f} processors busy**: seconds and speed-up by threads are not the
machine's; take the page again when nothing else runs."""


def _pictures(threads: dict[str, dict[int, dict]], size: tuple[str, int]) -> str:
    rows = []
    for strategy, runs in threads.items():
        one, two = runs[1], runs[2]
        speed_up = one["seconds"] / two["seconds"]
        share = f"{two['ray_share']:.2f} (at least {_TARGETS[strategy]})"
        numbers = [f"{one['seconds']:.1f}", f"{two['seconds']:.1f}", f"{speed_up:.2f}"]
        rows.append([strategy, *numbers, f"{two['samples_per_second'] / 1e6:.1f}", share])
    header = ["strategy", "1 thread, s", "2 threads, s", "times faster", "million samples/s", "ray_share"]
    return f"""## The picture of {size[0]} and {size[1]} light directions a pixel

{table(header, rows)}
Targets: 640x480 with 800 directions in under 40 s on two threads, at least 1.9 times faster than on one,
and the `ray_share` in brackets ([conventions.md](../engine/conventions.md)).
"""


def _profile(profile: dict[str, dict[str, float]] | None, size: tuple[str, int]) -> str:
    if profile is None:
        return "## Where the time goes\n\nNot measured: `perf` is missing, or may not look at this system.\n"
    parts = next(iter(profile.values()))
    rows = [[part, *(f"{100 * shares[part]:.1f}" for shares in profile.values())] for part in parts]
    header = ["per cent of the time of a render", *profile]
    return f"""## Where the time goes

One thread, {size[0]}, {size[1]} light directions a pixel, by `perf` (cpu-clock, 2 kHz); loading is left out.

{table(header, rows)}"""


def _lobes(lobes: dict[int, dict], size: tuple[str, int]) -> str:
    first = next(iter(lobes.values()))["seconds"]
    rows = []
    for count, r in lobes.items():
        seconds, share = r["seconds"], f"{r['ray_share']:.2f}"
        nanoseconds = f"{1e9 / r['samples_per_second']:.1f}"
        rows.append([count, f"{seconds:.2f}", nanoseconds, f"{seconds / first:.2f}", share])
    header = ["lobes a view", "seconds", "ns a sample", "relative to the first", "ray_share"]
    return f"""## Cost by lobes

`mis`, {size[0]}, {size[1]} light directions a pixel, two threads; a camera ray mixes two views, each of
up to so many lobes (fits to a tolerance that no view reaches before).

{table(header, rows)}"""


def _kernels(results: dict) -> str:
    return f"""## The mixture kernel against the machine's arithmetic

Value (RGB) and density of a batch of directions under the Gaussian lobes of four neighboring views,
one thread. `share of peak`: what the same operations take in chains that wait for nothing, on registers
alone (11 fused multiply-adds, 3 products, 6 sums, a maximum and a shift a lobe; the best of many short
runs), measured in the same run and divided by the kernel's time.

{_evaluation(results["kernels"])}
By instruction set, 16 lobes and 16 directions:

{_by_target(results["kernels"])}
Drawing directions from a mixture, random number included:

{_drawing(results["kernels"])}
Gathering the lobes of four neighbors of 400 views over the hemisphere (search, rotations, weights):

{_gathering(results["gathering"])}"""


def _evaluation(kernels: dict[str, dict]) -> str:
    header = ["lobes a view", "directions", "ns a lobe", "ns a lobe and direction", "share of peak"]
    rows = []
    for name, run in kernels.items():
        if name.startswith("eval_neighbors/"):
            _, lobes, directions = name.split("/")
            numbers = [f"{run['ns_per_lobe']:.2f}", f"{run['ns_per_lobe_direction']:.3f}"]
            rows.append([lobes, directions, *numbers, f"{run['share_of_peak']:.2f}"])
    return table(header, rows)


def _by_target(kernels: dict[str, dict]) -> str:
    runs = [(name.split("/")[1], run) for name, run in kernels.items() if name.startswith("eval_on/")]
    rows = [[target, f"{run['ns_per_lobe_direction']:.3f}"] for target, run in runs]
    return table(["instruction set", "ns a lobe and direction"], rows)


def _drawing(kernels: dict[str, dict]) -> str:
    names = {"0": "Gaussian", "1": "Abel-Poisson"}
    rows = []
    for name, run in kernels.items():
        if name.startswith("sample_lobe_mixture/"):
            _, kernel, lobes, directions = name.split("/")
            rows.append([names[kernel], lobes, directions, f"{run['ns_per_direction']:.1f}"])
    return table(["kernel", "lobes", "directions at once", "ns a direction"], rows)


def _gathering(runs: dict[str, dict]) -> str:
    rows = []
    for name, run in runs.items():
        rows.append([name.split("/")[1], f"{run['cpu_time']:.0f}", f"{run['ns_per_lobe']:.1f}"])
    return table(["lobes a view", "ns a camera ray", "ns a lobe"], rows)


_LIMIT = """## What the limit is

`ray_share` 1 would be a renderer that shades for nothing: the picture would then take `ray_share` times
its seconds, and only a faster ray tracer could make it shorter. Embree has no faster call for these
rays ([strategies.md](../engine/strategies.md#tiles-and-batches)), and spatial splits
(`RTC_BUILD_QUALITY_HIGH`) left the seconds as they were.

How shading was made cheap:

- Vertices are shaded in batches of 64 directions. The sky's rows, columns and texels of all of them are
  called for before the first is used: a sky of 1024x512 and its tables are 11 MB, far from the core.
- Rows and columns of the sky, Sobol points, samples of mixtures, look-ups and densities are SIMD over
  the batch.
- A material is asked once a vertex for all its directions: no virtual call, allocation or lock a
  sample.

What is left is spread thin. The mixture kernel runs near the limit of its arithmetic. Vectors hold 16
directions under one lobe, or up to eight under two: of the eight of the default split some fall below the
horizon, and their lanes stay empty. The search of neighbors (by a table of directions), the gathering of
their lobes and, for `product`, the products are paid once a camera ray: a larger split spreads them over
more directions.
"""
