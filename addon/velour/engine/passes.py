"""From the film's passes to Blender's render result."""

import json

import numpy as np

from ..export.layer_passes import COMBINED, CRYPTOMATTES, layer_passes
from ..native import cryptomatte_id

_OF_LIGHT = ("Combined", "Error")


def register_passes(engine, scene, layer):
    """Tells the compositor which sockets to show."""
    for each in layer_passes(layer):
        engine.register_pass(scene, layer, each.name, each.channels, each.letters, each.kind)


def add_passes(engine, layer, shown):
    """Before begin_result: what Blender does not make by itself; it leaves out what is there."""
    for each in shown:
        if each is not COMBINED:
            engine.add_pass(each.name, each.channels, each.letters, layer=layer.name)


def write_passes(job, result, exposure, shown):
    """Copies the film into `result`, as far as both have the LayerPasses `shown`.

    `exposure`: what light is multiplied by.
    """
    by_name = {each.name: each for each in shown}
    for target in result.layers[0].passes:
        found = by_name.get(target.name)
        if found:
            _fill(target.rect, _pixels(job, found, exposure))


def _pixels(job, found, exposure):
    """[pixels x channels]"""
    if found.source is None:
        width, height = job.size
        return np.zeros((width * height, found.channels), np.float32)
    pixels = job.read_pass(found.source).reshape(-1, found.channels)
    if found.name in _OF_LIGHT:
        pixels[:, :3] *= exposure
    return pixels


def _fill(rect, pixels):
    """Blender 3.4 to 4.x take [pixels x channels], 5.x the same values flat; neither takes the other."""
    try:
        rect.foreach_set(pixels)
    except TypeError:
        rect.foreach_set(pixels.reshape(-1))


def stamp_cryptomattes(result, layer, names):
    """Metadata by which compositors find the names of ids (Cryptomatte specification); by kind `names`."""
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
