"""The window: the panel of a material's outline, and the numbers in it."""

import bpy

from support import inputs, scenes, window

_TURNS = 100  # of 0.1 s that a measurement may take


def start(folder):
    """Called by the harness once the window is there."""
    window.run(folder, (outline_of_a_ball,))


def _ui(name):
    return inputs.module(f"ui.{name}")


def _measured():
    summary = _ui("placement_summary")
    for _ in range(_TURNS):
        for area in window.first().screen.areas:
            area.tag_redraw()
        yield 0.1
        last = next(reversed(summary._reports), None)
        report = summary._reports[last] if last in summary._fresh else None
        if report is not None and report.outline is not None:
            return report.outline
    raise AssertionError("nothing was measured")


def _scroll_to_the_panel():
    for _ in range(8):
        for _ in range(10):  # a turn of the wheel moves by little
            window.scroll_down(600)
        yield 0.1


def outline_of_a_ball(folder):
    """A net over a ball: the panel says how high it stands there, and when it folds."""
    for obj in list(bpy.data.objects):
        bpy.data.objects.remove(obj)
    material = scenes.measured_material(inputs.model_bytes(inputs.lambert_measurement()), "Net")
    with window.override():
        bpy.ops.velour.add_mesostructure(type="NET", count=2, resolution=8)
        tile = bpy.context.object
        bpy.ops.mesh.primitive_uv_sphere_add(radius=0.5, segments=64, ring_count=32)
        bpy.ops.object.shade_smooth()
        bpy.context.object.data.materials.append(material)
    scenes.use_engine(size=64)
    bpy.ops.velour.add_votf(material=material.name, structure=tile.name, texels=32)
    bpy.ops.velour.estimate_votf(material=material.name)
    settings = scenes.velour_node(material).velour
    settings.outline_width = 0.1
    window.open_panels("outline")
    yield from window.show_properties("MATERIAL")
    outline = yield from _measured()
    assert outline.share < 1, outline
    assert dict(outline.rows)["Tile width"] == "100 mm", outline.rows
    yield from _scroll_to_the_panel()
    window.screenshot(folder, "outline")
    settings.outline_width = 10
    outline = yield from _measured()
    assert "folds" in outline.warnings[0], outline
    yield from _scroll_to_the_panel()
    window.screenshot(folder, "outline-folds")
