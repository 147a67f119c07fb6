"""Final renders and material previews: export, render, deliver."""

import contextlib
import functools
import logging
import math
import time

import bpy

from ..core.memory_estimate import peak
from ..export.black import refuse_dark_inside
from ..export.camera import final_view, render_camera
from ..export.film import film_exposure
from ..export.layer_passes import COMBINED, as_rendered, layer_passes, note_missing_passes
from ..export.motion import motion_of_frame, shows_motion
from ..export.unused_settings import note_strokes, refuse_settings
from ..native import biases, render_job
from . import denoising, memory
from .arguments import arguments
from .frame_parts import film, frame_parts
from .options import final_options, samples_text
from .passes import Delivery, add_passes, stamp_cryptomattes
from .scene_models import choose_models

log = logging.getLogger(__package__)

_POLL_SECONDS = 0.05
_STATISTICS_SECONDS = 0.5  # each is a line in a farm's log
_FIRST_PICTURE_SECONDS = 0.3
_PICTURE_GROWTH = 1.5  # intermediate pictures become rarer, as each copies the whole film


class RenderCancelledError(Exception):
    """Esc or Ctrl-C."""


def render_final(engine, depsgraph):
    scene = depsgraph.scene_eval
    if not engine.is_preview:
        refuse_settings(scene)
    engine.update_stats("Velour", "Exporting scene")
    given = None if engine.is_preview else arguments()
    limit = memory.MemoryLimit(given and given.memory)
    breaks = _Clock(_POLL_SECONDS)  # called once per instance, which takes less time than the checks

    def check_break():
        if not breaks.rings():
            return
        if engine.test_break():
            raise RenderCancelledError
        limit.check_export()

    limit.check_export()
    begin = time.monotonic()
    shown = [COMBINED] if engine.is_preview else layer_passes(scene, depsgraph.view_layer_eval)
    asked = {each.asks for each in shown if each.asks}
    moves = not engine.is_preview and shows_motion(depsgraph, asked)
    camera = render_camera(engine)
    with engine.kept_scene.frame(depsgraph, not engine.is_preview, asked, moves) as export:
        notes = export.notes
        view, taken = _take(engine, depsgraph, export, moves, camera, check_break)
        native_scene, materials, surroundings, passes = taken
        engine.update_stats("Velour", _exported(native_scene.info(), time.monotonic() - begin))
        stamps = {}
        if not engine.is_preview:
            note_missing_passes(depsgraph.view_layer_eval, notes)
            note_strokes(scene, depsgraph.view_layer_eval, notes)
            stamps = choose_models(
                native_scene,
                materials.reduced,
                view,
                camera,
                depsgraph,
                notes,
                check_break,
                given.strict_usage,
            )
            _say(notes)
        options = final_options(depsgraph, view, engine.is_preview)
        parts = None
        if not engine.is_preview:
            parts = frame_parts(given, depsgraph, view, options, materials.models, shown)
            estimate = memory.estimate(
                native_scene, view, passes and passes.passes, shown, options["threads"], bool(parts)
            )
            engine.update_stats("Velour", limit.check(estimate))
        make_job = functools.partial(render_job, native_scene, passes and passes.passes)
        make_film = functools.partial(film, depsgraph, make_job, options, parts)
        denoise = (
            functools.partial(_denoise, engine, scene, options["threads"]) if options["denoise"] else None
        )
        if denoise and parts and not parts.is_whole:
            denoise, shown = None, as_rendered(shown)
        report, denoised = _render_layer(engine, depsgraph, view, shown, surroundings, make_film, denoise)
        result = engine.get_result()
        fields = {"samples": _some_samples(parts, options, report), "denoised": denoised}
        fields["biased_by"] = ", ".join(biases(options))
        engine.stamps.add(result, depsgraph, materials.models, stamps, fields)
        if passes:
            stamp_cryptomattes(result, depsgraph.view_layer_eval, passes.names)


def _take(engine, depsgraph, export, moves, camera, check_break):
    """The View and the Export of a frame. `moves`: with its motion."""
    read = motion_of_frame(engine, depsgraph, check_break) if moves else contextlib.nullcontext()
    with read as motion:
        view = final_view(depsgraph, camera=camera)
        view = motion.on(view) if motion else view
        return view, export.take(depsgraph, view, check_break, motion)


