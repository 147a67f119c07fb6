"""Settings of scenes, view layers, worlds and lights that affect Cycles' images but not Velour's.

Settings of Cycles are read only while it is enabled. Default values are not noted, since the user did not
choose them.
"""

import bpy

from .denoiser import missing
from .notes import ExportError, listed

_BOUNCES = 1024  # default for the light of a light or a world: no limit
_TRANSPARENT = 8  # default of the scene; Velour has no limit


def note_scene(scene, notes):
    owner = f"Scene '{scene.name}'"
    cycles = getattr(scene, "cycles", None)
    if cycles is None:
        return
    other = [words for words, names in COPIED.items() if _is_not_copied(scene, cycles, *names)]
    if other:
        notes.add(
            f"{owner}: {listed(other)} of Cycles: ignored; use Copy from Cycles in Render > Light Paths."
        )
    asked = [words for words, is_asked in _OF_CYCLES.items() if is_asked(cycles)]
    if scene.render.use_motion_blur and getattr(cycles, "rolling_shutter_type", "NONE") != "NONE":
        asked.append("Rolling Shutter")
    if scene.render.use_simplify:
        asked += [words for words, is_asked in _OF_SIMPLIFY.items() if is_asked(cycles)]
    if asked:
        notes.add(f"{owner}: {listed(asked)} of Cycles: not supported; ignored.")


# Names of the property in Cycles and in Velour.
COPIED = {
    "Clamp Direct": ("sample_clamp_direct", "clamp_direct"),
    "Clamp Indirect": ("sample_clamp_indirect", "clamp_indirect"),
    "Filter Glossy": ("blur_glossy", "filter_glossy"),
    "Reflective Caustics": ("caustics_reflective", "use_reflective_caustics"),
}


def _is_not_copied(scene, cycles, theirs, ours):
    """Whether Cycles' value is neither its default nor Velour's value."""
    value = getattr(cycles, theirs)
    return value not in (getattr(scene.velour, ours), cycles.bl_rna.properties[theirs].default)


_OF_CYCLES = {
    "Open Shading Language": lambda cycles: cycles.shading_system,
    "Fast GI Approximation": lambda cycles: cycles.use_fast_gi,
    "Pixel Filter": lambda cycles: not _is_usual_filter(cycles),
    "Refractive Caustics off": lambda cycles: not cycles.caustics_refractive,
    "Transparent Glass": lambda cycles: cycles.film_transparent_glass,
    "Transparent Max Bounces": lambda cycles: cycles.transparent_max_bounces < _TRANSPARENT,
}
_OF_SIMPLIFY = {
    "Culling": lambda cycles: cycles.use_camera_cull or cycles.use_distance_cull,
    "Texture Limit": lambda cycles: (
        cycles.texture_limit_render != "OFF" or getattr(cycles, "texture_resolution_render", 1.0) != 1.0
    ),
}


def _is_usual_filter(cycles):
    """Whether the filter is the default, or the one-pixel box that Velour uses."""
    kind = cycles.pixel_filter_type
    return kind == "BOX" or (kind == "BLACKMAN_HARRIS" and abs(cycles.filter_width - 1.5) < 1e-6)


def note_layer(layer, notes):
    if not layer.use_solid:
        notes.add(f"View layer '{layer.name}': leaving out surfaces is not supported; ignored.")


def note_emitter(owner, settings, notes):
    """`settings`: Cycles' settings of a light or a world, or None."""
    if getattr(settings, "is_caustics_light", False):
        notes.add(f"{owner}: shadow caustics are not supported; ignored.")
    if getattr(settings, "max_bounces", _BOUNCES) < _BOUNCES:
        notes.add(f"{owner}: its own Max Bounces is not supported; ignored.")


def note_strokes(scene, layer, notes):
    """`scene`: the original or rendered scene; copies that are only inspected have Freestyle off."""
    if bpy.app.build_options.freestyle and scene.render.use_freestyle and layer.use_freestyle:
        notes.add(
            f"View layer '{layer.name}': Blender itself adds Freestyle strokes to the image with EEVEE."
            " Disable Freestyle on machines without OpenGL, where Blender exits."
        )


def note_pencil(obj, layer, notes):
    """`obj`: an evaluated Grease Pencil object."""
    if getattr(layer, "use_grease_pencil", True):  # 5.0 and newer
        notes.add(
            f"Object '{obj.name}': Blender itself draws Grease Pencil over the image, without shadows and"
            " reflections. Hide it on machines without OpenGL, where Blender exits."
        )


def refuse_settings(scene):
    """Raises ExportError for settings with which no final render begins."""
    if scene.render.use_multiview:
        raise ExportError("Stereoscopy is not supported; disable it in Output > Stereoscopy.")
    if scene.velour.use_denoising and (reason := missing()):
        raise ExportError(
            f"Scene '{scene.name}' cannot be denoised: {reason} Or disable Render > Denoise > Render."
        )
