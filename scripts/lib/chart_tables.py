"""The tables of docs/results/chart."""

from __future__ import annotations

from chart_result import DEFAULT, DISSERTATION, Result
from curve import shown
from markdown_table import error, small, table
from peer_mitsuba import STRATEGIES, Comparison


def targets(verdicts: list) -> str:
    words = {True: "met", False: "missed", None: "not measured"}
    rows = [[v.target, v.where, v.measured, words[v.met]] for v in verdicts]
    met = sum(v.met is True for v in verdicts)
    return f"""## Targets

{met} of {len(verdicts)} met.

{table(["target", "where", "measured", ""], rows)}"""


def equal_error(results: list[Result]) -> str:
    names = list(results[0].points)
    header = ["scene", "relmse", *names, "`uniform` / `mis`"]
    rows = []
    for result in results:
        gain = result.time_ratio("uniform", DEFAULT)
        seconds = [shown(result.seconds_to_level(name)) for name in names]
        rows.append([result.scene.scene.name, small(result.level), *seconds, shown(gain)])
    return f"""## Equal error

Seconds to the relmse that `mis` (balance, half and half) has at {results[0].level_spp} light directions a
pixel.

{table(header, rows)}"""


def equal_time(results: list[Result]) -> str:
    names = list(results[0].points)
    header = ["scene", "seconds", *names, "`uniform` / `mis`"]
    rows = []
    for result in results:
        errors = [shown(result.error_at_equal_time(name)) for name in names]
        gain = result.error_ratio("uniform", DEFAULT)
        rows.append([result.scene.scene.name, f"{result.level_seconds:.2f}", *errors, shown(gain)])
    return f"""## Equal time

relmse in the seconds that `mis` takes for {results[0].level_spp} light directions a pixel.

{table(header, rows)}"""


def equal_samples(results: list[Result], extent) -> str:
    bounded = all(result.bound for result in results)
    header = ["scene", *(f"{spp} spp" for spp in extent.spp), "`mis` / `mis-dissertation`"]
    header += (
        ["exact / `mis`, variance", "`product` / `mis`, variance", "share of the gain"] if bounded else []
    )
    rows = []
    for result in results:
        gains = [str(result.gain("product", DEFAULT, spp)) for spp in extent.spp]
        gained = result.gain(DEFAULT, DISSERTATION, extent.equal_spp)
        rows.append([result.scene.scene.name, *gains, f"{gained.value:.2f}", *_bound_cells(result, bounded)])
    return f"""## Equal samples

relmse of `product` / `mis`, with the standard error that the seeds tell; `mis` / `mis-dissertation` at
{extent.equal_spp} spp. {_bound_words(bounded, extent)}

{table(header, rows)}"""


def _bound_words(bounded: bool, extent) -> str:
    if not bounded:
        return "The bound is left out: the program `product_bound` is not built."
    return f"""Variance: of one light direction at {extent.bound_hits} hits, over the squared
mean; exact: proportional to f cos times radiance on the environment's pixels. A pixel has noise of its own
besides (edges, curvature, visibility), so its relmse gains less."""


def _bound_cells(result: Result, bounded: bool) -> list[str]:
    if not bounded:
        return []
    mis, product, exact = (result.bound[name] for name in ("mis", "product", "exact"))
    return [f"{exact / mis:.3f}", f"{product / mis:.3f}", f"{100 * result.share_of_bound():.0f} %"]


def ggx(results: list[Result]) -> str:
    header = ["scene", "GGX's relative L2", "`mis`", "`mis-ggx`", "`mis` / `mis-ggx`"]
    rows = []
    for result in results:
        seconds = [shown(result.seconds_to_level(name)) for name in (DEFAULT, "mis-ggx")]
        compared = shown(result.time_ratio(DEFAULT, "mis-ggx"))
        rows.append([result.scene.scene.name, error(result.ggx["relative_l2"]), *seconds, compared])
    return f"""## Fitted lobes against a fitted GGX

Seconds to equal error, as above.

{table(header, rows)}"""


def mitsuba(found: list[Comparison] | str, extent) -> str:
    if isinstance(found, str):
        return f"## Mitsuba\n\n{found}\n"
    width, height = extent.peer_size
    header = ["material", "relmse", "Mitsuba", *(f"`{name}`" for name in STRATEGIES), "Mitsuba / fastest"]
    rows = [_mitsuba_row(comparison) for comparison in found]
    spheres = [
        [c.material, f"{c.sphere.means:.4f}", f"{c.sphere.relative:.4f}", f"{c.sphere.noise:.4f}"]
        for c in found
    ]
    return f"""## Mitsuba

Mitsuba {found[0].version} ({found[0].variant}, the fastest of its variants here), its `measured` material
and `direct` integrator (four directions of the material and four of the light a camera ray, `multijitter`
numbers), the second render of its kind in the process. Velour evaluates the measurement itself; a model of
it draws (split 8). Both: bunny, {width}x{height}, `venice_sunset`, the same camera,
each against its own converged picture. Seconds to the relmse of Mitsuba's render with
{extent.peer_rays[-1]} camera rays a pixel:

{table(header, rows)}
Converged pictures of the unit sphere, Mitsuba's against ours, without the background: quotient of the means,
sum of the absolute differences over the sum, and what the noise of both would make of that.

{table(["material", "means", "difference", "of which noise"], spheres)}"""


def _mitsuba_row(c: Comparison) -> list[str]:
    seconds = [c.seconds(name) for name in ("mitsuba", *STRATEGIES)]
    return [c.material, small(c.level), *map(shown, seconds), shown(c.speed_up())]
