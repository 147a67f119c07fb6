"""velour compare INPUT MODEL, velour compare INPUT --ggx"""

from __future__ import annotations

import argparse
import contextlib

from ...native import Job, Measurement, Model, compare_ggx_job, compare_job
from . import output

KEYS = ("relative_l2", "by_view_angle", "log_rms", "noise_by_view_angle", "samples", "narrow_views")


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("input", metavar="INPUT", help="the measurement")
    judged = parser.add_mutually_exclusive_group(required=True)
    judged.add_argument("model", metavar="MODEL", nargs="?", help="the model to judge by it")
    judged.add_argument(
        "--ggx", action="store_true", help="judge the GGX lobe over a diffuse base that suits it best"
    )


def run(args: argparse.Namespace) -> dict:
    with contextlib.ExitStack() as handles:
        measurement = handles.enter_context(Measurement.load(args.input))
        report = handles.enter_context(_job(args, measurement, handles)).run(output.progress_of(args))
    keys = (*KEYS, "ggx") if args.ggx else KEYS
    return {key: report[key] for key in keys}


def _job(args: argparse.Namespace, measurement: Measurement, handles: contextlib.ExitStack) -> Job:
    if args.ggx:
        return compare_ggx_job(measurement)
    return compare_job(measurement, handles.enter_context(Model.load(args.model)))
