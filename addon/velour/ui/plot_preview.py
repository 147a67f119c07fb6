"""Plots as icons, which is what a panel shows: made between two redraws, once a content, size and theme."""

from typing import NamedTuple

import bpy.utils.previews

from ..export import ExportError
from ..native import VelourError
from ..operators.model_plots import PlotSource
from ..operators.plot_colors import theme_colors
from .summaries import identity, name_of, redraw_panels

_KEPT = 64  # pictures; of 400 pixels 2.5 MB each
_previews = None
_pictures = {}  # _Wanted: _Made; oldest first
_waiting = {}  # _Wanted: names of the images of model and measurement
_source = (None, None)  # what was asked for last, open: (identities, PlotSource)


class _Wanted(NamedTuple):
    model: tuple
    measurement: tuple | None
    kind: str
    angles: tuple  # view and azimuth, radians
    style: tuple  # items of the keywords of Plot.draw


class _Made(NamedTuple):
    name: str | None  # in _previews
    sentence: str | None


class PlotPicture(NamedTuple):
    icon: int  # 0: there is none yet, or ever
    sentence: str | None  # why there is none, or what is missing in it


def plot_picture(context, model, measurement, kind, side):
    """The plot `side` pixels wide in the theme's colours, of image datablocks. Cheap: for draw()."""
    wanted = _wanted(context, model, measurement, kind, side)
    if wanted not in _pictures and wanted not in _waiting:
        _waiting[wanted] = name_of(model), measurement and name_of(measurement)
        if not bpy.app.timers.is_registered(_draw_waiting):
            bpy.app.timers.register(_draw_waiting)
    made = _pictures.get(wanted) or _before(wanted)
    if made is None:
        return PlotPicture(0, None)
    return PlotPicture(_previews[made.name].icon_id if made.name else 0, made.sentence)


def _before(wanted):
    """The last picture of the kind and model: shown until the new one is made, or a slider would flicker."""
    pictures = reversed(_pictures.items())
    return next((p for old, p in pictures if (old.model, old.kind) == (wanted.model, wanted.kind)), None)


def _wanted(context, model, measurement, kind, side):
    settings = context.window_manager.velour.plot
    text = context.preferences.ui_styles[0].widget.points * context.preferences.system.ui_scale
    style = {"side": side, "text": text, **theme_colors(context.preferences)}
    return _Wanted(
        identity(model),
        measurement and identity(measurement),
        kind,
        (
            settings.view if kind == "LOBES" else 0.0,
            settings.azimuth if kind in ("LOBES", "ALBEDO") else 0.0,
        ),
        tuple(style.items()),
    )


def forget():
    global _previews
    _pictures.clear()
    _waiting.clear()
    _close_source()
    if bpy.app.timers.is_registered(_draw_waiting):
        bpy.app.timers.unregister(_draw_waiting)
    if _previews is not None:
        bpy.utils.previews.remove(_previews)
        _previews = None


def _draw_waiting():
    """A timer: runs on the main thread between two redraws."""
    global _previews
    if _previews is None:
        _previews = bpy.utils.previews.new()
    for wanted, names in _waiting.items():
        _pictures[wanted] = _drawn(wanted, *names)
    _waiting.clear()
    while len(_pictures) > _KEPT:
        oldest = _pictures.pop(next(iter(_pictures)))
        if oldest.name:
            del _previews[oldest.name]
    redraw_panels()


def _drawn(wanted, model, measurement):
    try:
        source = _opened(wanted, model, measurement)
        with source.plot(wanted.kind, *wanted.angles) as plot:
            pixels = plot.draw(**dict(wanted.style))
    except (ExportError, VelourError) as error:
        return _Made(None, str(error))
    name = repr(wanted)
    preview = _previews.new(name)
    preview.image_size = pixels.shape[1], pixels.shape[0]
    preview.image_pixels_float.foreach_set(pixels.ravel())
    return _Made(name, source.missing)


def _opened(wanted, model, measurement):
    """The source that is open already, or another one in its place: a slider asks for one many times."""
    global _source
    known = wanted.model, wanted.measurement
    if _source[0] != known:
        _close_source()
        images = bpy.data.images
        if model not in images:
            raise ExportError("The model is gone.")
        measured = images.get(measurement) if measurement else None
        _source = known, PlotSource(images[model], measured, f"Model '{images[model].name}'")
    return _source[1]


def _close_source():
    global _source
    if _source[1] is not None:
        _source[1].close()
    _source = (None, None)
