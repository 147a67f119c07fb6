"""velour compare INPUT MODEL, velour compare INPUT --ggx|--principled, velour compare BTF MODEL|BTF"""

from __future__ import annotations

import argparse
import contextlib

from ...native import (
    Job,
    Measurement,
    Model,
    compare_btf_job,
    compare_job,
    compare_peer_job,
    library,
)
from ...native.errors import refuse
from . import btf_options, output

KEYS = (
    "relative_l2",
    "by_view_angle",
    "standard_error",
    "standard_error_by_view_angle",
    "log_rms",
    "noise_by_view_angle",
    "samples",
)
PEER_KEYS = ("seconds", "parameter_bytes")


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("input", metavar="INPUT", help="measurement or BTF to compare with")
    judged = parser.add_mutually_exclusive_group(required=True)
    judged.add_argument(
        "model", metavar="MODEL", nargs="?", help="model to evaluate; for a BTF also another BTF"
    )
    judged.add_argument(
        "--ggx", dest="peer", action="store_const", const="ggx",
        help="evaluate the best-fitting GGX lobe over a diffuse base",
    )  # fmt: skip
    judged.add_argument(
        "--principled", dest="peer", action="store_const", const="principled",
        help="evaluate the best-fitting Principled material, and print its values",
    )  # fmt: skip
    btf_options.add_arguments(parser)


def run(args: argparse.Namespace) -> dict:
    if library.file_info(args.input)["kind"] == "btf":
        return _compare_btf(args)
    btf_options.refuse_given(args, args.input)
    with contextlib.ExitStack() as handles:
        measurement = handles.enter_context(Measurement.load(args.input))
        report = handles.enter_context(_job(args, measurement, handles)).run(output.progress_of(args))
    keys = (*KEYS, *PEER_KEYS, args.peer) if args.peer else (*KEYS, "verdict")
    return {key: report[key] for key in keys}


def _compare_btf(args: argparse.Namespace) -> dict:
    if args.peer:
        raise refuse(
            f"{args.input} is a BTF, but --{args.peer} needs a BRDF measurement; give a model or a BTF"
            " instead."
        )
    with contextlib.ExitStack() as handles:
        btf = handles.enter_context(btf_options.load(args.input, args))
        kind = library.file_info(args.model)["kind"]
        judged = btf_options.load(args.model, args) if kind == "btf" else Model.load(args.model)
        handles.enter_context(judged)
        return handles.enter_context(compare_btf_job(btf, judged)).run(output.progress_of(args))


def _job(args: argparse.Namespace, measurement: Measurement, handles: contextlib.ExitStack) -> Job:
    if args.peer:
        return compare_peer_job(measurement, args.peer)
    return compare_job(measurement, handles.enter_context(Model.load(args.model)))
