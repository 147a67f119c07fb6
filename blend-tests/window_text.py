"""The window: sentences in panels fill the lines and are cut nowhere, whatever the scale of the interface."""

import types
from unittest import mock

import bpy
import numpy as np

from support import inputs, plots, scenes, window
from support.panels import Layout

_TEXT = (
    "Material 'Paint': the file '/home/someone/measurements/paint/blue-metallic-paint-of-a-car.velour' has"
    " changed since it was chosen; restore it, or accept it with"
    " 'Accept Changed File' in the Material tab."
)
_NEW_WINDOW = 320  # width in pixels of the Properties editor of factory settings on a screen of 1920
_OF_1600 = 248  # width in pixels of its panels on a screen of 1600
_SLACK = 4  # pixels that glyphs leave free at the ends of a line
_shown = {"text": "", "icon": "NONE", "active": True}
SCREEN = "1400x720"


class _Engine(bpy.types.RenderEngine):
    """That no other panels are for."""

    bl_idname = "TEST_ENGINE"
    bl_label = "Test"


class _Sentence(bpy.types.Panel):
    bl_idname = "TEST_PT_sentence"
    bl_label = "Sentence"
    bl_space_type = "PROPERTIES"
    bl_region_type = "WINDOW"
    bl_context = "render"

    @classmethod
    def poll(cls, context):
        return context.engine == _Engine.bl_idname

    def draw(self, context):
        column = self.layout.column()
        column.active = _shown["active"]
        _text().draw_sentence(context, column, _shown["text"], _shown["icon"])


def start(folder):
    """Called by the harness once the window is there."""
    bpy.utils.register_class(_Engine)
    bpy.utils.register_class(_Sentence)
    window.run(folder, (plain, large, labels, buttons, values))


def _text():
    return inputs.module("ui.text")


def plain(folder):
    yield from _each(folder, 1.0)


def large(folder):
    yield from _each(folder, 2.0)
    bpy.context.preferences.view.ui_scale = 1.0


def _each(folder, scale):
    bpy.context.preferences.view.ui_scale = scale
    yield from window.show_properties("RENDER")
    areas = [area for area in window.first().screen.areas if area.type == "PROPERTIES"]
    wide, narrow = sorted(areas, key=lambda area: -area.width)
    narrow.spaces.active.context = "RENDER"
    bpy.context.scene.render.engine = _Engine.bl_idname
    for area in (wide, narrow):
        for icon in ("NONE", "INFO"):
            name = f"{scale:g}-{'wide' if area == wide else 'narrow'}-{icon.lower()}"
            lines, pixels, region = yield from _drawn(folder, name, area, icon)
            assert "".join(lines).replace(" ", "") == _TEXT.replace(" ", "")
            assert pixels > _widest(lines) - _SLACK, (
                f"{name}: lines of {_widest(lines)} are cut to {pixels} pixels"
            )
            if area == wide:
                assert pixels > 0.8 * region.width, f"{name}: {pixels} of {region.width} pixels are used"
    with mock.patch.object(_text(), "_BESIDE", 0.0):
        lines, pixels, _region = yield from _drawn(folder, f"{scale:g}-control", wide, "INFO")
    assert pixels < _widest(lines) - _SLACK, "the check would not see a line that is cut"


def labels(folder):
    """No name of a setting in the Material tab is cut at the width that the tab has in a new window."""
    material = plots.material()
    scenes.velour_node(material).velour.model = "SCATTERED"
    scenes.use_engine()
    yield from window.show_properties("MATERIAL")
    panels = inputs.module("ui.advanced_panel")
    tab = inputs.module("ui.material_panel")
    area = max(window.first().screen.areas, key=lambda a: a.width * a.height)
    region = next(region for region in area.regions if region.type == "WINDOW")
    found = {}
    with window.in_context(window=window.first(), area=area, region=region):
        for panel in (tab.VELOUR_MATERIAL_PT_measured, panels.VELOUR_MATERIAL_PT_advanced):
            for model in ("SCATTERED", "PARAMETRIC"):
                scenes.velour_node(material).velour.model = model
                recorder = _Names(panel)
                panel.draw(recorder, bpy.context)
                found |= recorder.names
    assert len(found) > 10, found
    room = _NEW_WINDOW - 2.3 * _unit()  # without margins
    cut = {name for name, share in found.items() if _text()._width(name, _points()) > share * room}
    assert not cut, cut
    assert _text()._width("Render from the Measurement of the Material", _points()) > room / 2  # the control


