"""scripts/chart --btf: all methods of BTF compression at equal bytes, on captures and on measured sets."""

from __future__ import annotations

import argparse
import sys
from dataclasses import replace
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))

import btf_chart_plot
import btf_chart_rows
import btf_chart_sheet
import btf_chart_text
import script
from btf_chart_numbers import Entry, Method, Results
from btf_chart_runs import QUICK, Extent, Study, Tile
from renders import Settings
from velour.native.table import COMPRESS_METHODS
from velour_cli import ROOT

MEMBERS = (None, 2, 3, 4)  # K of K-CTA; None: searched for
SWITCHES = {
    "btf": "this chart",
    "kept": "writes what the fits say that are there, and makes no others",
    "add": "keeps all that the page in the output folder has and is not measured now",
}
_ORDER = ("svd", "svd-view", "srbf", "tucker", "cta", "kcta")


def methods(known: tuple[str, ...], wanted: list[str] | None = None) -> list[Method]:
    """The library's methods, in the chart's order; K-CTA once for each K."""
    found = []
    for name in sorted(known, key=lambda n: _ORDER.index(n) if n in _ORDER else len(_ORDER)):
        members = MEMBERS if name == "kcta" else (None,)
        for k in members:
            extra = () if k is None else (("members", k),)
            label = name if k is None else f"{name} {k}"
            if not wanted or label in wanted:
                found.append(Method(label, (("method", name), *extra)))
    return found


def main() -> int:
    args = script.arguments("chart", ROOT / "docs/results", _add_arguments, part="btf", **SWITCHES)
    extent = _extent(args)
    run = script.start(args, Settings(args.work / "kept", extent.size, args.threads, args.seed))
    study = Study(run.renders, extent, run.data, args.kept)
    contenders = methods(COMPRESS_METHODS, args.methods)
    study.announce(len(extent.tiles) + len(args.btf_set), len(contenders))
    tiles = [study.captured(kind) for kind in extent.tiles] + [study.measured(path) for path in args.btf_set]
    taken_on, before = _before(args)
    results = Results(before + [e for e in _entries(study, tiles, contenders, extent) if e])
    images = args.output / "images"
    images.mkdir(parents=True, exist_ok=True)
    btf_chart_plot.draw(images / "chart_btf.png", results)
    for tile in () if args.add else tiles:
        pictures = _pictures(study, tile, contenders, extent.speed_ratio)
        btf_chart_sheet.draw(
            images / f"chart_btf_{tile.name}.png", tile, pictures, results, extent.speed_ratio
        )
    interpolated = {tile.name: study.interpolated(tile) for tile in tiles}
    conditions = run.conditions | {"note": args.note, "kept": args.kept, "added_to": "; ".join(taken_on)}
    btf_chart_text.write(args.output, results, interpolated, conditions, extent)
    print(args.output / "chart_btf.md")
    return 0


def _add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--btf-set", metavar="FOLDER", type=Path, action="append", default=[])
    parser.add_argument("--texels", metavar="N", type=int)
    parser.add_argument("--tiles", metavar="NAME,...", type=_words)
    parser.add_argument("--ratios", metavar="R,...", type=lambda text: [int(r) for r in text.split(",")])
    parser.add_argument("--note", metavar="TEXT", default="", help="what the page's reader must know")
    parser.add_argument("--methods", metavar="NAME,...", type=_words)


def _words(text: str) -> list[str]:
    return text.split(",")


def _extent(args: argparse.Namespace) -> Extent:
    extent = QUICK if args.quick else Extent()
    given = {name: getattr(args, name) for name in ("texels", "tiles", "ratios") if getattr(args, name)}
    extent = replace(extent, **{name: tuple(v) if name != "texels" else v for name, v in given.items()})
    if extent.speed_ratio in extent.ratios or args.add:
        return extent
    return replace(extent, speed_ratio=sorted(extent.ratios)[len(extent.ratios) // 2])


def _before(args: argparse.Namespace) -> tuple[list[str], list[Entry]]:
    """The kept entries, preceded by the dates and commits at which they were measured."""
    if not args.add:
        return [], []
    conditions, entries = btf_chart_rows.read(args.output / btf_chart_rows.FILE)
    earlier = filter(None, conditions.get("added_to", "").split("; "))
    before = f"{conditions['date']}, commit {conditions['commit']}"
    return list(dict.fromkeys([before, *earlier])), entries


def _entries(study: Study, tiles: list[Tile], contenders: list[Method], extent: Extent):
    """Starts with the most informative ratio, so that an interrupted run has it for all tiles."""
    for ratio in sorted(extent.ratios, key=lambda r: r != extent.speed_ratio):
        for tile in tiles:
            for method in contenders:
                yield study.entry(tile, method, ratio)


def _pictures(study: Study, tile: Tile, contenders: list[Method], ratio: int) -> dict:
    """Pixels by method name, the BTF itself first."""
    found = {"the BTF": study.picture(tile, tile.btf).pixels}
    for method in contenders:
        model = study.model(tile, method, ratio)
        if model:
            found[method.name] = study.picture(tile, model).pixels
    return found


if __name__ == "__main__":
    sys.exit(script.guarded("chart", main))
