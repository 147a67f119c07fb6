"""States what a render will take before it begins, and refuses one that would take more than there is."""

from __future__ import annotations

import argparse
import os

from ...native.errors import Status, VelourError
from .. import machine, memory_estimate
from ..memory_estimate import Estimate, size_text
from ..memory_limit import Limit, memory_limit
from . import output, render_part, unfinished


def check(args: argparse.Namespace) -> Estimate:
    """Before anything is read."""
    estimate = memory_estimate.estimate(
        args.mesh, args.material, args.proposal, args.world, render_part.size(args),
        unfinished.side_file(args.output).exists(), args.threads or machine.threads(),
    )  # fmt: skip
    limit = Limit(args.memory, "--memory") if args.memory else memory_limit(os.environ)
    at_most = f" of {size_text(limit.size)} ({limit.of})" if limit else ""
    output.log.info("Estimated memory: %s%s: %s.", size_text(estimate.total), at_most, estimate)
    if limit and estimate.total > limit.size:
        raise VelourError(
            Status.OUT_OF_MEMORY,
            f"The render would take about {size_text(estimate.total)} of memory ({estimate}), "
            f"above its limit of {size_text(limit.size)} ({limit.of}); {estimate.remedy}.",
        )
    return estimate


def report(estimate: Estimate) -> dict:
    return {"estimated": estimate.total, "parts": estimate._asdict(), "peak": memory_estimate.peak()}
