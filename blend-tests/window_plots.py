"""The plots of the material panel: drawn to the pixel, once, in the theme's colors."""

import os
import time

import bpy
import numpy as np

from support import plots, scenes, window

SCREEN = "1400x720"


def start(folder):
    """Called by the harness once the window is there."""
    window.open_panels("advanced", "plots")
    window.run(folder, (each_plot, light_theme, slider, in_the_background, overtaken))


def each_plot(folder):
    """The large plot is on the screen pixel by pixel; the small editor has one of its own size."""
    plots.material()
    for number, kind in enumerate(("LOBES", "ORDER", "VIEW_ERROR", "ALBEDO")):
        plots.preview().forget()
        yield from plots.show(kind, scroll=0 if number else 15)
        small, large = sorted(plots.pictures(), key=len)
        assert len(small) < len(large), (len(small), len(large))
        screen = yield from plots.screenshot(folder, f"plot-{kind.lower()}", large)
        assert plots.is_on_screen(screen, large), f"{kind}: the plot is not on the screen pixel by pixel"
        assert not plots.is_on_screen(screen, large[::-1]), "the check would see the plot upside down as well"
    large_again = plots.pictures()
    for area in window.first().screen.areas:
        area.tag_redraw()
    yield 0.5
    assert len(plots.pictures()) == len(large_again), "drawn again at a redraw"


def light_theme(folder):
    plots.material()
    yield from plots.show("LOBES")
    dark = plots.pictures()[-1]
    path = os.path.join(bpy.utils.preset_paths("interface_theme")[0], "Blender_Light.xml")
    with window.override():
        bpy.ops.script.execute_preset(filepath=path, menu_idname="USERPREF_MT_interface_theme_presets")
    yield from plots.drawn()
    shown = plots.pictures()[-2:]
    screen = yield from plots.screenshot(folder, "light", max(shown, key=len))
    bpy.ops.preferences.reset_default_theme()
    yield 0.3
    assert min(picture.mean() for picture in shown) > dark.mean() + 50
    assert any(plots.is_on_screen(screen, picture) for picture in shown)


def slider(folder):
    """Another view gives another picture; until it is there the one before stays."""
    plots.material()
    yield from plots.show("LOBES")
    preview, before = plots.preview(), plots.pictures()
    bpy.context.window_manager.velour.plot.view = np.radians(65)
    node = scenes.velour_node(bpy.data.materials["Paint"])
    side = max(map(len, before))
    asked = bpy.context, node.image, node.velour.measurement, "LOBES", side
    assert preview.plot_picture(*asked).icon != 0, "the picture before is not shown"
    assert len(plots.pictures()) == len(before), "drawn while it was asked for"
    yield from plots.drawn()
    window.screenshot(folder, "slider")
    assert len(plots.pictures()) > len(before)
    assert not np.array_equal(plots.pictures()[-1], before[-1])


_HELD_SECONDS = 0.1  # of the processor that a turn of the plots may take from the main thread


def in_the_background(folder):
    """The event loop goes round while a measurement is read and albedos are worked out."""
    plots.material()
    preview = plots.preview()
    yield from plots.show("ORDER")
    preview.forget()
    turn, seconds = preview._turn, []

    def timed():
        start = time.thread_time()
        wait = turn()
        seconds.append(time.thread_time() - start)
        return wait

    preview._turn = timed
    bpy.context.window_manager.velour.plot.kind = "ALBEDO"
    _redraw()
    fractions = set()
    for _ in range(2000):
        yield 0.0
        fractions |= {work.fraction for work in preview._works.values() if work.fraction is not None}
        if fractions and preview.is_at_rest():
            break
    preview._turn = turn
    window.screenshot(folder, "albedo-at-rest")
    assert any(0 < f < 1 for f in fractions), (
        f"the plot was made at once, not beside the window: {sorted(fractions)}"
    )
    assert max(seconds) < _HELD_SECONDS, f"a turn held the window for {max(seconds):.3f} s"


def overtaken(folder):
    """A slider that moves on leaves no queue behind: of all its places the last alone is waited for."""
    plots.material()
    yield from plots.show("LOBES")
    preview, before = plots.preview(), len(plots.pictures())
    node = scenes.velour_node(bpy.data.materials["Paint"])
    for degrees in range(10, 60):
        bpy.context.window_manager.velour.plot.view = np.radians(degrees)
        preview.plot_picture(bpy.context, node.image, node.velour.measurement, "LOBES", 300)
    assert len(preview._waiting) + len(preview._works) <= 2, (preview._waiting, preview._works)
    yield from plots.drawn()
    assert len(plots.pictures()) <= before + 4, "places that the slider has left were drawn"
    (angle, _azimuth) = [wanted.angles for wanted in preview._pictures if wanted.style[0] == ("side", 300)][
        -1
    ]
    assert abs(np.degrees(angle) - 59) < 1e-3, np.degrees(angle)


def _redraw():
    for area in window.first().screen.areas:
        area.tag_redraw()
