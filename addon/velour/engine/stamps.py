"""Metadata of a picture on how it was made; farms check it before a frame counts as done."""

import json

import bpy

from ..native.version import version_text


class Stamps:
    """Stamps of one engine, which renders the view layers of a frame one after the other."""

    def __init__(self):
        self._frame = None
        self._models = {}  # {view layer: {material: hashes}}

    def add(self, result, depsgraph, models, notes_of_models, fields):
        """Writes the fields after a view layer is rendered.

        Of this layer: `models`, {material: hashes of the files it is rendered from}, and `notes_of_models`,
        {material: note on its scene model}. Of the picture: `fields`, namely samples (its range, if it has
        not all), denoised (text on its error), biased_by (names of options); empty ones are left out.
        """
        layer, frame = depsgraph.view_layer_eval.name, depsgraph.scene_eval.frame_current
        if frame != self._frame:
            self._frame, self._models = frame, {}
        self._models[layer] = models
        in_all = {name: hashes for layers in self._models.values() for name, hashes in layers.items()}
        result.stamp_data_add_field("velour.version", version_text())
        result.stamp_data_add_field("velour.blender", ".".join(map(str, bpy.app.version)))
        result.stamp_data_add_field("velour.models", json.dumps(in_all, sort_keys=True))
        for name, text in fields.items():
            if text:
                result.stamp_data_add_field(f"velour.{name}", text)
        for name, text in notes_of_models.items():
            result.stamp_data_add_field(f"velour.{layer}.{name}", text)
