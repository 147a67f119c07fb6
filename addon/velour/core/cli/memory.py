"""States the estimated memory of a render before it begins, and refuses a render above the limit."""

from __future__ import annotations

import argparse
import os
from dataclasses import replace

from ...native import images
from ...native.job import render_options
from .. import machine, memory_estimate
from ..memory_estimate import Estimate
from ..memory_limit import Limit, memory_limit
from . import output, render_part, unfinished


def check(args: argparse.Namespace, options: dict) -> Estimate:
    """Call before anything is read. Raises VelourError if the render would exceed the limit. The part "rays"
    is 0 if the limit leaves no memory to record them."""
    estimate = memory_estimate.estimate(
        args.mesh, args.material, args.proposal, images.picture_size(args.world, args.layer or ""),
        render_part.size(args), unfinished.side_file(args.output).exists(), args.threads or machine.threads(),
    )  # fmt: skip
    limit = Limit(args.memory, "--memory") if args.memory else memory_limit(os.environ)
    rays = memory_estimate.recorded_rays(render_part.size(args), render_options(options))
    fits = not limit or estimate.total + rays <= limit.size
    estimate = replace(estimate, parts=estimate.parts | {"rays": rays if fits else 0})
    output.tell(args, f"{estimate.within(limit, 'The render')}.")
    return estimate


def report(estimate: Estimate) -> dict:
    return {"estimated": estimate.total, "parts": estimate.parts, "peak": memory_estimate.peak()}
