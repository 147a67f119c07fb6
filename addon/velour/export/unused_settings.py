"""Settings of scenes, view layers, worlds and lights that change a picture of Cycles and none of Velour's.

Those of Cycles are read while that is enabled. Values that Blender begins with are no wish of the artist's:
nothing is said of them.
"""

import bpy

from .notes import listed

_BOUNCES = 1024  # of the light of a lamp or a world: no limit


def note_scene(scene, notes):
    owner = f"Scene '{scene.name}'"
    if scene.render.use_motion_blur:
        notes.add(f"{owner}: motion blur is not supported; ignored.")
    cycles = getattr(scene, "cycles", None)
    if cycles is None:
        return
    other = [words for words, names in COPIED.items() if _is_not_copied(scene, cycles, *names)]
    if other:
        notes.add(
            f"{owner}: {listed(other)} of Cycles: not copied to Velour's in Render > Light Paths; ignored."
        )
    asked = [words for words, is_asked in _OF_CYCLES.items() if is_asked(cycles)]
    if scene.render.use_simplify:
        asked += [words for words, is_asked in _OF_SIMPLIFY.items() if is_asked(cycles)]
    if asked:
        notes.add(f"{owner}: {listed(asked)} of Cycles: not supported; ignored.")


# Cycles' name and Velour's.
COPIED = {
    "Clamp Direct": ("sample_clamp_direct", "clamp_direct"),
    "Clamp Indirect": ("sample_clamp_indirect", "clamp_indirect"),
    "Filter Glossy": ("blur_glossy", "filter_glossy"),
    "Reflective Caustics": ("caustics_reflective", "use_reflective_caustics"),
}


def _is_not_copied(scene, cycles, theirs, ours):
    """Where a new scene has Cycles' value, or both have the same, nobody misses it."""
    value = getattr(cycles, theirs)
    return value not in (getattr(scene.velour, ours), cycles.bl_rna.properties[theirs].default)


_OF_CYCLES = {
    "Open Shading Language": lambda cycles: cycles.shading_system,
    "Fast GI Approximation": lambda cycles: cycles.use_fast_gi,
    "Pixel Filter": lambda cycles: not _is_usual_filter(cycles),
}
_OF_SIMPLIFY = {
    "Culling": lambda cycles: cycles.use_camera_cull or cycles.use_distance_cull,
    "Texture Limit": lambda cycles: (
        cycles.texture_limit_render != "OFF" or getattr(cycles, "texture_resolution_render", 1.0) != 1.0
    ),
}


def _is_usual_filter(cycles):
    """That of a new scene, or the box of one pixel that is rendered."""
    kind = cycles.pixel_filter_type
    return kind == "BOX" or (kind == "BLACKMAN_HARRIS" and abs(cycles.filter_width - 1.5) < 1e-6)


def note_layer(layer, notes):
    if not layer.use_solid:
        notes.add(f"View layer '{layer.name}': that surfaces are left out is not supported; ignored.")


def note_emitter(owner, settings, notes):
    """`settings`: those that Cycles keeps with a light or a world; None: there are none."""
    if getattr(settings, "is_caustics_light", False):
        notes.add(f"{owner}: shadow caustics are not supported; ignored.")
    if getattr(settings, "max_bounces", _BOUNCES) < _BOUNCES:
        notes.add(f"{owner}: a limit of its own to bounces is not supported; ignored.")


def note_strokes(scene, layer, notes):
    """Of the .blend's own scene, or of the one that renders: whoever only looks at scenes has them off."""
    if bpy.app.build_options.freestyle and scene.render.use_freestyle and layer.use_freestyle:
        notes.add(
            f"View layer '{layer.name}': Blender itself adds Freestyle's strokes to the picture, by EEVEE;"
            " without OpenGL it ends."
        )


def note_pencil(obj, layer, notes):
    """Of an evaluated Grease Pencil object."""
    if getattr(layer, "use_grease_pencil", True):  # 5.0 and newer
        notes.add(
            f"Object '{obj.name}': Blender itself draws Grease Pencil over the picture, without shadows and"
            " reflections; without OpenGL it ends."
        )
