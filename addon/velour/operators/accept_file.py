"""Accepts a file that has changed on disk."""

import bpy

from ..export import ExportError
from ..export.files import StoredFile, sha256
from ..export.nodes import velour_node
from . import measured
from .job_target import JobTarget
from .reads_first import ReadsFirst

_MEASUREMENT = "measurement"


class VELOUR_OT_accept_file(measured.OfMaterial, ReadsFirst, bpy.types.Operator):
    bl_idname = "velour.accept_file"
    bl_label = "Accept Changed File"
    bl_description = "Accept the model and measurement files as they are on disk now"
    bl_options = {"UNDO"}

    def _read(self, context):
        material = measured.find_material(context, self.material)
        node = velour_node(material)
        if node is None:
            raise ExportError("There is no measured material; select an object that has one.")
        measured.refuse_linked(material)
        if not _images(node):
            raise ExportError(f"Material '{material.name}' has no file of its own to accept.")
        self._target, self._subject = JobTarget(material, node), material.name
        owner = f"Material '{material.name}'"
        stored = {role: StoredFile.of(image, owner) for role, image in _images(node)}
        self._read_of = {role: measured.place_of(image) for role, image in _images(node)}
        return lambda: _digests(stored)

    def _use(self, _context, found):
        digests, sentences = found
        if sentences and not digests:
            raise ExportError(" ".join(sentences))
        for sentence in sentences:
            self.report({"WARNING"}, sentence)
        material, node = self._target.find()
        if material is None:
            self.report({"WARNING"}, "The material no longer exists, so no file was accepted.")
            return {"CANCELLED"}
        accepted = 0
        for role, image in _images(node):
            if self._read_of.get(role) == measured.place_of(image):
                image.velour.sha256 = digests.get(role, image.velour.sha256)
                accepted += role in digests
            else:
                sentence = (
                    f"Material '{material.name}': '{image.name}' was assigned meanwhile; accept it again."
                )
                self.report({"WARNING"}, sentence)
        return {"FINISHED"} if accepted else {"CANCELLED"}


def _images(node):
    """Local image datablocks of the material's files, with their roles."""
    roles = (("model", node.image), ("scene model", node.velour.scene_model))
    images = (*roles, (_MEASUREMENT, node.velour.measurement))
    return [(role, image) for role, image in images if image and image.library is None]


def _digests(stored):
    """SHA-256 by role, and a sentence for each file that cannot be read; other files are unaffected."""
    found, sentences = {}, []
    for role, file in stored.items():
        try:
            found[role] = _digest(role, file)
        except ExportError as error:
            sentences.append(str(error))
    return found, sentences


def _digest(role, stored):
    return stored.raw_info()["sha256"] if role == _MEASUREMENT else sha256(stored.content())
