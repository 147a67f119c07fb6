"""velour compare INPUT MODEL"""

from __future__ import annotations

import argparse

from ...native import Measurement, Model, compare_job
from . import output

KEYS = ("relative_l2", "by_view_angle", "log_rms", "noise_by_view_angle", "samples")


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("input", metavar="INPUT", help="the measurement")
    parser.add_argument("model", metavar="MODEL", help="the model to judge by it")


def run(args: argparse.Namespace) -> dict:
    with (
        Measurement.load(args.input) as measurement,
        Model.load(args.model) as model,
        compare_job(measurement, model) as job,
    ):
        report = job.run(output.progress_of(args))
    return {key: report[key] for key in KEYS}
