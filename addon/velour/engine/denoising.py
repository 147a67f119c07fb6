"""Denoises pictures and reports their errors."""

import bpy

from ..core.sizes import percent
from ..native import denoise_job

last_errors = {}  # {name of scene: sentence on the error of its last denoised picture}


def denoise(job, scene, threads, wait):
    """Adds the pass "Denoised" to a render job; `wait(job)` waits for a job. Returns text for a stamp."""
    with denoise_job(job, threads) as denoising:
        wait(denoising.start())
        report = denoising.report()
    bound = report["relmse_bound"]
    if bound is None:
        last_errors[scene.name] = (
            "Error of the denoised image: unknown, as each pixel has a single camera ray. Raise Samples."
        )
        return "relmse unknown"
    last_errors[scene.name] = f"Error of the last image: at most {percent(max(bound, 0.0) ** 0.5)}."
    return f"relmse {max(report['relmse'], 0.0):.3g}, at most {max(bound, 0.0):.3g}"


@bpy.app.handlers.persistent
def _forget(*_arguments):
    """Another file has scenes of the same names."""
    last_errors.clear()


def attach():
    bpy.app.handlers.load_post.append(_forget)


def detach():
    bpy.app.handlers.load_post.remove(_forget)
