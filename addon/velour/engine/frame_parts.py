"""Frames shared by several runs, and the remaining samples of a stopped run (docs/reference/farm.md)."""

import contextlib
from pathlib import Path

import bpy

from ..core.film_parts import FilmParts
from ..core.stopping import Stopping
from ..farm.sources import sha256
from ..native.errors import refuse
from ..native.version import version_text
from . import written_file
from .arguments import Share
from .linked_files import linked_files

_ELSEWHERE = {"threads", "time_limit", "cache_folder"}  # options that do not affect the picture
_superfluous = []  # files to remove once Blender has written the frame
_stopping = Stopping()  # held until Blender has written the frame


class UnfinishedError(Exception):
    """The message says how far the frame got, and where its samples are."""


def frame_parts(given, depsgraph, view, options, models, shown):
    """The FilmParts of the view layer; None: it is rendered in one run, and nothing is kept."""
    if not given.parts:
        return None
    if options["noise"]:
        if given.samples:
            raise refuse(
                "Noise Threshold needs all samples of the image; disable it to render only some of them."
            )
        return None
    scene, layer = depsgraph.scene_eval, depsgraph.view_layer_eval
    made = {name: value for name, value in options.items() if name not in _ELSEWHERE}
    made |= {
        "split": min(options["split"], options["spp"]),
        "version": version_text(),
        "blend": _blend_hash(),
        "linked_data": sorted(map(sha256, linked_files(scene.frame_current))),
        "scene": scene.name,
        "layer": layer.name,
        "frame": scene.frame_current,
        "models": models,
        "passes": [each.name for each in shown],
        "window": [float(edge) for edge in view.window],
    }
    name = f"{Path(bpy.data.filepath).stem}_{scene.name}_{layer.name}_{scene.frame_current:04d}"
    asked = given.samples
    if isinstance(asked, Share):
        asked = asked.of(made["spp"], made["split"])
    return FilmParts(given.parts, name, made, (view.width, view.height), asked, given.keep_parts)


def _blend_hash():
    """SHA-256 of the open file: parts from different states of it must not be merged."""
    if not bpy.data.filepath:
        raise refuse("Parts of a frame are identified by their .blend file; save the file first.")
    return sha256(bpy.data.filepath)


@contextlib.contextmanager
def film(depsgraph, make_job, options, parts, follow):
    """A render job whose film has all requested samples; those that other runs need are kept when the block
    succeeds. `follow(job, begin, end)` waits for a job that renders these samples."""
    if not parts:
        with make_job(**options) as job:
            follow(job.start(), 0, options["spp"])
            yield job
        return
    _stopping.hold()
    try:
        *gaps, last = parts.gaps or [None]
        for gap in gaps:
            with _job(make_job, options, gap) as job:
                _render(job, parts, gap, follow)
                parts.keep(job, gap, gap[1])
        with _job(make_job, options, last or parts.asked) as job:
            if last:
                _render(job, parts, last, follow)
            parts.complete(job, last)
            yield job
            _keep(parts, job, depsgraph.scene)
    except BaseException:
        _stopping.release()
        raise


def _keep(parts, job, scene):
    """Keeps parts for the runs that render the rest, and layers in case a later layer is stopped."""
    files = parts.files
    if not parts.is_whole or _layer_count(scene) > 1:
        files = [parts.keep_all(job)]
    if parts.is_whole and not parts.stay:
        _superfluous.extend(files)


def _layer_count(scene):
    return 1 if scene.render.use_single_layer else sum(layer.use for layer in scene.view_layers)


def _job(make_job, options, gap):
    return make_job(**{**options, "samples_begin": gap[0], "samples_end": gap[1]})


def _render(job, parts, gap, follow):
    parts.begin(job, gap)
    with _stopping.rendering(job.start()):
        follow(job, *gap)
    report = job.report()
    end = gap[0] + report["spp"]
    if end == gap[1]:
        return
    if not report["passes"]:
        raise UnfinishedError("Stopped before a pass was complete; nothing was written.")
    path = parts.keep(job, gap, end)
    raise UnfinishedError(
        f"Stopped at sample {end} of {parts.asked[1]}; {path} has the samples so far. Run the same command"
        " again to continue."
    )


@bpy.app.handlers.persistent
def _keep_unwritten(scene, *_args):
    """Before a frame: the previous one may not have been written, so its samples stay."""
    _superfluous.clear()
    written_file.watch(scene)
    _stopping.release(obey=True)


@bpy.app.handlers.persistent
def _forget_written(scene, *_args):
    """After Blender wrote the frame: removed only now, its samples survive a crash or a full disk before."""
    if written_file.was_written_whole(scene):
        for path in _superfluous:
            path.unlink(missing_ok=True)
    _superfluous.clear()
    _stopping.release(obey=True)


@bpy.app.handlers.persistent
def _obey(*_args):
    """After a render of Blender, written or not."""
    _stopping.release(obey=True)


def attach():
    bpy.app.handlers.render_pre.append(_keep_unwritten)
    bpy.app.handlers.render_write.append(_forget_written)
    bpy.app.handlers.render_complete.append(_obey)
    bpy.app.handlers.render_cancel.append(_obey)


def detach():
    bpy.app.handlers.render_cancel.remove(_obey)
    bpy.app.handlers.render_complete.remove(_obey)
    bpy.app.handlers.render_write.remove(_forget_written)
    bpy.app.handlers.render_pre.remove(_keep_unwritten)
