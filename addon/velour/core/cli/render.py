"""velour render --mesh M --material MATERIAL --world HDR -o OUT.exr"""

from __future__ import annotations

import argparse
import contextlib
import time
from dataclasses import replace

import numpy as np

from ...native import Job, Model, Scene, biases, denoise_job, images, library, observe_job, render_job, table
from ...native.errors import refuse
from .. import domain
from ..cache import user_cache_folder
from ..stopping import stopping
from . import memory, numbers, output, render_part, scene, unfinished

KEYS = (
    "seconds",
    "rays",
    "samples_per_second",
    "ray_share",
    "stages",
    "rmse",
    "relmse",
    "nan_samples",
    "noise",
    "spp_mean",
    "block_noise",
    "blocks_unfinished",
    "biased_by",
    "denoised",
    "sky",
    "out_of_domain",
    "samples",
    "memory",
)
_MOST_SPP = 1 << 16  # of a render that a noise target ends


def add_arguments(parser: argparse.ArgumentParser) -> None:
    scene.add_arguments(parser)
    parser.add_argument("-o", "--output", metavar="OUT.exr", required=True, help=".exr or .png")
    parser.add_argument("--spp", type=numbers.whole(1), metavar="N", help="light directions a pixel")
    parser.add_argument(
        "--split",
        type=numbers.whole(1, table.MOST_SPLIT),
        metavar="N",
        help=f"of them share a camera ray (8), at most {table.MOST_SPLIT}",
    )
    parser.add_argument("--bounces", type=numbers.whole(0, 1024), metavar="B", help="0: direct light only")
    parser.add_argument("--strategy", choices=table.STRATEGIES, default="mis", help="mis")
    parser.add_argument(
        "--share", type=numbers.real(0, 1), metavar="S", help="what the lights draw of mis (0.5)"
    )
    parser.add_argument("--heuristic", choices=table.HEURISTICS, help="weights of mis under a sky (balance)")
    parser.add_argument("--sequence", choices=table.SEQUENCES, help="of random numbers (sobol)")
    parser.add_argument("--seed", type=numbers.seed, metavar="K")
    parser.add_argument("--threads", type=numbers.whole(0, 1024), metavar="T", help="0: all")
    parser.add_argument("--time-limit", type=numbers.real(0, 1e9), metavar="SECONDS")
    parser.add_argument(
        "--noise", type=numbers.real(1e-6, 1e6), metavar="E", help="relative error of each block of pixels"
    )
    parser.add_argument(
        "--denoise",
        action="store_true",
        help="by Open Image Denoise; with --noise, E is the error of the denoised picture",
    )
    parser.add_argument("--noisy-image", metavar="FILE", help="keeps the picture without --denoise, too")
    light_paths = parser.add_argument_group("against fireflies, as in Cycles; each biases the picture")
    light_paths.add_argument(
        "--clamp-direct", type=numbers.real(0, 1e9), metavar="L", help="largest value of a direct sample"
    )
    light_paths.add_argument(
        "--clamp-indirect", type=numbers.real(0, 1e9), metavar="L", help="largest value of an indirect sample"
    )
    light_paths.add_argument(
        "--filter-glossy",
        type=numbers.real(0, 1e6),
        metavar="G",
        help="blurs glossy surfaces behind blurry bounces",
    )
    light_paths.add_argument(
        "--no-reflective-caustics", dest="reflective_caustics", action="store_const", const=0,
        help="no glossy reflections behind diffuse bounces",
    )  # fmt: skip
    parser.add_argument(
        "--cache",
        metavar="FOLDER",
        help="keeps fits of worlds (product); ${XDG_CACHE_HOME:-~/.cache}/velour, of an extension its own",
    )
    parser.add_argument(
        "--no-cache", dest="cache", action="store_const", const="", help="neither reads nor keeps them"
    )
    render_part.add_arguments(parser)
    parser.add_argument("--reference", metavar="REF.exr", help="picture to compare with: rmse, relmse")
    parser.add_argument(
        "--full-model", metavar="FULL",
        help="serves pictures that the material, a model reduced to other scenes, was not made for",
    )  # fmt: skip


def run(args: argparse.Namespace) -> dict:
    options = _options(args)
    render_part.check(args, options)
    output.check_writable(args.output)
    if args.noisy_image:
        if not args.denoise:
            raise refuse("--noisy-image keeps what --denoise takes the noise out of; give that, too.")
        output.check_writable(args.noisy_image)
    if args.denoise:
        library.denoiser()  # refused before the render, not after it
    estimate = memory.check(args)
    with contextlib.ExitStack() as handles:
        reference = _read_reference(args)
        start = time.perf_counter()
        described = handles.enter_context(Scene())
        described.stay()
        material = scene.fill(described, args, handles)
        outside = _choose_model(described, material, args, handles)
        part = render_part.asked(args, options)
        before = unfinished.kept(part)
        left = unfinished.left(part, before)
        loaded = time.perf_counter()
        job = handles.enter_context(render_job(described, **options, **render_part.options_of(left)))
        with stopping(job.start()):
            output.log.info("Rendering the samples %d:%d.", *left.ranges[0])
            job.wait(output.progress_of(args))
            report = job.report() | {"denoised": None}
            picture = job.read_pass("Combined")
            if args.denoise and report["passes"]:
                if args.noisy_image:
                    images.write(args.noisy_image, picture)
                picture, report["denoised"], report["stages"]["denoise"] = _denoised(job, args)
            rendered = time.perf_counter()
            new = replace(left, ranges=render_part.rendered(left, report), read=lambda: picture)
            whole = unfinished.deliver(part, before, new, report)
        written = time.perf_counter()
        info = described.info()
    report["biased_by"] = biases(options)
    _tell(args, report, info)
    bvh = info["bvh_seconds"]
    stages = {"load": loaded - start - bvh, "bvh": bvh, **report["stages"], "write": written - rendered}
    rmse, relmse = (None, None)
    if reference is not None:
        rmse, relmse = images.compare(whole.read()[..., :3].copy(), reference)
    report |= {"stages": stages, "rmse": rmse, "relmse": relmse, "out_of_domain": outside}
    report |= {"samples": whole.ranges, "memory": memory.report(estimate)}
    return {key: report[key] for key in KEYS}


