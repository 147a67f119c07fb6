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
from ..sizes import percent
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
    "pilot",
    "out_of_domain",
    "samples",
    "memory",
)
_MOST_SPP = 1 << 16  # for a render that a noise target ends


def add_arguments(parser: argparse.ArgumentParser) -> None:
    scene.add_arguments(parser)
    parser.add_argument(
        "-o", "--output", metavar="OUT.exr", required=True, help="image to write (.exr or .png)"
    )
    parser.add_argument(
        "--spp", type=numbers.whole(1), metavar="N", help="light directions per pixel (default: 64)"
    )
    parser.add_argument(
        "--split",
        type=numbers.whole(1, table.MOST_SPLIT),
        metavar="N",
        help=f"light directions per camera ray (default: 8, at most {table.MOST_SPLIT})",
    )
    parser.add_argument(
        "--bounces", type=numbers.whole(0, 1024), metavar="B", help="indirect bounces (0: direct light only)"
    )
    parser.add_argument(
        "--strategy", choices=table.STRATEGIES, help="sampling strategy (default: auto, or mis with --share)"
    )
    parser.add_argument(
        "--share",
        type=numbers.real(0, 1),
        metavar="S",
        help="mis: fraction of directions sampled from lights (default: 0.5)",
    )
    parser.add_argument(
        "--heuristic",
        choices=table.HEURISTICS,
        help="mis: heuristic of the weights for the environment (default: balance)",
    )
    parser.add_argument(
        "--sequence", choices=table.SEQUENCES, help="sequence of random numbers (default: sobol)"
    )
    numbers.add_job_arguments(parser)
    parser.add_argument(
        "--time-limit",
        type=numbers.real(0, 1e9),
        metavar="SECONDS",
        help="time limit, after which the render ends with a whole pass",
    )
    parser.add_argument(
        "--noise",
        type=numbers.real(1e-6, 1e6),
        metavar="E",
        help="relative error at which a block of pixels gets no more samples",
    )
    parser.add_argument(
        "--denoise",
        action="store_true",
        help="denoise with Open Image Denoise; with --noise, E is the error of the denoised image",
    )
    parser.add_argument("--noisy-image", metavar="FILE", help="with --denoise: also write the noisy image")
    light_paths = parser.add_argument_group("firefly reduction as in Cycles; each option biases the image")
    light_paths.add_argument(
        "--clamp-direct", type=numbers.real(0, 1e9), metavar="L", help="maximum value of a direct sample"
    )
    light_paths.add_argument(
        "--clamp-indirect", type=numbers.real(0, 1e9), metavar="L", help="maximum value of an indirect sample"
    )
    light_paths.add_argument(
        "--filter-glossy",
        type=numbers.real(0, 1e6),
        metavar="G",
        help="blur glossy surfaces after blurry bounces",
    )
    light_paths.add_argument(
        "--no-reflective-caustics", dest="reflective_caustics", action="store_const", const=0,
        help="leave out glossy reflections after diffuse bounces",
    )  # fmt: skip
    parser.add_argument(
        "--cache",
        metavar="FOLDER",
        help="folder for fits of environments, used by product (default: ${XDG_CACHE_HOME:-~/.cache}/velour,"
        " or the folder of Blender's extension)",
    )
    parser.add_argument(
        "--no-cache",
        dest="cache",
        action="store_const",
        const="",
        help="neither read nor write fits of environments",
    )
    render_part.add_arguments(parser)
    parser.add_argument(
        "--reference", metavar="REF.exr", help="image to compare with (reports rmse and relmse)"
    )
    parser.add_argument(
        "--full-model", metavar="FULL",
        help="full model, used if --material is a scene model that was not fitted for this image",
    )  # fmt: skip
    parser.add_argument(
        "--strict-usage",
        action="store_true",
        help="refuse images that --material, a scene model, was not fitted for",
    )


def run(args: argparse.Namespace) -> dict:
    options = _options(args)
    render_part.check(args, options)
    output.check_picture(args.output)
    if args.noisy_image:
        if not args.denoise:
            raise refuse(
                "--noisy-image writes the image before denoising, so it needs --denoise; add that option."
            )
        output.check_picture(args.noisy_image)
    if args.denoise:
        library.denoiser()  # if it is missing, fails before the render, not after it
    estimate = memory.check(args, options)
    options["measure_ray_share"] = int(estimate.parts["rays"] > 0)
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
            output.log.info("Rendering samples %d:%d.", *left.ranges[0])
            job.wait(output.progress_of(args))
            report = job.report() | {"denoised": None}
            noisy = picture = job.read_pass("Combined")
            if args.denoise and report["passes"]:
                picture, report["denoised"], report["stages"]["denoise"] = _denoised(job, args)
            rendered = time.perf_counter()
            new = replace(left, ranges=render_part.rendered(left, report), read=lambda: picture)
            whole = unfinished.deliver(part, before, new, report)
            if args.noisy_image:
                images.write(args.noisy_image, noisy)
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
    """The denoised picture, a report on its error, and the seconds taken."""
    start = time.perf_counter()
    with denoise_job(job, args.threads or 0) as denoising:
        denoising.run()
        report = denoising.report()
    return job.read_pass("Denoised"), report, time.perf_counter() - start


