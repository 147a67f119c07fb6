"""Text in panels."""

import functools

import blf

from .units import button_height

_BESIDE = 2.3  # width of the margins of editor, panel and label, in button heights
_ICON = 1.3  # width of an icon before the text, in button heights
_BESIDE_VALUE = 0.8  # width of the margins of a box and of the label of a value, in button heights


def draw_sentence(context, layout, text, icon="NONE"):
    """Wraps text to the region's width, one label per line, since Blender cuts long labels off."""
    column = layout.column(align=True)
    for number, line in enumerate(_wrapped(context, text, 1.0, _ICON if icon != "NONE" else 0)):
        column.label(text=line, icon=icon if number == 0 or icon == "NONE" else "BLANK1")


def value_lines(context, text, share):
    """Lines of a text in a column of a panel or a box that has this share of the width."""
    return _wrapped(context, text, share, _BESIDE_VALUE)


def _wrapped(context, text, share, taken):
    """Lines of a text in a share of a panel's width, of which so many button heights are taken."""
    if context.region is None:  # there is no window
        return (text,)
    preferences = context.preferences
    unit = button_height(preferences.system)
    room = share * (context.region.width - _BESIDE * unit) - taken * unit
    return _lines(text, room, _points(preferences))


def label_width(context, text):
    """Width of a text on the screen, in pixels."""
    return _width(text, _points(context.preferences))


def _points(preferences):
    return preferences.ui_styles[0].widget.points * preferences.system.ui_scale


@functools.lru_cache(maxsize=256)
def _lines(text, room, points):
    """Lines of at most `room` pixels; a word that is wider than a line is broken."""
    lines, line = [], ""
    for word in text.split():
        longer = f"{line} {word}" if line else word
        if line and _width(longer, points) > room:
            lines.append(line)
            longer = word
        while (fitting := _fitting(longer, room, points)) < len(longer):
            lines.append(longer[:fitting])
            longer = longer[fitting:]
        line = longer
    return (*lines, line)


def _fitting(word, room, points):
    """Number of the word's characters that fit, at least one."""
    count = len(word)
    while count > 1 and _width(word[:count], points) > room:
        count -= 1
    return count


def _width(text, points):
    """Width in pixels in Blender's own font."""
    blf.size(0, points)
    return blf.dimensions(0, text)[0]
