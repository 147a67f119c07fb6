"""Plots as icons for panels, made by jobs once per content, size and theme."""

from typing import NamedTuple

import bpy.utils.previews

from ..export import ExportError
from ..native import VelourError
from ..operators.job_target import key_of
from ..operators.plot_colors import theme_colors
from .plot_work import PlotWork, close_source
from .summaries import identity, redraw_panels

_KEPT = 64  # images; 2.5 MB each at 400 x 400 pixels
_TURN_SECONDS = 0.02
_previews = None
_pictures = {}  # _Wanted: _Made; oldest first
_waiting = {}  # _Wanted: names of the images of model and measurement; latest request first
_works = {}  # _Wanted: PlotWork; one at most


class _Wanted(NamedTuple):
    model: tuple
    measurement: tuple | None
    kind: str
    angles: tuple  # view and azimuth, radians
    style: tuple  # items of the keywords of Plot.draw


class _Made(NamedTuple):
    name: str | None  # key in _previews
    sentence: str | None


class PlotPicture(NamedTuple):
    icon: int  # 0: none yet, or none at all
    sentence: str | None  # why there is no plot, or what is missing in it


def plot_picture(context, model, measurement, kind, side):
    """Plot of image datablocks, `side` pixels wide, in the theme's colors. Cheap and safe in draw()."""
    wanted = _wanted(context, model, measurement, kind, side)
    if wanted not in _pictures and wanted not in _works:
        _forget_other_angles(wanted)
        _waiting[wanted] = key_of(model), measurement and key_of(measurement)
    if not is_at_rest() and not bpy.app.timers.is_registered(_turn):
        bpy.app.timers.register(_turn, persistent=True)
    made = _pictures.get(wanted) or _before(wanted)
    if made is None:
        return PlotPicture(0, None)
    return PlotPicture(_previews[made.name].icon_id if made.name else 0, made.sentence)


def is_at_rest():
    """Whether all requests are done."""
    return not _waiting and not _works


def _forget_other_angles(wanted):
    """Drops requests for earlier positions of a slider."""
    for asked in [w for w in _waiting if w._replace(angles=wanted.angles) == wanted]:
        del _waiting[asked]
    for asked, work in _works.items():
        if asked._replace(angles=wanted.angles) == wanted:
            work.cancel()


def _before(wanted):
    """Last image of this kind and model, shown until the new one is done to avoid flicker with sliders."""
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
    _works.clear()
    close_source()
    if bpy.app.timers.is_registered(_turn):
        bpy.app.timers.unregister(_turn)
    if _previews is not None:
        bpy.utils.previews.remove(_previews)
        _previews = None


def _turn():
    """Timer on the main thread, between redraws; never blocks."""
    if not _works:
        wanted, names = _waiting.popitem()
        _works[wanted] = PlotWork(wanted, *names)
    wanted, work = next(iter(_works.items()))
    try:
        pixels = work.step()
    except (ExportError, VelourError) as error:
        del _works[wanted]
        if work.cancelled:
            redraw_panels()  # they may request it again
        else:
            _keep(wanted, _Made(None, str(error)))
    else:
        if pixels is not None:
            del _works[wanted]
            _keep(wanted, _Made(_preview(repr(wanted), pixels), work.missing))
    return None if is_at_rest() else _TURN_SECONDS


def _preview(name, pixels):
    global _previews
    if _previews is None:
        _previews = bpy.utils.previews.new()
    preview = _previews.new(name)
    preview.image_size = pixels.shape[1], pixels.shape[0]
    preview.image_pixels_float.foreach_set(pixels.ravel())
    return name


def _keep(wanted, made):
    _pictures[wanted] = made
    while len(_pictures) > _KEPT:
        oldest = _pictures.pop(next(iter(_pictures)))
        if oldest.name:
            del _previews[oldest.name]
    redraw_panels()
