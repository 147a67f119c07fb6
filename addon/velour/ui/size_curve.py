"""The curve of a BTF model's error against its bytes."""

from .order_preview import order_icon


def draw_size_curve(layout, info):
    """With the point that the model is, and its tolerance; models of earlier versions have none."""
    order, tolerance = info["order"], info["tolerance"]
    if not order["lobes"]:
        return
    box = layout.box()
    box.label(text="Error against size")
    box.template_icon(order_icon(order, against="parameter_bytes", tolerance=tolerance > 0), scale=7.0)
    chosen = order["chosen"]
    if chosen is None:
        return
    error, size = order["relative_l2"][chosen], order["parameter_bytes"][chosen]
    box.label(text=f"{size / 1e6:.3g} MB: error {error:.3g}" + _asked(error, tolerance))


def _asked(error, tolerance):
    if not tolerance:
        return ""
    return f", within {tolerance:.3g}" if error <= tolerance else f", {tolerance:.3g} was asked for"
