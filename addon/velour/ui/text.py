"""Text in panels."""

import functools

import blf

from .units import button_height

_BESIDE = 2.3  # heights of a button that editor, panel and label leave free to the left and right of a text
_ICON = 1.3  # of an icon before it


def draw_sentence(context, layout, text, icon="NONE"):
    """A label a line, as wide as the region has room: Blender cuts long labels instead of wrapping them."""
    preferences = context.preferences
    taken = _BESIDE + (_ICON if icon != "NONE" else 0)
    room = context.region.width - taken * button_height(preferences.system)
    points = preferences.ui_styles[0].widget.points * preferences.system.ui_scale
    column = layout.column(align=True)
    for number, line in enumerate(_lines(text, room, points)):
        column.label(text=line, icon=icon if number == 0 or icon == "NONE" else "BLANK1")


@functools.lru_cache(maxsize=256)
def _lines(text, room, points):
    """At most `room` pixels wide; a word is broken where it has no room on a line of its own."""
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
    """How many of its characters; one at least."""
    count = len(word)
    while count > 1 and _width(word[:count], points) > room:
        count -= 1
    return count


def _width(text, points):
    """Pixels in Blender's own font."""
    blf.size(0, points)
    return blf.dimensions(0, text)[0]
