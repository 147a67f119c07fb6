"""Operators of the browser for a folder of measurements and models."""

import os
from pathlib import Path

import bpy
from bpy.props import StringProperty

from ..core.measurement_files import find_measurements
from ..core.read_job import ReadJob, is_cancelled
from ..core.thumbnail_job import ThumbnailJob
from ..core.thumbnails import thumbnail_folder
from ..export import ExportError
from ..export.caches import cache_folder
from .background_job import JobsInSteps

_MOST_SENTENCES = 5


def addon_preferences(context):
    """Velour's preferences; None if it is not installed as an add-on."""
    addon = context.preferences.addons.get(__package__.rpartition(".")[0])
    return addon.preferences if addon else None


def measurement_folder(context):
    """Absolute measurement folder of the preferences; "" if none is chosen."""
    preferences = addon_preferences(context)
    chosen = preferences.measurements if preferences else ""
    return os.path.normpath(bpy.path.abspath(chosen)) if chosen else ""


class VELOUR_OT_choose_measurement(bpy.types.Operator):
    bl_idname = "velour.choose_measurement"
    bl_label = "Choose"
    bl_options = {"INTERNAL"}

    filepath: StringProperty(subtype="FILE_PATH", options={"SKIP_SAVE"})

    @classmethod
    def description(cls, _context, properties):
        return properties.filepath

    def execute(self, context):
        context.window_manager.velour.browser.chosen = self.filepath
        return {"FINISHED"}


class VELOUR_OT_refresh_browser(bpy.types.Operator):
    bl_idname = "velour.refresh_browser"
    bl_label = "Refresh"
    bl_description = "Search the folder again"
    bl_options = {"INTERNAL"}

    def execute(self, context):
        context.window_manager.velour.browser.visits += 1
        return {"FINISHED"}


class VELOUR_OT_make_thumbnails(JobsInSteps, bpy.types.Operator):
    bl_idname = "velour.make_thumbnails"
    bl_label = "Make All Thumbnails"
    bl_description = (
        "Render the thumbnails of all measurements and models in the folder now instead of on demand, and"
        " cache them"
    )

    directory: StringProperty(
        name="Folder",
        subtype="DIR_PATH",
        description="Folder of measurements. Empty: the folder set in the preferences",
        options={"SKIP_SAVE"},
    )

    _what = "Making thumbnails"

    def _begin(self, context):
        folder = bpy.path.abspath(self.directory) or measurement_folder(context)
        if not folder:
            raise ExportError("No folder of measurements is chosen; choose one in Velour's preferences.")
        self._subject = os.path.basename(os.path.normpath(folder))
        self._steps = _Pictures(folder, Path(cache_folder()), context.scene.render.threads)
        self._advance()
        self._goes_on()

    def _finish(self):
        if self._advance():
            return None
        pictures = self._steps
        for sentence in pictures.sentences[:_MOST_SENTENCES]:
            self.report({"WARNING"}, sentence)
        rest = len(pictures.sentences) - _MOST_SENTENCES
        more = f" {rest} more warnings are not shown." if rest > 0 else ""
        self.report(
            {"INFO"},
            f"{len(pictures.files)} files, {pictures.made} of them with a thumbnail,"
            f" in {pictures.kept}.{more}",
        )
        return {"FINISHED"}


class _Pictures:
    """Jobs that make thumbnails, and their results: `files`, `made` and `sentences`. `kept`: the folder."""

    def __init__(self, folder, cache, threads):
        self._folder, self._cache, self._threads = folder, cache, threads
        self.kept = thumbnail_folder(cache)
        self.files, self.sentences, self.made = (), [], 0
        self._jobs = self._run()

    def next_job(self):
        return next(self._jobs, None)

    def _run(self):
        finding = ReadJob(lambda: find_measurements(self._folder, is_cancelled))
        yield finding
        self.files, problems = finding.result()
        self.sentences += problems
        yield ThumbnailJob(self.files, self._cache, self._count, self._threads)

    def _count(self, _file, thumbnail):
        """Called on the job's thread."""
        self.made += thumbnail.pixels is not None
        if thumbnail.sentence:
            self.sentences.append(thumbnail.sentence)
