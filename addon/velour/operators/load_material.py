"""Imports models and measurements as materials: File > Import, or files dropped into a window."""

import os
from typing import NamedTuple

import bpy
from bpy.props import BoolProperty, CollectionProperty, StringProperty
from bpy_extras.io_utils import ImportHelper

from ..core.files import read_bytes
from ..core.measurement_files import file_filter
from ..core.read_job import ReadJob, check
from ..export import ExportError
from ..export.files import sha256
from ..export.nodes import velour_node
from ..export.other_context import other_context
from ..native import VelourError, library
from . import measured
from .background_job import OneJob
from .slots import PutsInSlot, SlotTarget, slot_under

_MOST_SENTENCES = 10  # in a report


class _Found(NamedTuple):
    """A file to be imported as a material."""

    path: str
    kind: str
    digest: str  # SHA-256
    info: dict
    data: bytes | None  # contents of a model file; None for other kinds

    @property
    def name(self):
        return os.path.splitext(os.path.basename(self.path))[0]


def found_file(path):
    """The _Found of a model, a measurement or a BTF; raises ExportError or VelourError."""
    info = library.file_info(path)
    if info["kind"] == "observation":
        raise ExportError(f"{path} is a scene usage file; choose a model or a measurement.")
    if info["kind"] != "model":
        return _Found(path, info["kind"], info["sha256"], info, None)
    try:
        data = read_bytes(path)
    except OSError as error:
        raise ExportError(f"{path} cannot be read ({error.strerror}); check the file.") from error
    return _Found(path, info["kind"], sha256(data), info, data)


def _find(paths):
    """The readable files, and a sentence for each of the others. Runs on the job's thread."""
    found, sentences = [], []
    for path in paths:
        check()
        try:
            found.append(found_file(path))
        except (ExportError, VelourError) as error:
            if isinstance(error, VelourError) and error.cancelled:
                raise
            sentences.append(str(error))
    if found and sentences:
        sentences.insert(0, f"{len(sentences)} of {len(paths)} files were not imported.")
    return found, sentences


class VELOUR_OT_load_material(PutsInSlot, OneJob, bpy.types.Operator, ImportHelper):
    bl_idname = "velour.load_material"
    bl_label = "Import Material"
    bl_description = "Import materials from model files (.velour) or measurements (MERL, RGL, Cornell, BTFs)"
    bl_options = {"UNDO"}

    filename_ext = ".velour"
    filter_glob: StringProperty(default=file_filter(), options={"HIDDEN"})
    files: CollectionProperty(type=bpy.types.OperatorFileListElement, options={"HIDDEN", "SKIP_SAVE"})
    directory: StringProperty(subtype="DIR_PATH", options={"HIDDEN", "SKIP_SAVE"})
    pack: BoolProperty(
        name="Pack Models",
        description="Store models (kilobytes) in the .blend file. Measurements always stay files",
        default=True,
    )
    fit: BoolProperty(
        name="Fit Measurements", description="Fit a model to each imported measurement", default=True
    )

    assign: BoolProperty(
        name="Assign", description="Put the first material into a slot", default=True, options={"SKIP_SAVE"}
    )

    _what = "The import"
    _asks = False

    def invoke(self, context, event):
        """Files dropped on an object go into the slot under the cursor, elsewhere into none.

        Without files, opens a file browser."""
        if not (self.properties.is_property_set("filepath") or self.files):
            self._asks = True
            return ImportHelper.invoke(self, context, event)
        if context.area is not None and context.area.type == "VIEW_3D":
            slot = slot_under(context, event)
            self.assign = slot is not None
            if slot is not None:
                self.object, self.slot = slot
        return OneJob.invoke(self, context, event)

    def execute(self, context):
        if not self._asks:
            return OneJob.execute(self, context)
        try:
            for path in self._paths():
                measured.refuse_folder(path)
        except ExportError as error:
            return self._fail(error)
        # Blender ends the file browser's operator when this returns, so another one does the work.
        chosen = self.as_keywords(ignore=("check_existing", "filter_glob", "files"))
        chosen["files"] = [{"name": file.name} for file in self.files]
        with other_context(area=None):  # nothing was dropped
            bpy.ops.velour.load_material("INVOKE_DEFAULT", **chosen)
        return {"CANCELLED"}  # no undo step: the other operator adds it

    def _begin(self, context):
        paths = self._paths()
        self._subject = os.path.basename(paths[0])
        self._slot = SlotTarget.asked(context, self)
        self._job = ReadJob(lambda: _find(paths))

    def _finish(self):
        found, self._sentences = self._job.result()
        btfs = [file.path for file in found if file.kind == "btf"]
        materials = [self._load(file) for file in found if file.kind != "btf"]
        for number, material in enumerate(materials):
            if number == 0 and self._slot:
                self._slot.put(material, self.report)
            else:
                material.use_fake_user = True
        unfitted = [m.name for m in materials if measured.ensure_node(m).image is None]
        jobs = [(bpy.ops.velour.fit, {"material": name}) for name in unfitted if self.fit]
        jobs += [
            (bpy.ops.velour.approximate, {"material": m.name}) for m in materials if m.name not in unfitted
        ]
        place = {} if materials else self._place(len(btfs))  # the first file takes the slot
        for path in btfs:
            jobs.append((bpy.ops.velour.compress_btf, {"filepath": path, **place}))
            place = {}
        self._run_all(jobs)
        self._say_all()
        return {"FINISHED"} if found else {"CANCELLED"}

    def _place(self, count):
        """Slot arguments for the first of the operators that make `count` materials."""
        if self._slot is None:
            return {}
        taken = self._slot.take()
        if taken is None:
            if count:
                self._slot.tell("the material", self.report)
            return {}
        return {"assign": True, "object": taken[0].name, "slot": taken[1]}

    def _paths(self):
        names = [file.name for file in self.files if file.name]
        folder = bpy.path.abspath(self.directory)
        return [os.path.join(folder, name) for name in names] or [bpy.path.abspath(self.filepath)]

    def _load(self, file):
        if file.data is None:
            image = measured.measurement_image(file.path, file.digest)
            material = measured.new_material(file.name)
            measured.ensure_node(material).velour.measurement = image
            return material
        if self.pack:
            image = measured.packed_model(file.data, file.name, file.digest)
        else:
            image = measured.linked_model(file.path, file.digest)
        material = measured.new_material(file.name)
        measured.set_model(material, velour_node(material), image, self.report, info=file.info)
        return material

    def _run_all(self, jobs):
        """Queues jobs in the background if there is a window. A failure does not affect the others."""
        mode = "EXEC_DEFAULT" if bpy.app.background else "INVOKE_DEFAULT"
        for operator, arguments in jobs:
            try:
                operator(mode, **arguments)
            except RuntimeError as error:
                self._sentences.append(str(error).removeprefix("Error: ").strip())

    def _say_all(self):
        """Reports all errors at once. Readable files are imported even if their fit failed."""
        more = len(self._sentences) - _MOST_SENTENCES
        said = self._sentences[:_MOST_SENTENCES]
        if more > 0:
            said.append(f"{more} more errors are not shown.")
        if said:
            self.report({"ERROR"}, " ".join(said))
