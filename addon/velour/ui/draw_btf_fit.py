"""Parameters of a BTF fit, in the panels of tiles and of materials."""

from ..operators.compress_btf import VELOUR_OT_compress_btf
from ..operators.estimate_fit import VELOUR_OT_estimate_fit
from ..properties.btf_fit_settings import SHAPE_OF
from .text import draw_sentence

ESTIMATE = 0.32  # share of a row that its button Estimate has: the other one has a longer text


def draw_btf_fit(context, layout, settings, key, button, **whose):
    """Settings and buttons; arguments as for draw_fit_buttons()."""
    draw_fit_settings(layout, settings)
    draw_fit_buttons(context, layout, key, button, **whose)


def draw_fit_settings(layout, settings):
    column = layout.column(align=True)
    for name in ("method", *SHAPE_OF.get(settings.method, ()), "tolerance", "megabytes"):
        column.prop(settings, name)


def draw_fit_buttons(context, layout, key, button, **whose):
    """`key`: from fitted_as() or refitted_as(); `button`: text and icon; `whose`: operator arguments."""
    state = context.window_manager.velour
    if state.fit_estimate and state.fit_estimated == key:
        draw_sentence(context, layout, state.fit_estimate, icon="TIME")
    row, (text, icon) = layout.split(factor=ESTIMATE), button
    buttons = (
        row.operator(VELOUR_OT_estimate_fit.bl_idname),
        row.operator(VELOUR_OT_compress_btf.bl_idname, text=text, icon=icon),
    )
    for each in buttons:
        for name, value in whose.items():
            setattr(each, name, value)
