"""Parameters of a BTF fit, in the panels of tiles and of materials."""

from ..operators.compress_btf import VELOUR_OT_compress_btf
from ..operators.estimate_fit import VELOUR_OT_estimate_fit
from ..properties.btf_fit_settings import SHAPE_OF
from .text import draw_sentence


def draw_btf_fit(context, layout, settings, key, button, **whose):
    """`key`: from fitted_as() or refitted_as(); `button`: text and icon; `whose`: operator arguments."""
    column = layout.column(align=True)
    for name in ("method", *SHAPE_OF.get(settings.method, ()), "tolerance", "megabytes"):
        column.prop(settings, name)
    state = context.window_manager.velour
    if state.fit_estimate and state.fit_estimated == key:
        draw_sentence(context, layout, state.fit_estimate, icon="TIME")
    row, (text, icon) = layout.row(), button
    buttons = (
        row.operator(VELOUR_OT_estimate_fit.bl_idname, icon="TIME"),
        row.operator(VELOUR_OT_compress_btf.bl_idname, text=text, icon=icon),
    )
    for each in buttons:
        for name, value in whose.items():
            setattr(each, name, value)
