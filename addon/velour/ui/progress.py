"""Progress of the background job, in panels and in the status bar."""

import bpy

from ..operators.fit import VELOUR_OT_cancel_fit, VELOUR_OT_cancel_waiting
from .text import draw_sentence


def attach():
    bpy.types.STATUSBAR_HT_header.append(_draw_in_status_bar)


def detach():
    bpy.types.STATUSBAR_HT_header.remove(_draw_in_status_bar)


def draw_progress(context, layout):
    """Draws the running job's progress, and buttons to cancel it and queued jobs; nothing if none runs."""
    job = context.window_manager.velour
    if not job.running:
        return
    has_progress = hasattr(layout, "progress")  # 4.0 and newer
    if not has_progress:
        draw_sentence(context, layout, _text(job), icon="TIME")  # no room for it beside a slider
    row = layout.row(align=True)
    if has_progress:
        row.progress(factor=job.fraction, text=_text(job))
    else:
        row.prop(job, "fraction", text="", slider=True)
    row.operator(VELOUR_OT_cancel_fit.bl_idname, text="", icon="CANCEL")
    if job.waiting:
        layout.operator(VELOUR_OT_cancel_waiting.bl_idname, text=f"{job.waiting} Queued", icon="CANCEL")


def _draw_in_status_bar(header, context):
    state = context.window_manager.velour
    if state.reading:
        header.layout.label(text=f"Reading {state.reading}", icon="TIME")
    if state.running:
        header.layout.separator()
        draw_progress(context, header.layout)


def _text(job):
    parts = [f"{job.subject}: {job.stage} {job.fraction:.0%}"]
    if job.seconds_left >= 0:
        parts.append(time_left(job.seconds_left))
    return ", ".join(parts)


def time_left(seconds):
    """Remaining time as text, rounded to the accuracy of such estimates."""
    if seconds < 100:
        return f"{seconds:.0f} s left"
    return f"{seconds / 60:.0f} min left" if seconds < 6000 else f"{seconds / 3600:.1f} h left"
