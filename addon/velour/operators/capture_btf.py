"""Captures a tile as a BTF: in the background or, without a window, synchronously."""

import os

import bpy
from bpy.props import BoolProperty, EnumProperty, IntProperty, StringProperty

from ..core.sizes import data_size
from ..core.warning_table import sentences
from ..export.tiles import export_tile
from ..native import capture_job
from ..properties.tile_settings import SIDES
from .background_job import OneJob
from .tiles import (
    CAPTURE_NUMBERS,
    OfTile,
    capture_options,
    find_tile,
    held_out_beside,
    new_folder,
    output_folder,
)

_NEW_FOLDER = "Capture into a new folder. The previous capture is kept"
_SETTINGS = ("directory", *CAPTURE_NUMBERS, "sides", "use_approximate")


class VELOUR_OT_capture_btf(OfTile, OneJob, bpy.types.Operator):
    bl_idname = "velour.capture_btf"
    bl_label = "Capture BTF"
    bl_description = (
        "Render the endlessly repeated tile from all views under all lights, and write the BTF to a folder"
    )

    # If set, these replace the settings of the tile.
    directory: StringProperty(name="Folder", subtype="DIR_PATH", options={"SKIP_SAVE"})
    texels: IntProperty(name="Texels", min=1, default=64, options={"SKIP_SAVE"})
    views: IntProperty(name="Views", min=1, default=81, options={"SKIP_SAVE"})
    lights: IntProperty(name="Lights", min=1, default=81, options={"SKIP_SAVE"})
    samples: IntProperty(name="Samples", min=1, default=8, options={"SKIP_SAVE"})
    bounces: IntProperty(name="Bounces", min=0, default=1, options={"SKIP_SAVE"})
    sides: EnumProperty(name="Sides", items=SIDES, default="ONE", options={"SKIP_SAVE"})
    held_out: IntProperty(
        name="Held-Out Pairs",
        description="Capture this many held-out view-light pairs for validation, in a folder next to the BTF."
        " 0: capture the BTF itself",
        min=0,
        max=4096,
        options={"SKIP_SAVE"},
    )
    use_approximate: BoolProperty(name="Approximate", options={"SKIP_SAVE"})
    seed: IntProperty(name="Seed", min=0, options={"SKIP_SAVE"})
    resume: BoolProperty(
        name="Resume",
        description="Continue a stopped capture of the same tile. If not set: only with a window",
        options={"SKIP_SAVE"},
    )
    new_folder: BoolProperty(
        name="New Folder",
        description="Keep the existing folder, and capture into a new, numbered one next to it",
        options={"SKIP_SAVE"},
    )

    _what = "The capture"
    _after_cancel = "; press Capture BTF to continue it"
    _later = None  # a job to start when the first has finished

    @classmethod
    def description(cls, _context, properties):
        return _NEW_FOLDER if properties.new_folder else cls.bl_description

    def invoke(self, context, event):
        """Resumes a stopped capture by default; the library resumes only captures of the same tile."""
        if not self.properties.is_property_set("resume"):
            self.resume = True
        return super().invoke(context, event)

    def _begin(self, context):
        tile = find_tile(context, self.collection)
        settings = tile.owner.velour
        for name in _SETTINGS:
            of_these_pairs = self.held_out and name == "directory"  # not the folder of the tile's BTF
            if self.properties.is_property_set(name) and not of_these_pairs:
                setattr(settings, name, getattr(self, name))
        self._subject, self._folder = tile.owner.name, self._folder_of(tile)
        scene, place, self._notes = export_tile(
            tile, context.evaluated_depsgraph_get(), settings.use_approximate
        )
        if self.new_folder:
            settings.directory = new_folder(tile)
            self._folder = self._folder_of(tile)
        options = {**capture_options(context, tile, place), "seed": self.seed, "resume": self.resume}
        with scene:
            self._job = capture_job(scene, self._folder, held_out=self.held_out, **options)
            if settings.held_out and not self.held_out:
                folder = held_out_beside(output_folder(tile.owner))
                self._later = folder, capture_job(scene, folder, held_out=settings.held_out, **options)

    def _goes_on(self):
        """Captures the held-out pairs next, of the tile as it was when the capture began."""
        if self._later is None:
            return False
        (self._folder, self._job), self._later = self._later, None
        return True

    def _folder_of(self, tile):
        if not self.held_out:
            return output_folder(tile.owner)
        if self.directory:
            return os.path.normpath(bpy.path.abspath(self.directory))
        return held_out_beside(output_folder(tile.owner))

    def _fail(self, error):
        if self._later is not None:
            self._later[1].close()
        return super()._fail(error)

    def _finish(self):
        with self._job:
            report = self._job.report()
        for sentence in (*self._notes, *sentences(report["warning_codes"])):
            self.report({"WARNING"}, sentence)
        resumed = report["views_resumed"]
        there = f"; {resumed} of {report['views']} views were captured earlier" if resumed else ""
        self.report(
            {"INFO"},
            f"Captured '{self._subject}' in {report['seconds']:.0f} s: {data_size(report['bytes'])} in"
            f" {self._folder}{there}",
        )
        return {"FINISHED"}
