"""States the estimated memory of a render before it begins, and refuses a render above the limit."""

from __future__ import annotations

import argparse
import os

from ...native import images
from .. import machine, memory_estimate
from ..memory_estimate import Estimate
from ..memory_limit import Limit, memory_limit
from . import output, render_part, unfinished


def check(args: argparse.Namespace) -> Estimate:
    """Call before anything is read. Raises VelourError if the render would exceed the limit."""
    estimate = memory_estimate.estimate(
        args.mesh, args.material, args.proposal, images.picture_size(args.world, args.layer or ""),
        render_part.size(args), unfinished.side_file(args.output).exists(), args.threads or machine.threads(),
    )  # fmt: skip
    limit = Limit(args.memory, "--memory") if args.memory else memory_limit(os.environ)
    output.tell(args, f"{estimate.within(limit, 'The render')}.")
    return estimate


def report(estimate: Estimate) -> dict:
    return {"estimated": estimate.total, "parts": estimate.parts, "peak": memory_estimate.peak()}
