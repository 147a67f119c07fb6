"""velour merge PART.exr [PART.exr ...] -o OUT.exr"""

from __future__ import annotations

import argparse
import time

from .. import picture_parts
from . import output


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "parts", nargs="+", metavar="PART.exr", help="parts written by velour render --samples or --crop"
    )
    parser.add_argument(
        "-o", "--output", metavar="OUT.exr", required=True, help="image to write (.exr or .png)"
    )
    parser.add_argument(
        "--partial", action="store_true", help="allow missing samples, the same ones for all pixels"
    )


def run(args: argparse.Namespace) -> dict:
    output.check_picture(args.output)
    start = time.perf_counter()
    parts = [picture_parts.open_part(path) for path in args.parts]
    merged = picture_parts.merge(parts, args.partial)
    if "," in merged.simd:
        output.log.warning(
            "The parts were rendered with different instruction sets (%s), so the image equals a single "
            "render within noise, but not bit for bit. For identical bits, use the same --simd for all"
            " parts.",
            merged.simd,
        )  # fmt: skip
    picture_parts.write(args.output, merged)
    return {
        "parts": len(parts),
        "size": [merged.width, merged.height],
        "samples": [list(span) for span in merged.ranges],
        "seconds": time.perf_counter() - start,
    }
