"""velour plot MODEL -o PICTURE"""

from __future__ import annotations

import argparse
import contextlib
import math

from ...native import Measurement, Model, Plot, table
from . import numbers, output

_DARK = {"background": (0.19, 0.19, 0.19), "foreground": (0.9, 0.9, 0.9)}


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("model", metavar="MODEL", help="model to plot")
    parser.add_argument(
        "-o", "--output", metavar="PATH", required=True, help="file to write (.png, .svg or .csv)"
    )
    parser.add_argument("--kind", choices=table.PLOTS, default="lobes", help="what to plot (default: lobes)")
    parser.add_argument(
        "--measurement",
        metavar="INPUT",
        help="measurement that the model was fitted to, shown for comparison",
    )
    parser.add_argument(
        "--view",
        type=numbers.real(0, 89.9),
        metavar="DEG",
        default=30.0,
        help="angle between the normal and the view whose lobes are shown (default: 30)",
    )
    parser.add_argument(
        "--azimuth", type=numbers.real(), metavar="DEG", default=0.0, help="azimuth of the views (default: 0)"
    )
    parser.add_argument(
        "--side", type=numbers.whole(64, 8192), metavar="N", help="width and height in pixels (default: 800)"
    )
    parser.add_argument("--dark", action="store_true", help="light colors on a dark background")


def run(args: argparse.Namespace) -> dict:
    output.check_writable(args.output)
    style = dict(_DARK) if args.dark else {}
    if args.side:
        style["side"] = args.side
    with contextlib.ExitStack() as handles:
        model = handles.enter_context(Model.load(args.model))
        measurement = handles.enter_context(Measurement.load(args.measurement)) if args.measurement else None
        view, azimuth = math.radians(args.view), math.radians(args.azimuth)
        plot = handles.enter_context(Plot.of(model, args.kind, measurement, view, azimuth))
        plot.save(args.output, **style)
        data = plot.data()
    if not args.json and not args.json_file:
        data["series"] = [f"{series['name']} ({len(series['x'])} points)" for series in data["series"]]
    return data
