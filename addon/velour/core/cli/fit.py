"""velour fit INPUT -o MODEL"""

from __future__ import annotations

import argparse
import contextlib

from ...native import Measurement, fit_job, table
from . import numbers, output, scene_options

KEYS = (
    "lobes",
    "bytes",
    "parameter_bytes",
    "seconds",
    "relative_l2",
    "by_view_angle",
    "albedo_max",
    "reciprocity",
    "measured_reciprocity",
    "warnings",
    "order",
)
OWN_KEYS = ("view_range", "scene")  # of parametric models; of reduced ones


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("input", metavar="INPUT", help="a measurement")
    parser.add_argument(
        "-o", "--output", metavar="MODEL", required=True, help="the model file to write (.velour)"
    )
    parser.add_argument(
        "--model", choices=table.MODELS, help="parametric: few lobes for all views; scattered: lobes a view"
    )
    parser.add_argument("--kernel", choices=table.KERNELS, help="of a scattered model's lobes")
    parser.add_argument(
        "--tolerance", type=numbers.real(1e-6, 1), metavar="T",
        help="relative L2 asked for at every view up to 75 degrees, 2 T beyond (0.02)",
    )  # fmt: skip
    parser.add_argument(
        "--max-lobes", type=numbers.whole(1, 64), metavar="N", help="lobes in all; scattered: a view (16)"
    )
    parser.add_argument(
        "--bytes",
        type=numbers.size_in_bytes,
        metavar="SIZE",
        help="bytes, or K, M: bound on the model's size",
    )
    parser.add_argument(
        "--limit-albedo",
        action="store_true",
        help="lower the model where more light would leave than arrives",
    )
    parser.add_argument("--symmetric", action="store_true", help="make the model reciprocal")
    parser.add_argument("--all-data", action="store_true", help="hold nothing out: for production")
    parser.add_argument("--seed", type=numbers.seed, metavar="K")
    parser.add_argument("--threads", type=numbers.whole(0, 1024), metavar="T", help="0: all")
    parser.add_argument(
        "--for-scene", metavar="SCENE.json",
        help="reduce a parametric model to what was observed (velour observe), its pictures no worse",
    )  # fmt: skip
    parser.add_argument(
        "--full-model", metavar="FULL", help="with --for-scene: the full model; without: it is fitted first"
    )


def run(args: argparse.Namespace) -> dict:
    output.check_writable(args.output)
    with contextlib.ExitStack() as opened:
        measurement = opened.enter_context(Measurement.load(args.input))
        job = opened.enter_context(fit_job(measurement, **_options(args), **scene_options.load(args, opened)))
        report = job.run(output.progress_of(args))
        with job.result_model() as model:
            model.save(args.output)
    if args.json:  # else the summary says them
        for warning in report["warnings"]:
            output.log.warning("%s", warning)
    return {key: report[key] for key in (*KEYS, *OWN_KEYS) if key in report}


def _options(args: argparse.Namespace) -> dict:
    given = {
        "model": args.model,
        "kernel": args.kernel,
        "tolerance": args.tolerance,
        "max_lobes": args.max_lobes,
        "max_bytes": args.bytes,
        "seed": args.seed,
        "threads": args.threads,
        "all_data": int(args.all_data),
        "limit_albedo": int(args.limit_albedo),
        "symmetric": int(args.symmetric),
    }
    return {name: value for name, value in given.items() if value is not None}
