"""The part of a picture that a render makes, and its description in the file."""

from __future__ import annotations

import argparse
import json
from pathlib import Path

from ...native import library, structs, table
from ...native.errors import refuse
from ...native.images import Frame
from ...native.job import render_options
from ...native.version import version_text
from ..files import sha256
from ..picture_parts import Part, Range
from . import numbers

_FILES = ("mesh", "proposal", "world", "full_model")  # identified by their content
_NUMBERS = ("spp", "bounces", "share", "seed", "noise")
_NUMBERS += ("clamp_direct", "clamp_indirect", "filter_glossy", "reflective_caustics", "denoise")
_NAMES = {"strategy": table.STRATEGIES, "heuristic": table.HEURISTICS, "sequence": table.SEQUENCES}
# Options that do not affect the whole picture. All others do, including those added later.
_ELSEWHERE = {
    "output", "noisy_image", "samples", "crop", "threads", "time_limit", "memory", "cache", "reference",
    "json", "json_file", "quiet", "log_level", "simd", "run",
}  # fmt: skip


def add_arguments(parser: argparse.ArgumentParser) -> None:
    group = parser.add_argument_group("parts of an image, for velour merge")
    group.add_argument(
        "--samples", type=numbers.span, metavar="A:B", help="range of the --spp light directions per pixel"
    )
    group.add_argument(
        "--crop",
        type=numbers.pixels,
        metavar="X0:X1,Y0:Y1",
        help="range of pixels, counted from the upper left corner",
    )


def check(args: argparse.Namespace, options: dict) -> None:
    """Refuses wrong options before anything is read. `options`: those of render_job()."""
    if not (args.samples or args.crop):
        return
    if Path(args.output).suffix != ".exr":
        raise refuse(
            f"The output {args.output} is part of an image, which only an .exr file can record; change the"
            " extension to .exr."
        )
    if args.denoise:
        raise refuse("--denoise needs the whole image; leave out --samples and --crop, or --denoise.")
    if args.noise is not None:
        raise refuse("--noise needs the whole image; leave out --samples and --crop, or --noise.")
    if args.crop:
        _check_crop(args.crop, args.size)
    if args.samples:
        _check_samples(args.samples, render_options(options))


def _check_crop(crop: tuple[int, int, int, int], picture: tuple[int, int]) -> None:
    x0, y0, x1, y1 = crop
    if x1 > picture[0] or y1 > picture[1]:
        raise refuse(
            f"--crop {x0}:{x1},{y0}:{y1} exceeds the image of {picture[0]}x{picture[1]} pixels; change it,"
            " or --size."
        )


def _check_samples(samples: Range, raw: structs.RenderOptions) -> None:
    text = f"--samples {samples[0]}:{samples[1]}"
    if samples[1] > raw.spp:
        raise refuse(f"{text} exceeds --spp {raw.spp}; set --spp to the samples of the whole image.")
    split = min(raw.split, raw.spp)
    if any(end % split and end != raw.spp for end in samples):
        raise refuse(f"The ends of {text} must be multiples of --split {split}, the samples per camera ray.")


def size(args: argparse.Namespace) -> tuple[int, int]:
    """Width and height of the rendered part."""
    x0, y0, x1, y1 = args.crop or (0, 0, *args.size)
    return x1 - x0, y1 - y0


def asked(args: argparse.Namespace, options: dict) -> Part:
    """The part to render with `options` of render_job()."""
    made = _made(args, options)
    width, height = size(args)
    left, _, _, bottom = args.crop or (0, 0, *args.size)
    frame = Frame(*args.size, left, args.size[1] - bottom)
    ranges = (args.samples or (0, made["spp"]),)
    return Part(str(args.output), made, ranges, frame, width, height, library.system()["simd"], None)


def options_of(part: Part) -> dict:
    """The part as options of render_job()."""
    if part.made["noise"] or part.made["denoise"]:  # these require the whole picture
        return {}
    (begin, end), (rows, columns) = part.ranges[0], part.window
    return {
        "samples_begin": begin,
        "samples_end": end,
        "crop_x0": columns.start,
        "crop_y0": rows.start,
        "crop_x1": columns.stop,
        "crop_y1": rows.stop,
    }


def rendered(part: Part, report: dict) -> tuple[Range, ...]:
    """The samples that each pixel has, for merging. Empty with a noise target, where the numbers of samples
    differ between pixels, and for denoised pictures."""
    if part.made["noise"] or part.made["denoise"]:
        return ()
    begin = part.ranges[0][0]
    return ((begin, begin + report["spp"]),)


def is_complete(asked: Part, whole: Part, report: dict) -> bool:
    """Whether `whole` has all requested samples; with a noise target or --denoise, `report` decides."""
    if asked.made["noise"] and meets_noise(asked.made["noise"], report):
        return True
    if asked.made["noise"] or asked.made["denoise"]:
        return report["spp"] == asked.made["spp"]
    return whole.ranges == asked.ranges


def meets_noise(noise: float, report: dict) -> bool:
    """Whether the error is at most the target: that of each block, or of the whole denoised picture."""
    if not report["denoised"]:
        return report["blocks_unfinished"] == 0
    bound = report["denoised"]["relmse_bound"]
    return bound is not None and bound <= noise**2


def _made(args: argparse.Namespace, options: dict) -> dict:
    """Everything that the whole picture depends on, by option name; files by the hash of their content."""
    raw = render_options(options)
    made = {name: value for name, value in vars(args).items() if name not in _ELSEWHERE}
    made |= {name: sha256(path) for name in _FILES if (path := getattr(args, name))}
    made["material"] = _material_hash(args.material)
    made |= {name: getattr(raw, name) for name in _NUMBERS}
    made |= {name: names[getattr(raw, name)] for name, names in _NAMES.items()}
    made |= {"split": min(raw.split, raw.spp), "version": version_text()}
    return json.loads(json.dumps(made))  # as it is read back from a file


def _material_hash(path: str) -> str:
    """SHA-256 of the material; a BTF may be many files and has one hash of them all."""
    info = library.file_info(path)
    return info["sha256"] if info["kind"] == "btf" else sha256(path)