def _denoised(job: Job, args: argparse.Namespace) -> tuple[np.ndarray, dict, float]:
    """The picture, what is known of its error, and seconds."""
    start = time.perf_counter()
    with denoise_job(job, args.threads or 0) as denoising:
        denoising.run()
        report = denoising.report()
    return job.read_pass("Denoised"), report, time.perf_counter() - start


def _choose_model(
    described: Scene, material: int, args: argparse.Namespace, handles: contextlib.ExitStack
) -> float | None:
    """The share that a reduced model was not made for; the full model takes its place if need be."""
    if library.file_info(args.material).get("scene") is None:
        if args.full_model:
            raise refuse(f"{args.material} is no model that was fitted for a scene; leave --full-model out.")
        return None
    model = handles.enter_context(Model.load(args.material))
    full = handles.enter_context(Model.load(args.full_model)) if args.full_model else None
    seen = {"width": args.size[0], "height": args.size[1]}
    seen |= {name: v for name in ("bounces", "threads") if (v := getattr(args, name)) is not None}
    with observe_job(described, material, **seen) as job:
        job.run()
        with job.result_observation() as frame:
            share = model.out_of_domain(frame)
    if domain.inside(share):
        return share
    instead = (
        "the full model is used"
        if full
        else "give the full model with --full-model, or fit it for this scene"
    )
    output.log.warning(
        "%.2g %% of what the picture shows of the material is outside of what %s was fitted for; %s.",
        100 * share, args.material, instead,
    )  # fmt: skip
    if full:
        described.set_model_material(material, full, args.neighbors)
    return share


def _read_reference(args: argparse.Namespace) -> np.ndarray | None:
    """Linear RGB of --reference; refused before the render, not after it, when the size is another."""
    if not args.reference:
        return None
    pixels = images.read_picture(args.reference)
    for note in images.picture_notes(args.reference):
        output.log.warning("%s", note)
    needed = render_part.size(args)
    if pixels.shape[1::-1] != needed:  # a part, to be compared with the same part
        pixels = images.read_picture(args.reference, as_stored=True)
    height, width, channels = pixels.shape
    if (width, height) != needed or channels < 3:
        raise refuse(
            f"The reference {args.reference} is {width}x{height} with {channels} channels; "
            f"{needed[0]}x{needed[1]} with at least 3 are needed."
        )
    return pixels[..., :3].copy()


def _options(args: argparse.Namespace) -> dict:
    names = ("spp", "split", "bounces", "strategy", "share", "heuristic", "sequence")
    names += ("threads", "seed", "noise", "time_limit")
    names += ("clamp_direct", "clamp_indirect", "filter_glossy", "reflective_caustics")
    options = {name: getattr(args, name) for name in names if getattr(args, name) is not None}
    if args.noise is not None:
        options.setdefault("spp", _MOST_SPP)
    cache_folder = user_cache_folder() if args.cache is None else args.cache
    return {
        "width": args.size[0],
        "height": args.size[1],
        "measure_ray_share": 1,
        "cache_folder": cache_folder,
        "denoise": int(args.denoise),
        **options,
    }


def _tell(args: argparse.Namespace, report: dict, info: dict) -> None:
    for warning in info["warnings"]:
        output.log.warning("%s", warning)
    if report["nan_samples"]:
        output.log.warning("%d samples were not finite and were left out.", report["nan_samples"])
    if report["denoised"] and report["denoised"]["relmse_bound"] is not None:
        bound = report["denoised"]["relmse_bound"]
        output.log.info("The relmse of the denoised picture is at most %.3g.", bound)
        if args.noise and not render_part.meets_noise(args.noise, report):
            output.log.warning(
                "That is above the noise target of %g, a relmse of %.3g.", args.noise, args.noise**2
            )
    if report["blocks_unfinished"]:
        output.log.warning(
            "%d blocks of pixels are above the noise target of %g; the worst has %.3g.",
            report["blocks_unfinished"], args.noise, report["block_noise"],
        )  # fmt: skip
    if report["biased_by"]:
        output.log.info(
            "The picture is biased by %s; its noise does not tell of that.", ", ".join(report["biased_by"])
        )
    if report["sky"]:
        output.log.info("%(lobes)d lobes for the world, relative L2 %(relative_l2).3f.", report["sky"])
    output.log.info("%d passes, %d light directions a pixel.", report["passes"], report["spp"])
