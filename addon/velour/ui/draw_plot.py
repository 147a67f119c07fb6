"""A plot in a panel."""

import bpy

from ..core.sizes import data_size
from ..operators.plots import VELOUR_OT_enlarge_plot, VELOUR_OT_save_plot
from .plot_preview import plot_picture
from .text import draw_sentence
from .units import button_height

_LEAST, _MOST = 6, 24  # range of a plot's side, in buttons
_BESIDE = 3.2  # width of the panel's and editor's margins in buttons


def draw_plot(context, layout, model, measurement, kind):
    """Draws a plot of an image datablock's model, as wide as the region, or the reason why there is none."""
    unit = button_height(context.preferences.system)
    scale = max(_LEAST, min(_MOST, int(context.region.width / unit - _BESIDE)))
    picture = plot_picture(context, model, measurement, kind, _side(scale, unit))
    if picture.icon or not picture.sentence:
        layout.template_icon(picture.icon, scale=scale)  # keeps the height without an icon
    if picture.icon == 0 and not picture.sentence:
        layout.label(text="Drawing the plot...", icon="TIME")
    if picture.sentence:
        draw_sentence(context, layout, picture.sentence, icon="INFO")


def draw_plot_buttons(layout, kind, settings):
    """Buttons for the active material's plot, with the angles of `window_manager.velour.plot`."""
    row = layout.row()
    for operator in (VELOUR_OT_enlarge_plot, VELOUR_OT_save_plot):
        button = row.operator(operator.bl_idname)
        button.kind, button.view, button.azimuth = kind, settings.view, settings.azimuth


def _side(scale, unit):
    """Visible size in pixels of an icon of this scale, without the margin that Blender leaves."""
    margin = 0.15 * unit if bpy.app.version >= (4, 0) else 4
    return int(scale * unit - 2 * margin)


def draw_chosen(layout, info):
    """Draws the model's point on the curve; models of earlier versions have none."""
    order = info["order"]
    if order["chosen"] is None:
        return
    at = order["chosen"]
    size = order["parameter_bytes"][at]
    if "texels" in info:
        text = f"{data_size(size)} in memory: error {order['relative_l2'][at]:.3g}"
        text += _asked(order["relative_l2"][at], info["tolerance"])
    else:
        text = f"{order['lobes'][at]} lobes, {data_size(size)}: {order['worst'][at]:.3g} times Max Error"
    draw_sentence(bpy.context, layout, text)


def _asked(error, tolerance):
    if not tolerance:
        return ""
    return (
        f", within Max Error {tolerance:.3g}"
        if error <= tolerance
        else f", exceeds Max Error {tolerance:.3g}"
    )
