"""Writes docs/results/chart_btf.md and its CSV from the numbers of scripts/chart --btf."""

from __future__ import annotations

from pathlib import Path

import btf_chart_rows
import btf_chart_scene
import provenance
from btf_chart_numbers import Entry, Results, verdicts
from btf_chart_runs import WORLD, Extent
from markdown_table import table
from velour.core import files

_WORDS = {True: "met", False: "missed", None: "not measured"}


def _origin(conditions: dict) -> str:
    """Where the numbers come from: kept results may come from several runs."""
    sentence, one_run = provenance.sentence(conditions), "All numbers come from one run:"
    if conditions["kept"]:
        sentence = sentence.replace(one_run, "Written from kept results of several runs; this page:")
    if conditions["added_to"]:
        sentence = sentence.replace(one_run, "The last run:")
        sentence += f"\nIts rows were added to those of {conditions['added_to']}."
    return sentence


def write(
    folder: Path, results: Results, interpolated: dict[str, dict | None], conditions: dict, extent: Extent
) -> None:
    btf_chart_rows.write(folder / btf_chart_rows.FILE, results, conditions)
    parts = [
        _head(conditions, extent),
        "![Errors against bytes](images/chart_btf.png)\n",
        _targets(results),
        *(_tile(results, tile, interpolated.get(tile), extent) for tile in results.tiles()),
        _costs(results, extent),
    ]
    files.write_text(folder / "chart_btf.md", "\n".join(parts))


def _head(conditions: dict, extent: Extent) -> str:
    side, width, height = extent.texels, *extent.size
    tiles = f"{btf_chart_scene.TILES:g}"
    return f"""# Ways to compress a BTF, at equal bytes

Written by `scripts/chart --btf`; what the methods are, and which to use where:
[btf_models.md](../engine/btf_models.md).
All numbers are also in [chart_btf.csv](chart_btf.csv).
{_origin(conditions)}
Other programs may have used the processors at the same time: processor seconds feel that little,
seconds and rates do. {conditions["note"]}

Captures of {side} x {side} texels under {extent.directions} x {extent.directions} directions, one side;
unseen pairs: `--held-out {extent.held_out}`. A ratio of 1:R allows the model's file, headers and all, an
R-th of the BTF's half floats. A method gets the most bytes with which its file is within that and a
hundredth, of a few tries that stop where it fills 92 %; "-" stands where no model was fitted, or none is
so small. PSNR in dB and squared error ratio as
[conventions.md](../engine/conventions.md) has them. Picture error:
root mean square of the difference over that of the reference, of a bent sheet of {tiles} x {tiles} tiles
under `{WORLD}`, {width}x{height} pixels, {extent.spp} directions of the light each, the same for both.
"""


def _targets(results: Results) -> str:
    rows = [[v.target, v.where, v.measured, _WORDS[v.met]] for v in verdicts(results)]
    return f"""## Targets

{table(["target", "where", "measured", ""], rows)}"""


def _tile(results: Results, tile: str, interpolated: dict | None, extent: Extent) -> str:
    itself = (
        f"The BTF itself, interpolated at unseen pairs: {interpolated['psnr']:.2f} dB.\n\n"
        if interpolated
        else ""
    )
    ratio = extent.speed_ratio
    return f"""## {tile}

{itself}PSNR, fitted / unseen pairs; of each column the best fitted one is bold:

{_by_ratio(results, tile, _psnr)}
Squared error ratio, fitted / unseen pairs:

{_by_ratio(results, tile, lambda e: _pair(e.ser, e.ser_unseen, 4))}
Picture error{_flip_words(results)}:

{_by_ratio(results, tile, lambda e: _pair(e.picture, e.flip, 3))}
At 1:{ratio}, and where the pictures differ most (with the bytes of the file and the picture error):

![{tile} at 1:{ratio}](images/chart_btf_{tile}.png)
"""


def _flip_words(results: Results) -> str:
    return " / mean FLIP" if any(e.flip is not None for e in results.all()) else ""


def _by_ratio(results: Results, tile: str, shown) -> str:
    header = ["method", *(f"1:{ratio}" for ratio in results.ratios())]
    rows = []
    for method in results.methods():
        cells = []
        for ratio in results.ratios():
            entry = results.get(tile, method, ratio)
            text = "-" if entry is None else shown(entry)
            best = shown is _psnr and results.best(tile, ratio) == method
            cells.append(f"**{text}**" if best else text)
        rows.append([f"`{method}`", *cells])
    return table(header, rows)


def _psnr(e: Entry) -> str:
    return _pair(e.psnr, e.psnr_unseen, 2)


def _pair(a: float, b: float | None, digits: int) -> str:
    return f"{a:.{digits}f}" if b is None else f"{a:.{digits}f} / {b:.{digits}f}"


def _costs(results: Results, extent: Extent) -> str:
    ratio = extent.speed_ratio
    header = ["tile", "method", "KB", "fit, s", "processor s", "million evaluations a second and core"]
    header += [f"render to {extent.level:g}, processor s", "brightness"]
    rows = []
    for tile in results.tiles():
        for method in results.methods():
            e = results.get(tile, method, ratio)
            if e is None:
                continue
            render = "-" if e.render_seconds is None else f"{e.render_seconds:.2f}"
            rates = [f"{e.seconds:.1f}", f"{e.processor_seconds:.0f}", f"{e.evaluations / 1e6:.2f}", render]
            rows.append([tile, f"`{method}`", f"{e.bytes / 1000:.0f}", *rates, f"{e.brightness:.3f}"])
    width, height = extent.speed_size
    return f"""## Costs at 1:{ratio}

Seconds of the fit alone; processor seconds of the whole call with reading, errors and rates; a render of
{width}x{height} pixels to a relmse of {extent.level:g} against the same model's converged picture, by the
better of `mis` and `product`: threads times seconds of tracing and shading, read between
{" and ".join(map(str, extent.speed_spp))} directions a pixel or continued.

{table(header, rows)}"""
