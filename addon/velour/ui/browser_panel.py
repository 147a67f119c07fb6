"""Browser panel of a material: a folder of measurements and models, as thumbnails of balls."""

import os

import bpy

from ..core.measurement_files import MEASUREMENTS, MODELS
from ..core.sizes import data_size
from ..operators.browse import (
    VELOUR_OT_choose_measurement,
    VELOUR_OT_make_thumbnails,
    VELOUR_OT_refresh_browser,
    addon_preferences,
    measurement_folder,
)
from ..operators.load_material import VELOUR_OT_load_material
from . import browser
from .material_panel import MaterialPanel
from .text import draw_sentence
from .units import button_height

_ROWS = 3
_PICTURE = 5.0  # height in buttons
_BESIDE = 2.0  # width of the panel's and editor's margins in buttons
_USES = {"measurement": "Use and Fit", "btf": "Use and Fit"}


class VELOUR_MATERIAL_PT_browser(MaterialPanel, bpy.types.Panel):
    bl_label = "Measurement Library"
    bl_options = {"DEFAULT_CLOSED"}

    @classmethod
    def poll(cls, context):
        return super().poll(context) and context.object is not None  # the material goes into its slot

    def draw(self, context):
        layout, preferences = self.layout, addon_preferences(context)
        if preferences is None:
            return
        row = layout.row(align=True)
        row.prop(preferences, "measurements", text="")
        folder = measurement_folder(context)
        if not folder:
            draw_sentence(
                context, layout, "Choose a folder of measurements (MERL, RGL, Cornell, BTFs) or models."
            )
            return
        row.operator(VELOUR_OT_refresh_browser.bl_idname, text="", icon="FILE_REFRESH")
        settings = context.window_manager.velour.browser
        found = browser.found(folder, settings.visits)
        if found is None:
            layout.label(text="Searching the folder...", icon="TIME")
            return
        for problem in found.problems:
            draw_sentence(context, layout, problem, icon="ERROR")
        _draw_files(context, layout, settings, found.files)


def _draw_files(context, layout, settings, files):
    layout.prop(settings, "search", text="", icon="VIEWZOOM")
    words = settings.search.casefold().split()
    matching = [file for file in files if all(word in file.name.casefold() for word in words)]
    if not matching:
        draw_sentence(context, layout, _nothing(files), icon="INFO")
        return
    columns = _columns(context)
    page, pages = _page(settings.page, len(matching), columns * _ROWS)
    first = page * columns * _ROWS
    shown = matching[first : first + columns * _ROWS]
    browser.ask(matching[first : first + 2 * columns * _ROWS])  # this page, then the next one
    grid = layout.grid_flow(row_major=True, columns=columns, even_columns=True, even_rows=True)
    for file in shown:
        _draw_cell(grid.column(align=True), settings, file)
    for _ in range(columns - len(shown)):  # keeps the size of pictures if there are few
        grid.column()
    row = layout.row()
    row.prop(settings, "page")
    row.label(text=f"of {pages}, {len(matching):,} files")
    chosen = next((file for file in matching if file.path == settings.chosen), None)
    if chosen is not None:
        _draw_chosen(context, layout.box(), chosen)
    layout.operator(VELOUR_OT_make_thumbnails.bl_idname)


def _nothing(files):
    if files:
        return "No file name contains all of these words."
    measurements, models = ", ".join(MEASUREMENTS), ", ".join(MODELS)
    return f"This folder and its subfolders contain no measurements ({measurements}) or models ({models})."


def _columns(context):
    unit = button_height(context.preferences.system)
    return max(2, int((context.region.width / unit - _BESIDE) / (_PICTURE + 0.5)))


def _page(asked, count, a_page):
    """Page index from 0, and number of pages."""
    pages = -(-count // a_page)
    return min(asked, pages) - 1, pages


def _draw_cell(column, settings, file):
    picture = browser.picture(file)
    column.template_icon(picture.icon if picture else 0, scale=_PICTURE)  # keeps the height without an icon
    column.operator(
        VELOUR_OT_choose_measurement.bl_idname,
        text=os.path.basename(file.name),
        icon="ERROR" if picture and picture.sentence else "NONE",
        depress=file.path == settings.chosen,
    ).filepath = file.path


def _draw_chosen(context, box, file):
    picture = browser.picture(file)
    box.label(text=file.name)
    if picture is None:
        box.label(text="Rendering the thumbnail...", icon="TIME")
    elif picture.sentence:
        draw_sentence(context, box, picture.sentence, icon="ERROR")
        return
    facts = picture.facts if picture else {}
    box.label(text=f"{_described(facts)}{data_size(file.bytes)}")
    use = box.operator(
        VELOUR_OT_load_material.bl_idname, text=_USES.get(facts.get("kind"), "Use"), icon="MATERIAL"
    )
    use.filepath = file.path


def _described(facts):
    """Description of a file, with a trailing comma."""
    kind = facts.get("kind")
    if kind is None:
        return ""
    words = {"measurement": "Measured BRDF", "btf": "Measured BTF", "model": "Model"}.get(kind, kind)
    details = facts.get("format") if kind != "model" else None
    return f"{words} ({details}), " if details else f"{words}, "
