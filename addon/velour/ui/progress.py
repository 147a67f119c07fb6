"""The job that runs in the background."""

from ..operators.fit import VELOUR_OT_cancel_fit


def draw_progress(context, layout):
    """Its name, how far it is, and a cross; False where none runs."""
    job = context.window_manager.velour
    if not job.running:
        return False
    row = layout.row(align=True)
    text = f"{job.subject}: {job.stage} {job.fraction:.0%}"
    if hasattr(row, "progress"):  # 4.0 and newer
        row.progress(factor=job.fraction, text=text)
    else:
        row.label(text=text, icon="TIME")
        row.prop(job, "fraction", text="", slider=True)
    row.operator(VELOUR_OT_cancel_fit.bl_idname, text="", icon="CANCEL")
    return True
