"""The window: panels of a material made from a BTF, and the numbers in them."""

from types import SimpleNamespace

import bpy
import numpy as np
from velour.core.sizes import data_size

from support import inputs, scenes, window

_TURNS = 100  # of 0.1 s that a measurement may take


def start(folder):
    """Called by the harness once the window is there."""
    parts = (model_rows, repeats, real_size, unknown_size, follows_changes, without_coordinates, brushed)
    window.open_panels("advanced", "model")
    window.run(folder, parts)


def _ui(name):
    return inputs.module(f"ui.{name}")


def _plane(metres=0.5):
    """A plane of 2 m with the tile of four grays, seen from above, and its material's tab."""
    for obj in list(bpy.data.objects):
        bpy.data.objects.remove(obj)
    with window.override():
        obj = scenes.add_plane(scenes.measured_material(inputs.quarters_model(metres), "Quarters"))
    scenes.add_camera(ortho_scale=2.0)
    yield from window.show_properties("MATERIAL")
    scenes.use_engine(size=64)
    return obj


def _settings():
    return scenes.velour_node(bpy.data.materials["Quarters"]).velour.placement


def _report():
    """What the panel shows once it is measured."""
    summary = _ui("placement_summary")
    for area in window.first().screen.areas:
        area.tag_redraw()
    for _ in range(_TURNS):
        yield 0.1
        last = next(reversed(summary._reports), None)
        if last in summary._fresh and summary._reports[last] is not None:
            return summary._reports[last].placement
    raise AssertionError("nothing was measured")


def _model_info(material):
    """Summary of the material's model, once it is read."""
    for _ in range(_TURNS):
        info = _ui("summaries").model_summary(scenes.velour_node(material).image)
        if info is not None:
            return info
        yield 0.1
    raise AssertionError("the model was not read")


def model_rows(folder):
    """The Model panel's rows are those of the model."""
    yield from _plane()
    material = bpy.data.materials["Quarters"]
    info = yield from _model_info(material)
    size = scenes.velour_node(material).image.packed_file.size
    rows = dict(_ui("model_panel")._btf_rows(info))
    raw = 6 * (inputs.QUARTER_TEXELS * 16) ** 2  # texels and pairs of half-float colors
    assert rows["Model"] == "BTF, SRBF", rows
    assert rows["Texels"] == "16 x 16", rows
    assert rows["Tile"] == "500 x 500 mm", rows
    assert rows["Directions"] == "16 views, 16 lights", rows
    assert rows["Lobes"] == f"{info['lobes']}, {info['coefficients']} coefficients per texel", rows
    assert rows["Side"] == f"front: {data_size(info['parameter_bytes'])} in memory", rows
    assert rows["Size"] == f"{data_size(size)}, 1:{raw / size:.0f}", rows
    assert float(rows["PSNR"].removesuffix(" dB")) > 40, rows  # four grays: a constant holds them
    assert rows["Held-out pairs"] == "not measured", rows
    yield from _report()
    window.scroll_down(600)
    yield 0.3
    window.screenshot(folder, "model-rows")


def repeats(folder):
    yield from _plane()
    report = yield from _report()
    assert dict(report.rows)["Tile size"] == "2 x 2 m, 4 x 4 times real size", report.rows
    before = window.screenshot(folder, "repeats-one")
    _settings().repeats = (4, 4)
    report = yield from _report()
    yield 0.3
    assert dict(report.rows)["Tile size"] == "500 x 500 mm, real size", report.rows
    assert np.abs(window.screenshot(folder, "repeats-four") - before).max() > 0.2, (
        "the panel shows nothing new"
    )


def real_size(folder):
    yield from _plane()
    _settings().mode = "REAL_SIZE"
    report = yield from _report()
    yield 0.3
    rows = dict(report.rows)
    assert rows["UV density"] == "0.5 x 0.5 per meter", rows
    assert rows["Texels"] == "0.032 per mm", rows
    assert rows["In the camera"] == "1 texels per pixel, minimum 1", rows
    assert report.warnings == ()
    window.screenshot(folder, "real-size")


def unknown_size(folder):
    yield from _plane(metres=0)
    _settings().mode = "REAL_SIZE"
    report = yield from _report()
    yield 0.3
    assert "enter Tile Size" in report.warnings[0], report.warnings
    window.screenshot(folder, "unknown-size")
    image = scenes.velour_node(bpy.data.materials["Quarters"]).image
    assert dict(_ui("model_panel")._btf_rows(_ui("summaries").model_summary(image)))["Tile"] == "unknown size"


def follows_changes(folder):
    """The panel measures again when the object, the camera or the frame changes."""
    obj = yield from _plane()
    yield from _report()
    obj.scale.x = 3
    bpy.context.view_layer.update()
    report = yield from _report()
    assert "up to 3.0:1" in report.warnings[0], report.warnings
    yield 0.3
    window.screenshot(folder, "stretched")
    bpy.context.scene.camera.data.ortho_scale = 4
    bpy.context.view_layer.update()
    report = yield from _report()
    texels = 16 / np.sqrt(12) * 4 / 64  # 12 m^2 for a tile of 16 x 16
    assert dict(report.rows)["In the camera"] == f"{texels:.3g} texels per pixel, minimum {texels:.3g}", (
        report.rows
    )


def without_coordinates(folder):
    obj = yield from _plane()
    obj.data.uv_layers.remove(obj.data.uv_layers[0])
    obj.data.update()  # newer Blenders do not notice by themselves
    report = yield from _report()
    yield 0.3
    assert "is projected onto it" in report.warnings[0], report.warnings
    window.screenshot(folder, "without-coordinates")


def brushed(folder):
    """What is anisotropic has two fields of it, what is isotropic has none."""
    obj = yield from _plane()
    panel = _ui("placement_panel").VELOUR_MATERIAL_PT_placement
    obj.data.uv_layers.remove(obj.data.uv_layers[0])
    matt = inputs.model_bytes(inputs.lambert_measurement())
    for name, model, is_brushed in (("matt", matt, False), ("brushed", inputs.brushed_model(), True)):
        obj.data.materials.clear()
        obj.data.materials.append(scenes.measured_material(model, name))
        yield from _model_info(obj.active_material)
        if is_brushed:
            report = yield from _report()
            assert report.rows == (), report
            assert "is projected onto it" in report.warnings[0], report
        yield 0.5
        window.screenshot(folder, f"placed-{name}")
        assert panel.poll(SimpleNamespace(material=obj.active_material)) == is_brushed
