"""The plots of error against lobes, or bytes, as icons, which is what a panel can show."""

import bpy.utils.previews

from ..core.small_plot import order_picture

_KEPT = 64
_previews = None


def order_icon(order, **options):
    """The icon of a model's curve, drawn with the options of order_picture.

    0, which draws nothing, without a window.
    """
    global _previews
    if _previews is None:
        _previews = bpy.utils.previews.new()
    key = repr((order, options))
    if key not in _previews:
        if len(_previews) == _KEPT:
            _previews.clear()
        picture = order_picture(order, **options)
        preview = _previews.new(key)
        preview.image_size = picture.shape[1], picture.shape[0]
        preview.image_pixels_float.foreach_set(picture.ravel())
    return _previews[key].icon_id


def forget():
    global _previews
    if _previews is not None:
        bpy.utils.previews.remove(_previews)
        _previews = None
