"""velour merge PART.exr [PART.exr ...] -o OUT.exr"""

from __future__ import annotations

import argparse
import time

from .. import picture_parts
from . import output


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("parts", nargs="+", metavar="PART.exr", help="what render --samples or --crop wrote")
    parser.add_argument("-o", "--output", metavar="OUT.exr", required=True, help=".exr or .png")
    parser.add_argument(
        "--partial", action="store_true", help="samples may be missing, of all pixels the same: fewer samples"
    )


def run(args: argparse.Namespace) -> dict:
    output.check_writable(args.output)
    start = time.perf_counter()
    parts = [picture_parts.open_part(path) for path in args.parts]
    merged = picture_parts.merge(parts, args.partial)
    if "," in merged.simd:
        output.log.warning(
            "The parts were rendered with different instruction sets (%s), which are equal within noise, "
            "not bit for bit; --simd pins one.", merged.simd,
        )  # fmt: skip
    picture_parts.write(args.output, merged)
    return {
        "parts": len(parts),
        "size": [merged.width, merged.height],
        "samples": [list(span) for span in merged.ranges],
        "seconds": time.perf_counter() - start,
    }
