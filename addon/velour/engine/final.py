"""Final renders and material previews: export, render, deliver."""

import logging
import time

import bpy

from ..export import ExportError, Notes, export_scene
from ..export.camera import final_view
from ..native import render_job
from .passes import add_passes, write_passes

log = logging.getLogger(__package__)

_POLL_SECONDS = 0.05
_FIRST_UPDATE_SECONDS = 0.3
_UPDATE_GROWTH = 1.5  # pictures in between grow rarer: each copies the whole film


class RenderCancelledError(Exception):
    """Esc or Ctrl-C."""


def render_final(engine, depsgraph):
    scene = depsgraph.scene_eval
    if scene.render.use_multiview:
        raise ExportError("Stereoscopy is not supported; switch it off in Output > Stereoscopy.")
    notes = Notes()
    engine.update_stats("Velour", "Exporting the scene")
    view = final_view(depsgraph, notes)

    def check_break():
        if engine.test_break():
            raise RenderCancelledError

    with export_scene(depsgraph, view, notes, check_break, strict=not engine.is_preview) as native_scene:
        if not engine.is_preview:
            _say(notes)
        with render_job(native_scene, **_options(scene, view, engine.is_preview)) as job:
            _render_layer(engine, depsgraph.view_layer_eval, job, view)


def _options(scene, view, is_preview):
    settings = scene.velour
    return {
        "width": view.width,
        "height": view.height,
        "spp": settings.preview_samples if is_preview else settings.samples,
        "split": settings.split,
        "bounces": settings.bounces,
        "strategy": settings.strategy.lower(),
        "threads": scene.render.threads,
        "seed": settings.seed,
        "time_limit": settings.time_limit,
        "transparent": int(scene.render.film_transparent),
    }


def _render_layer(engine, layer, job, view):
    add_passes(engine, layer)
    result = engine.begin_result(0, 0, view.width, view.height, layer=layer.name)
    complete = False
    try:
        job.start()
        _follow(engine, job, result)
        write_passes(job, result)
        complete = True
    finally:
        engine.end_result(result, cancel=not complete)
    _say_report(engine, job)


def _follow(engine, job, result):
    """Until the job ends: progress, statistics, pictures in between, and Esc."""
    next_update, interval = time.monotonic() + _FIRST_UPDATE_SECONDS, _FIRST_UPDATE_SECONDS
    while not job.wait(timeout=_POLL_SECONDS):
        if engine.test_break():
            raise RenderCancelledError  # closing the job cancels it and waits
        state = job.poll()
        engine.update_progress(state.fraction)
        engine.update_stats("Velour", _statistics(state))
        engine.update_memory_stats(memory_used=state.bytes_in_use / 2**20, memory_peak=0)
        if not bpy.app.background and time.monotonic() >= next_update:
            write_passes(job, result, names=("Combined",))
            engine.update_result(result)
            interval *= _UPDATE_GROWTH
            next_update = time.monotonic() + interval


def _statistics(state):
    left = state.seconds_left
    remaining = "" if left is None else f" | Remaining {int(left) // 60:02d}:{int(left) % 60:02d}"
    return f"{state.stage} {state.fraction:.0%}{remaining}"


def _say(notes):
    for note in notes:
        print(f"Velour: {note}", flush=True)


def _say_report(engine, job):
    report = job.report()
    line = f"{report['spp']} samples | {report['samples_per_second'] / 1e6:.1f} M samples/s"
    if report["nan_samples"]:
        line += f" | {report['nan_samples']} samples without a finite value left out"
    engine.update_stats("Velour", line)
    # A handler on this logger gets the whole report as the record's args.
    log.info("%(seconds).2f s of tracing and shading, %(rays)d rays", report)