def _choose_model(
    described: Scene, material: int, args: argparse.Namespace, handles: contextlib.ExitStack
) -> float | None:
    """The share of the scene usage that a scene model was not fitted for; None for other models. Replaces the
    scene model by the full one if necessary."""
    if library.file_info(args.material).get("scene") is None:
        if args.full_model:
            raise refuse(f"{args.material} is not a scene model; leave out --full-model.")
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
    if args.strict_usage:
        raise refuse(
            f"{percent(share)} of the scene usage of this image is outside the range that the scene model"
            f" {args.material} was fitted for. Fit another scene model, render with the full model, or leave"
            " out --strict-usage."
        )
    instead = (
        "the full model is used"
        if full
        else "the scene model is used nevertheless; give the full model with --full-model, or fit another"
        " scene model"
    )
    output.log.warning(
        "%s of the scene usage of this image is outside the range that the scene model %s was fitted"
        " for; %s.",
        percent(share), args.material, instead,
    )  # fmt: skip
    if full:
        described.set_model_material(material, full, args.neighbors)
    return share


def _read_reference(args: argparse.Namespace) -> np.ndarray | None:
    """Linear RGB of --reference. Refuses a wrong size before the render, not after it."""
    if not args.reference:
        return None
    pixels = images.read_picture(args.reference)
    output.warn(images.picture_warnings(args.reference))
    needed = render_part.size(args)
    if pixels.shape[1::-1] != needed:  # maybe a part, to compare with the same part
        pixels = images.read_picture(args.reference, as_stored=True)
    height, width, channels = pixels.shape
    if (width, height) != needed or channels < 3:
        raise refuse(
            f"The reference {args.reference} is {width}x{height} with {channels} channels; "
            f"an image of {needed[0]}x{needed[1]} with at least 3 channels is needed."
        )
    return pixels[..., :3].copy()


def _options(args: argparse.Namespace) -> dict:
    names = ("spp", "split", "bounces", "strategy", "share", "heuristic", "sequence")
    names += ("threads", "seed", "noise", "time_limit")
    names += ("clamp_direct", "clamp_indirect", "filter_glossy", "reflective_caustics")
    options = {name: getattr(args, name) for name in names if getattr(args, name) is not None}
    if args.share is not None:
        options.setdefault("strategy", "mis")
    if args.noise is not None:
        options.setdefault("spp", _MOST_SPP)
    cache_folder = user_cache_folder() if args.cache is None else args.cache
    return {
        "width": args.size[0],
        "height": args.size[1],
        "cache_folder": cache_folder,
        "denoise": int(args.denoise),
        **options,
    }


def _tell(args: argparse.Namespace, report: dict, info: dict) -> None:
    output.warn(info["warning_codes"])
    if report["nan_samples"]:
        output.log.warning("%d samples were not finite numbers and were left out.", report["nan_samples"])
    if report["denoised"] and report["denoised"]["relmse_bound"] is not None:
        bound = report["denoised"]["relmse_bound"]
        output.log.info("The relmse of the denoised image is at most %.3g.", bound)
        if args.noise and not render_part.meets_noise(args.noise, report):
            output.log.warning(
                "The denoised image misses the noise target of %g (a relmse of %.3g). Raise --spp or"
                " --time-limit.",
                args.noise,
                args.noise**2,
            )
    if report["blocks_unfinished"]:
        output.log.warning(
            "%d blocks of pixels miss the noise target of %g; the worst error is %.3g. Raise --spp or"
            " --time-limit.",
            report["blocks_unfinished"], args.noise, report["block_noise"],
        )  # fmt: skip
    if report["biased_by"]:
        output.log.info(
            "The image is biased by %s, which its noise does not include.", ", ".join(report["biased_by"])
        )
    if report["sky"]:
        output.log.info(
            "The environment was fitted with %(lobes)d lobes, relative L2 error %(relative_l2).3f.",
            report["sky"],
        )
    if report["pilot"]:
        output.log.info(
            "A pilot chose products for %.0f %% of the surfaces seen, and a light share of %.2f on average.",
            100 * report["pilot"]["products"], report["pilot"]["light_share"],
        )  # fmt: skip
    output.log.info("%d passes, %d light directions per pixel.", report["passes"], report["spp"])
