"""Ways to store the view-dependent occlusion of tiles: their errors and costs."""

from __future__ import annotations

import json
import subprocess
import zlib
from typing import NamedTuple

from .. import page
from ..run import BUILT, Run

SETTINGS = {"texels": (256, 64), "views": (300, 100), "unseen": (64, 16)}
_PROGRAM = BUILT / "bench/occlusion_tables"


class Case(NamedTuple):
    """The default net is periodic within its tile, which favors tables; the irregular one is not."""

    tile: str
    irregularity: float
    texels: int
    views: int
    unseen: int


def measure(run: Run) -> dict:
    own, results = run.settings, []
    size = (own.texels, own.views, own.unseen)
    for case in (Case("net", 0, *size), Case("net", 0.5, 64, 100, 16), Case("chainmail", 0, *size)):
        label = f"{case.tile}, irregularity {case.irregularity:g}"
        parameters = {"case": case, "seed": run.seed, "program": _PROGRAM}
        make = lambda case=case: _compared(run, case)  # noqa: E731
        results.append(run.keep(label, "tables", parameters, make, case.texels**2 * case.views))
    return {"conditions": run.conditions(), "results": results}


def _compared(run: Run, case: Case) -> dict:
    run.kept.joinpath("tables").mkdir(exist_ok=True)
    words = [_PROGRAM, *map(str, case), str(run.seed), run.kept / "tables"]
    result = json.loads(subprocess.run(words, check=True, stdout=subprocess.PIPE).stdout)
    for i, candidate in enumerate(result["candidates"]):
        stored = run.kept / f"tables/{i}.bin"
        candidate["packed"] = len(zlib.compress(stored.read_bytes(), 9))
        stored.unlink()
    return result


def write(run: Run, found: dict) -> None:
    sections = "".join(map(_section, found["results"]))
    page.write(
        run.output, "votf_tables.md", page.text("votf_tables", found["conditions"] | {"sections": sections})
    )


def _section(result: dict) -> str:
    irregular = f", irregularity {result['irregularity']:g}" if result["irregularity"] else ""
    rows = page.table(
        result["candidates"],
        "kept | wrong: stored / unseen | border, texels: stored / unseen | kB, deflated | "
        "ns, any view | seconds",
        "{name} | {stored[wrong]:p} / {unseen[wrong]:p} | {stored[border]:.2f} / {unseen[border]:.2f} | "
        "{packed:k,.0f} | {nanoseconds[any]:.0f} | {seconds:.1f}",
    )
    return page.filled(
        _SECTION,
        result
        | {"title": result["tile"].capitalize() + irregular, "rows": rows}
        | {"targets": _targets(result)},
    )


_SECTION = """## {title}

{texels} x {texels} texels, {views} views, {unseen} unseen ones; mean V {mean:.2f}.

{rows}
Distances, {texels} a tile: {targets}
"""


def _targets(result: dict) -> str:
    """Our distances, at the resolution of the texels, against the targets."""
    ours, linear = result["candidates"][-1], result["candidates"][0]
    wrong, border = ours["stored"]["wrong"], ours["stored"]["border"]
    share = ours["unseen"]["wrong"] / max(linear["unseen"]["wrong"], 1e-12)
    look_ups = 1e3 / ours["nanoseconds"]["any"]
    targets = {
        f"{ours['packed'] / 1e6:.2f} MB deflated (under 1)": ours["packed"] < 1e6,
        f"{100 * wrong:.2f} % wrong (at most 1 %)": wrong <= 0.01,
        f"borders {border:.2f} texels apart (at most 0.5)": border <= 0.5,
        f"{share:.2f} of the errors of linear interpolation at unseen views (at most 0.5)": share <= 0.5,
        f"{look_ups:.1f} million look-ups a second and core (at least 20)": look_ups >= 20,
    }
    return ", ".join(f"{text} {'met' if met else '**missed**'}" for text, met in targets.items()) + ".\n"
