"""Passes enabled in a view layer, named as in Cycles."""

from typing import NamedTuple

import bpy

from .motion import shutter_is_open
from .notes import listed


class LayerPass(NamedTuple):
    name: str
    letters: str  # one per channel
    kind: str  # type of the compositor's socket
    source: str | None  # the library's pass; None: all zero, as Vector of a blurred image in Cycles
    asks: str | None = None  # key in table.PASSES; None: every film has it

    @property
    def channels(self):
        return len(self.letters)


# Blender 5.0 spells these names out, and no property reveals them.
_INDEX_NAMES = ("IndexOB", "IndexMA") if bpy.app.version < (5, 0) else ("Object Index", "Material Index")
_OBJECT_INDEX = LayerPass(_INDEX_NAMES[0], "X", "VALUE", "IndexOB", "object_index")
_MATERIAL_INDEX = LayerPass(_INDEX_NAMES[1], "X", "VALUE", "IndexMA", "material_index")

# Switches of a view layer, and the passes that each enables.
_SWITCHES = (
    ("use_pass_z", (LayerPass("Depth", "Z", "VALUE", "Depth"),)),
    ("use_pass_mist", (LayerPass("Mist", "Z", "VALUE", "Mist", "mist"),)),
    ("use_pass_position", (LayerPass("Position", "XYZ", "VECTOR", "Position", "position"),)),
    ("use_pass_normal", (LayerPass("Normal", "XYZ", "VECTOR", "Normal"),)),
    ("use_pass_vector", (LayerPass("Vector", "XYZW", "VECTOR", "Vector", "vector"),)),
    ("use_pass_uv", (LayerPass("UV", "UVA", "VECTOR", "UV", "uv"),)),
    ("use_pass_object_index", (_OBJECT_INDEX,)),
    ("use_pass_material_index", (_MATERIAL_INDEX,)),
)
_OWN_SWITCHES = (  # in Velour's settings
    ("use_pass_albedo", (LayerPass("Albedo", "RGB", "COLOR", "Albedo", "albedo"),)),
    (
        "use_pass_denoising",
        (
            LayerPass("Denoising Normal", "XYZ", "VECTOR", "Normal"),
            LayerPass("Denoising Albedo", "RGB", "COLOR", "Denoising Albedo", "denoising_albedo"),
        ),
    ),
    ("use_pass_error", (LayerPass("Error", "RGB", "COLOR", "Error", "error"),)),
    ("use_pass_sample_count", (LayerPass("Sample Count", "X", "VALUE", "Sample Count"),)),
)
_ALPHA_THRESHOLD = 0.5  # default of a view layer
_SWITCHED_APART = {  # separate switches in Cycles and in Velour
    "Denoising": ("denoising_store_passes", "use_pass_denoising"),
    "Sample Count": ("pass_debug_sample_count", "use_pass_sample_count"),
}
CRYPTOMATTES = {"object": "CryptoObject", "material": "CryptoMaterial", "asset": "CryptoAsset"}
# Ids are not colors. Lowercase channel names keep Blender from storing half floats and DWA from rounding.
_IDS = "rgba"

COMBINED = LayerPass("Combined", "RGBA", "COLOR", "Combined")
_DENOISED = LayerPass("Combined", "RGBA", "COLOR", "Denoised", "halves")
_NOISY = LayerPass("Noisy Image", "RGBA", "COLOR", "Combined")


def layer_passes(scene, layer):
    """The LayerPasses of a scene's view layer."""
    further = _further_passes(layer)
    if shutter_is_open(scene, layer):
        further = [_still(each) for each in further]
    return [*([_DENOISED, _NOISY] if scene.velour.use_denoising else [COMBINED]), *further]


def _still(each):
    return each._replace(source=None, asks=None) if each.asks == "vector" else each


def _further_passes(layer):
    found = []
    for owner, switches in ((layer, _SWITCHES), (layer.velour, _OWN_SWITCHES)):
        found += [each for switch, passes in switches if getattr(owner, switch) for each in passes]
    for kind, name in CRYPTOMATTES.items():
        if getattr(layer, f"use_pass_cryptomatte_{kind}"):
            names = (f"{name}{level:02d}" for level in range((layer.pass_cryptomatte_depth + 1) // 2))
            found += [LayerPass(each, _IDS, "COLOR", each, f"crypto_{kind}") for each in names]
    return found


def as_rendered(shown):
    """The LayerPasses of a partial image, which is not denoised."""
    return [COMBINED if each is _DENOISED else each for each in shown]


def note_missing_passes(layer, notes):
    """Notes the enabled passes that Velour does not support."""
    known = {switch for switch, _ in _SWITCHES} | {f"use_pass_cryptomatte_{kind}" for kind in CRYPTOMATTES}
    known |= {"use_pass_combined", "use_pass_cryptomatte_accurate"}
    known.add("use_pass_grease_pencil")  # 5.0 and newer: rendered by Blender
    owner = f"View layer '{layer.name}'"
    cycles = getattr(layer, "cycles", None)
    for name in (*_asked_passes(layer, known), *_asked_passes(cycles)):
        notes.add(f"{owner}: the pass {name} is not supported; left out.")
    for name, (theirs, own) in _SWITCHED_APART.items():
        if getattr(cycles, theirs, False) and not getattr(layer.velour, own):
            notes.add(f"{owner}: {name} is enabled for Cycles only; left out. Enable it in Passes > Data.")
    if abs(layer.pass_alpha_threshold - _ALPHA_THRESHOLD) > 1e-6:
        notes.add(f"{owner}: the Alpha Threshold of passes is not supported; ignored.")
    if layer.aovs:
        notes.add(f"{owner}: shader AOVs are not supported; left out.")
    if layer.lightgroups:
        names = listed([f"'{group.name}'" for group in layer.lightgroups])
        notes.add(f"{owner}: light groups are not supported; the passes of {names} are left out.")


def _asked_passes(owner, known=()):
    """Names of the enabled passes except `known` switches; none if `owner` is None."""
    for each in owner.bl_rna.properties if owner else ():
        is_pass = each.identifier.startswith("use_pass_") and each.identifier not in known
        if is_pass and getattr(owner, each.identifier):
            yield each.name


def shows_more_than_light(layer):
    """Whether it has passes that need no light. Depth does not count, since nearly every layer has it."""
    return any(each.name != "Depth" for each in _further_passes(layer))