def buttons(folder):
    """No text of a button in the Material tab is cut on a small screen."""
    material = plots.material()
    scenes.use_engine()
    yield from window.show_properties("MATERIAL")
    tab, scene_model = (inputs.module(f"ui.{name}") for name in ("material_panel", "scene_model_panel"))
    panels = tab.VELOUR_MATERIAL_PT_measured, scene_model.VELOUR_MATERIAL_PT_scene_model
    rows = []
    with _over_the_tab():
        for panel in panels:
            panel.draw(recorder := _Names(panel), bpy.context)
            rows += recorder.rows
        for slot in bpy.data.objects["Cube"].material_slots:
            slot.material = None
    yield 0.5
    with _over_the_tab():
        assert bpy.context.material is None
        panels[0].draw(recorder := _Names(panels[0]), bpy.context)
    rows += recorder.rows
    material.use_fake_user = True
    assert {"Fit", "Fit for This Scene", "Use Measured Material"} <= {text for row in rows for text, _ in row}
    cut = [row for row in rows if _is_cut(row)]
    assert not cut, cut
    assert _is_cut([("Use Measured Material", "NONE"), ("Import...", "NONE")])  # the control
    assert _is_cut([("Fit for This Scene", "PLAY"), ("This Frame Only", "NONE")])


def _is_cut(row):
    """Whether the text of a button in a row of buttons (text, icon) is cut."""
    room = (_OF_1600 - 2.3 * _unit()) / max(len(row), 1)
    return any(
        _text()._width(text, _points()) + (0.8 if icon == "NONE" else 1.6) * _unit() > room
        for text, icon in row
    )


def values(folder):
    """Values beside names are wrapped at that width; nothing of them is lost."""
    yield from window.show_properties("MATERIAL")
    preferences = bpy.context.preferences
    context = types.SimpleNamespace(
        region=types.SimpleNamespace(width=_NEW_WINDOW), preferences=preferences, window=None
    )
    value = "72.7 x 72.7 mm, 24.2 x 24.2 times real size"
    lines = _text().value_lines(context, value, 0.6)
    assert " ".join(lines) == value
    assert len(lines) > 1
    room = 0.6 * (_NEW_WINDOW - 2.3 * _unit())
    assert _widest(lines) < room
    assert _widest([value]) > room  # the control


def _over_the_tab():
    area = max(window.first().screen.areas, key=lambda a: a.width * a.height)
    region = next(region for region in area.regions if region.type == "WINDOW")
    return window.in_context(window=window.first(), area=area, region=region)


class _Names(Layout):
    """Remembers the names beside settings, and the share of the width that each has; and rows of buttons."""

    def __init__(self, cls, around=None, row=None):
        super().__init__(cls)
        self.names = around.names if around else {}
        self.rows = around.rows if around else []
        self._row = row  # of buttons; None: each button is a row

    def row(self, **_keywords):
        self.rows.append([])
        return _Names(self._cls, self, self.rows[-1])

    def column(self, **_keywords):
        return _Names(self._cls, self)

    def operator(self, name, text="", icon="NONE", **keywords):
        prefix, _, rest = name.partition(".")
        button = text or getattr(bpy.types, f"{prefix.upper()}_OT_{rest}").bl_label, icon
        if self._row is None:
            self.rows.append([button])
        else:
            self._row.append(button)
        return super().operator(name, **keywords)

    def prop(self, owner, name, text="", **keywords):
        known = owner.bl_rna.properties[name]
        # The name of a check box is behind it, in the wider column.
        self.names[text or known.name] = 0.52 if known.type == "BOOLEAN" else 0.4
        super().prop(owner, name, text, **keywords)


def _widest(lines):
    return max(_text()._width(line, _points()) for line in lines)


def _points():
    preferences = bpy.context.preferences
    return preferences.ui_styles[0].widget.points * preferences.system.ui_scale


def _unit():
    return inputs.module("ui.units").button_height(bpy.context.preferences.system)


def _drawn(folder, name, area, icon):
    """The lines that the panel in `area` has, the pixels across that they take, and its region."""
    region = next(region for region in area.regions if region.type == "WINDOW")
    lines, wrap, pictures = {}, _text()._lines, []

    def noted(*arguments):
        found = lines[bpy.context.region.width] = wrap(*arguments)
        return found

    with mock.patch.object(_text(), "_lines", noted):
        for active in (True, False):
            _shown.update(text=_TEXT, icon=icon, active=active)
            area.tag_redraw()
            yield 0.6
            pictures.append(window.screenshot(folder, f"{name}-{'bright' if active else 'gray'}"))
    return lines[region.width], _extent(*pictures, region), region


def _extent(bright, gray, region):
    """Pixels from the first column that differs to the last: what was drawn of the text, an icon left out."""
    rows, columns = slice(region.y, region.y + region.height), slice(region.x, region.x + region.width)
    differs = np.abs(bright - gray).max(axis=2)[rows, columns] > 0.05
    found = np.flatnonzero(differs.any(axis=0))
    if _shown["icon"] != "NONE":
        found = found[found > found[0] + _unit()]  # an icon is narrower, the text begins behind it
    return int(found[-1] - found[0] + 1)