def _render_layer(engine, depsgraph, view, shown, surroundings, film, denoise):
    """Returns the job's report (None: all samples were there) and the text of `denoise(job)` (empty without).
    `film(follow)`: film() of frame_parts, which calls follow(job, begin, end) to wait for these samples.
    """
    layer = depsgraph.view_layer_eval
    add_passes(engine, layer, shown)
    result = engine.begin_result(0, 0, view.width, view.height, layer=layer.name)
    scene = depsgraph.scene_eval
    delivery = Delivery(result, view, film_exposure(scene), scene.velour.split)
    complete, denoised = False, ""
    try:
        with film(functools.partial(_follow, engine, delivery)) as job:
            refuse_dark_inside(
                depsgraph, job.read_pass("Combined"), "" if engine.is_preview else surroundings
            )
            report = None if job.poll().state == "ready" else job.report()
            denoised = denoise(job) if denoise else ""
            delivery.write(job, shown)
            _say_report(engine, report, denoised, delivery.split)
        complete = True
    finally:
        engine.end_result(result, cancel=not complete)
    return report, denoised


def _some_samples(parts, options, report):
    """The picture's range of samples, if it is a part or the time limit ended it. Empty if it has all samples
    or, with a noise threshold, a different number in each pixel."""
    if parts:
        return "" if parts.is_whole else "{}:{}".format(*parts.asked)
    if options["noise"] or report["spp"] == options["spp"]:
        return ""
    return f"0:{report['spp']}"


def _follow(engine, delivery, job, begin, end):
    """Waits for the job; handles Esc, progress, statistics and, with a window, intermediate pictures."""
    statistics = _Clock(_STATISTICS_SECONDS)
    pictures = _Clock(_FIRST_PICTURE_SECONDS, growth=_PICTURE_GROWTH)
    for state in _states(engine, job):
        engine.update_progress(state.fraction)
        if statistics.rings():
            engine.update_stats("Velour", _statistics(state, begin, end, delivery.split))
            _tell_memory(engine, state)
        if not bpy.app.background and pictures.rings():
            delivery.write(job, [COMBINED])
            engine.update_result(delivery.result)
    _tell_memory(engine, job.poll())


def _states(engine, job):
    """Yields the job's states until it ends. Raises RenderCancelledError when Blender is asked to stop."""
    while not job.wait(timeout=_POLL_SECONDS):
        if engine.test_break():
            raise RenderCancelledError  # closing the job cancels it and waits
        yield job.poll()


def _denoise(engine, scene, threads, job):
    """Denoises the picture of the job. Returns text on its error."""

    def wait(denoising_job):
        for _state in _states(engine, denoising_job):
            pass

    engine.update_stats("Velour", "Denoising")
    return denoising.denoise(job, scene, threads, wait)


def _tell_memory(engine, state):
    """Blender's statistics are in MiB."""
    engine.update_memory_stats(memory_used=state.bytes_in_use / 2**20, memory_peak=peak() / 2**20)


class _Clock:
    """Rings after `interval` seconds, then at intervals that grow by the factor `growth`."""

    def __init__(self, interval, growth=1.0):
        self._interval, self._growth = interval, growth
        self._next = time.monotonic() + interval

    def rings(self):
        if time.monotonic() < self._next:
            return False
        self._interval *= self._growth
        self._next = time.monotonic() + self._interval
        return True


def _exported(info, seconds):
    counts = f"{info['instances']} instances of {info['meshes']} meshes, {info['triangles']} triangles"
    size, tracing = f"{info['bytes'] / 2**20:.0f} MiB", f"{info['bvh_seconds']:.2f} s"
    return f"Exported {counts}, {size} in {seconds:.2f} s, including {tracing} for the BVH"


def _statistics(state, begin, end, split):
    left = state.seconds_left
    remaining = "" if left is None else f" | Remaining {int(left) // 60:02d}:{int(left) % 60:02d}"
    done = begin + int(state.fraction * (end - begin))
    return f"{samples_text(done, end, split)}{remaining}"


def _say(notes):
    for note in notes.unsaid():
        print(f"Velour: {note}", flush=True)


def _say_report(engine, report, denoised, split):
    if not report:
        engine.update_stats("Velour", "All samples were already rendered")
        return
    speed = report["samples_per_second"] / 1e6
    line = f"{math.ceil(report['spp_mean'] / split)} samples | {speed:.1f} M light directions/s"
    if report["blocks_unfinished"] is not None:
        line += f" | {report['blocks_unfinished']} blocks above the noise threshold"
    if denoised:
        line += f" | Denoised: {denoised}"
    if report["nan_samples"]:
        line += f" | {report['nan_samples']} samples left out, as they were not finite"
    engine.update_stats("Velour", line)
    # A handler on this logger gets the whole report as the record's args.
    log.info("%(seconds).2f s of tracing and shading, %(rays)d rays", report)
