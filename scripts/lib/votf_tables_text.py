"""Writes docs/results/votf_tables.md and its CSV."""

from __future__ import annotations

from pathlib import Path

import provenance
from markdown_table import table
from table_csv import csv_text
from velour.core import files

_NUMBERS = {
    "wrong, stored views": lambda c: c["stored"]["wrong"],
    "border, stored views": lambda c: c["stored"]["border"],
    "wrong, unseen views": lambda c: c["unseen"]["wrong"],
    "border, unseen views": lambda c: c["unseen"]["border"],
    "bytes": lambda c: c["bytes"],
    "bytes, deflated": lambda c: c["packed"],
    "ns, stored view": lambda c: c["nanoseconds"]["stored"],
    "ns, any view": lambda c: c["nanoseconds"]["any"],
    "ns, any view, texels in order": lambda c: c["nanoseconds"]["in_order"],
    "seconds": lambda c: c["seconds"],
}
_HEADER = [
    "kept",
    "wrong: stored / unseen",
    "border, texels: stored / unseen",
    "kB: as bytes / deflated",
    "ns: stored view / any view / in order",
    "seconds",
]


def write(folder: Path, results: list[dict], conditions: dict) -> None:
    rows = [
        [r["tile"], r["irregularity"], c["name"], *(of(c) for of in _NUMBERS.values())]
        for r in results
        for c in r["candidates"]
    ]
    files.write_text(folder / "votf_tables.csv", csv_text(["tile", "irregularity", "kept", *_NUMBERS], rows))
    files.write_text(folder / "votf_tables.md", _page(results, conditions))


def _page(results: list[dict], conditions: dict) -> str:
    return f"""# Tables of occlusion beside distances in the shell

By `scripts/votf_tables`. {provenance.sentence(conditions)}
All rows: [votf_tables.csv](votf_tables.csv).

V(t, wv) says whether the line through the center of texel t along wv meets the structure
([votf.md](../engine/votf.md)). Ways to keep it, of texels and views up to 80 degrees, evenly over solid
angle, made by rays:

- *V, whole*: a bit for every texel and view. *Signed distance, whole*: in every view's picture, to the
  nearest border of what is covered, in a byte, at most 4 texels. Between views both are linear
  (barycentric on the views' triangles) and thresholded.
- *CTA*: texels as slices of a clustered tensor, 32 clusters of 12 components; *K-CTA*: 64 clusters of 5,
  each texel of two. A byte a number. Between views as above.
- *SRBFs*: a constant and one or three lobes of wv a texel (axis, bandwidth, amplitude), by a dictionary and
  descent, thresholded; a byte a number. They know all views.
- *distances in the shell*: what Velour keeps. They know all views, too.

Wrong: share of texels whose visibility is not what a ray finds, under the stored views and under unseen
ones (random, up to 75 degrees). Border: how far the places between a covered and an open
texel are from the nearest such place of the truth, and the other way round, mean, at most 8 texels.
Deflated: by zlib, as files hold them. Nanoseconds: of processor time, of random texels under a stored
view, under any view, and of texels in their order under one view. Seconds: of processor time, to make it
from the rays' table, or from the triangles. The net as it comes repeats itself in its tile, which suits
tables and deflating; the irregular one does not.

{"".join(_section(result) for result in results)}"""


def _section(result: dict) -> str:
    irregular = f", irregularity {result['irregularity']:g}" if result["irregularity"] else ""
    rows = [_row(c) for c in result["candidates"]]
    side, views, unseen = result["texels"], result["views"], result["unseen"]
    return f"""## {result["tile"].capitalize()}{irregular}

{side} x {side} texels, {views} views, {unseen} unseen ones; mean V {result["mean"]:.2f}. The rays of the
table took {result["ray_seconds"]:.1f} seconds of processor time.

{table(_HEADER, rows)}
{_verdict(result)}
{"".join(_generation(c) for c in result["candidates"] if "points" in c)}
"""


def _row(c: dict) -> list:
    stored, unseen, time = c["stored"], c["unseen"], c["nanoseconds"]
    return [
        c["name"],
        f"{_percent(stored['wrong'])} / {_percent(unseen['wrong'])}",
        f"{stored['border']:.2f} / {unseen['border']:.2f}",
        f"{c['bytes'] / 1e3:,.0f} / {c['packed'] / 1e3:,.0f}",
        f"{time['stored']:.0f} / {time['any']:.0f} / {time['in_order']:.0f}",
        f"{c['seconds']:.1f}",
    ]


def _percent(share: float) -> str:
    return f"{100 * share:.2f} %"


def _verdict(result: dict) -> str:
    """Our distances, at the resolution of the texels, against the targets."""
    ours, linear = result["candidates"][-1], result["candidates"][0]
    wrong, border = ours["stored"]["wrong"], ours["stored"]["border"]
    share = ours["unseen"]["wrong"] / max(linear["unseen"]["wrong"], 1e-12)
    look_ups = 1e3 / ours["nanoseconds"]["any"]
    targets = {
        f"{ours['packed'] / 1e6:.2f} MB deflated (under 1)": ours["packed"] < 1e6,
        f"{_percent(wrong)} wrong (at most 1 %)": wrong <= 0.01,
        f"borders {border:.2f} texels apart (at most 0.5)": border <= 0.5,
        f"{share:.2f} of what linear interpolation gets wrong at unseen views (at most 0.5)": share <= 0.5,
        f"{look_ups:.1f} million look-ups a second and core (at least 20)": look_ups >= 20,
    }
    lines = [f"- {sentence}: {'met' if met else '**missed**'}.\n" for sentence, met in targets.items()]
    return f"Distances, {result['texels']} a tile, against the targets:\n\n{''.join(lines)}"


def _generation(c: dict) -> str:
    points = " x ".join(map(str, c["points"]))
    return (
        f"- {c['name'].capitalize()} ({points} points): {c['wall_seconds']:.1f} seconds to make, "
        f"{c['wall_seconds_checked']:.1f} with the same number of views checked by rays. "
        f"Its rays reach, the checks' included, {c['ray_share']:.2f} of Embree's bare rate.\n"
    )
