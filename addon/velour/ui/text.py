"""Text in panels."""

import textwrap

_POINTS_A_CHARACTER = 7.2  # of the default font, on average


def draw_wrapped(layout, text, icon="NONE", region_width=600, ui_scale=1.0):
    """A label a line: Blender cuts long labels instead of wrapping them."""
    width = max(24, int(region_width / (_POINTS_A_CHARACTER * ui_scale)) - 6)
    column = layout.column(align=True)
    for number, line in enumerate(textwrap.wrap(text, width)):
        column.label(text=line, icon=icon if number == 0 else "BLANK1")


def draw_sentence(context, layout, text, icon="NONE"):
    """`draw_wrapped` to the width of the region that is being drawn."""
    width = context.region.width if context.region else 600
    draw_wrapped(layout, text, icon, width, context.preferences.system.ui_scale)


def data_size(count):
    """Bytes in the largest unit of which they are at least ten, or in the smallest."""
    unit, factor = ("MB", 1e6) if count >= 1e7 else ("kB", 1e3)
    return f"{count / factor:,.0f} {unit}"
