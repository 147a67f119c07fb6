"""velour observe --mesh M --material MATERIAL --world HDR -o SCENE.json"""

from __future__ import annotations

import argparse
import contextlib

from ...native import Observation, Scene, observe_job
from . import numbers, output, scene

KEYS = ("seconds", "frames", "camera_rays", "hits", "weight", "share", "views", "light_density", "hash")
OWN_KEYS = ("surface",)  # for materials that vary over the surface


def add_arguments(parser: argparse.ArgumentParser) -> None:
    scene.add_arguments(parser)
    parser.add_argument("-o", "--output", metavar="SCENE.json", required=True, help="scene usage to write")
    parser.add_argument(
        "--bounces",
        type=numbers.whole(0, 1024),
        metavar="B",
        help="indirect bounces of the render (0: direct light only)",
    )
    parser.add_argument(
        "--merge", action="append", default=[], metavar="OTHER.json",
        help="add the scene usage in another file; may be repeated",
    )  # fmt: skip
    numbers.add_job_arguments(parser)


def run(args: argparse.Namespace) -> dict:
    output.check_writable(args.output)
    with contextlib.ExitStack() as handles:
        others = [handles.enter_context(Observation.load(path)) for path in args.merge]
        described = handles.enter_context(Scene())
        material = scene.fill(described, args, handles)
        job = handles.enter_context(observe_job(described, material, **_options(args)))
        report = job.run(output.progress_of(args))
        observation = handles.enter_context(job.result_observation())
        if not report["hits"]:
            output.log.warning(
                "The image does not show the material, so it adds nothing to the scene usage; check --camera."
            )
        for other in others:
            observation.merge(other)
        observation.save(args.output)
        report |= observation.info()
        output.warn(described.info()["warning_codes"])
    return {key: report[key] for key in (*KEYS, *OWN_KEYS) if key in report}


def _options(args: argparse.Namespace) -> dict:
    options = {name: getattr(args, name) for name in ("bounces", "seed", "threads")}
    given = {name: value for name, value in options.items() if value is not None}
    return {"width": args.size[0], "height": args.size[1], **given}
