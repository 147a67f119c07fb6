"""Copies the film's passes to Blender's render result."""

import json
from typing import NamedTuple

import bpy
import numpy as np

from ..export.camera import View
from ..export.layer_passes import COMBINED, CRYPTOMATTES, layer_passes
from ..native import cryptomatte_id

_OF_LIGHT = ("Combined", "Noisy Image", "Error")
_ALONG_CAMERA = ("Denoising Normal",)  # as in Cycles; Normal itself is in world axes


def register_passes(engine, scene, layer):
    """Tells the compositor which sockets to show."""
    for each in layer_passes(scene, layer):
        engine.register_pass(scene, layer, each.name, each.channels, each.letters, each.kind)


def add_passes(engine, layer, shown):
    """Call before begin_result(). Adds the passes that Blender does not make; it ignores those that exist."""
    for each in shown:
        if each.name != COMBINED.name:
            engine.add_pass(each.name, each.channels, each.letters, layer=layer.name)


class Delivery(NamedTuple):
    """Copies a job's film to Blender's result."""

    result: bpy.types.RenderResult
    view: View
    exposure: float  # factor on light
    split: int  # light directions per camera ray; panels and statistics count camera rays

    def write(self, job, shown):
        """Copies those of the LayerPasses `shown` that the result has."""
        by_name = {each.name: each for each in shown}
        for target in self.result.layers[0].passes:
            found = by_name.get(target.name)
            if found:
                _fill(target.rect, self._pixels(job, found))

    def _pixels(self, job, found):
        """[pixels x channels]"""
        if found.source is None:
            width, height = job.size
            return np.zeros((width * height, found.channels), np.float32)
        pixels = job.read_pass(found.source).reshape(-1, found.channels)
        if found.name in _OF_LIGHT:
            pixels[:, :3] *= self.exposure
        return self.view.along_axes(pixels) if found.name in _ALONG_CAMERA else pixels


def _fill(rect, pixels):
    """Blender 3.4 to 4.x take [pixels x channels], 5.x takes them flat; neither accepts the other."""
    try:
        rect.foreach_set(pixels)
    except TypeError:
        rect.foreach_set(pixels.reshape(-1))


def stamp_cryptomattes(result, layer, names):
    """Adds metadata with the names of ids (Cryptomatte specification). `names`: by kind of Cryptomatte."""
    for kind, passes in CRYPTOMATTES.items():
        if getattr(layer, f"use_pass_cryptomatte_{kind}"):
            for field, value in _fields(f"{layer.name}.{passes}", names[kind]).items():
                result.stamp_data_add_field(field, value)


def _fields(name, names):
    prefix = f"cryptomatte/{f'{cryptomatte_id(name).hash:08x}'[:7]}"
    manifest = {each: cryptomatte_id(each).text for each in sorted(names)}
    return {
        f"{prefix}/name": name,
        f"{prefix}/hash": "MurmurHash3_32",
        f"{prefix}/conversion": "uint32_to_float32",
        f"{prefix}/manifest": json.dumps(manifest, ensure_ascii=False),
    }
