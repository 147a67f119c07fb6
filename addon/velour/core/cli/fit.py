"""velour fit INPUT -o MODEL"""

from __future__ import annotations

import argparse
import contextlib

from ...native import Measurement, fit_job, table
from ..verdict import with_text
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
    "verdict",
    "warning_codes",
    "order",
)
OWN_KEYS = ("view_range", "scene")  # for parametric models; for scene models


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("input", metavar="INPUT", help="measurement to fit")
    parser.add_argument(
        "-o", "--output", metavar="MODEL", required=True, help="model file to write (.velour)"
    )
    parser.add_argument(
        "--model",
        choices=table.MODELS,
        help="parametric: few lobes for all views; scattered: separate lobes per view; auto: parametric, or a"
        " larger model of either kind where it misses the maximum error several times over (default)",
    )
    parser.add_argument(
        "--kernel", choices=table.KERNELS, help="shape of the lobes of a per-view model (default: gaussian)"
    )
    parser.add_argument(
        "--tolerance", type=numbers.real(1e-6, 1), metavar="T",
        help="maximum relative L2 error at every view up to 75 degrees, twice that beyond (default: 0.02)",
    )  # fmt: skip
    parser.add_argument(
        "--max-lobes",
        type=numbers.whole(1, 64),
        metavar="N",
        help="maximum number of lobes, per view for a per-view model (default: 16)",
    )
    parser.add_argument(
        "--bytes",
        type=numbers.size_in_bytes,
        metavar="SIZE",
        help="maximum size of the model in bytes, or with K, M, G, T (default: no limit)",
    )
    parser.add_argument(
        "--limit-albedo",
        action="store_true",
        help="reduce the model where it would reflect more light than arrives",
    )
    parser.add_argument("--symmetric", action="store_true", help="make the model reciprocal")
    parser.add_argument(
        "--all-data", action="store_true", help="hold out no data for validation (for production)"
    )
    numbers.add_job_arguments(parser)
    parser.add_argument(
        "--for-scene", metavar="SCENE.json",
        help="fit a parametric scene model for this scene usage (written by velour observe)",
    )  # fmt: skip
    parser.add_argument(
        "--full-model",
        metavar="FULL",
        help="with --for-scene: the full model to start from (default: fitted first)",
    )


def run(args: argparse.Namespace) -> dict:
    output.check_writable(args.output)
    with contextlib.ExitStack() as opened:
        measurement = opened.enter_context(Measurement.load(args.input))
        job = opened.enter_context(fit_job(measurement, **_options(args), **scene_options.load(args, opened)))
        report = job.run(output.progress_of(args))
        with job.result_model() as model:
            model.save(args.output)
            report["verdict"] = with_text(model.info())
    if args.json:  # otherwise the summary lists them
        output.warn(report["warning_codes"])
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
