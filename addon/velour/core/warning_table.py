"""The sentences of the library's warnings, for panels, the command line and reports.

The library reports a warning as a code and named values (native/src/base/warning.h).
"""

from __future__ import annotations

import math
import string

from .sizes import data_size

# Names of settings, in capitals in the sentences.
PANEL = {
    "LIMIT_ALBEDO": "Limit Albedo",
    "MAX_ERROR": "Max Error",
    "MAX_LOBES": "Max Lobes",
    "MAX_SIZE": "Max Size",
    "MEASUREMENT_RENDER": "Render from Measurement",
    "METHOD": "Method",
    "MODEL": "Model",
    "RECIPROCAL": "Reciprocal",
    "SIZE_PLOT": "the Size plot",
    "TEXELS": "Texels",
}
COMMAND_LINE = {
    "LIMIT_ALBEDO": "--limit-albedo",
    "MAX_ERROR": "--tolerance",
    "MAX_LOBES": "--max-lobes",
    "MAX_SIZE": "--bytes",
    "MEASUREMENT_RENDER": "a render of the measurement",
    "METHOD": "--method",
    "MODEL": "--model",
    "RECIPROCAL": "--symmetric",
    "SIZE_PLOT": "velour plot --kind order",
    "TEXELS": "--texels",
}

_NOT_MET = "The model exceeds {MAX_ERROR} ({tolerance}): its error is {error} at {bytes:size}"
_IGNORED = "Blender ignores this, and so does Velour in Blender. Save the image as it should look."
_ORIENTATIONS = (  # by EXIF tag 274
    "unknown|upright|mirrored|rotated by 180 degrees|flipped vertically|transposed|rotated by 90 degrees"
    "|mirrored and rotated by 90 degrees|rotated by 270 degrees"
)

# By code. What follows a colon says how a value is written: a key of _FORMS, or the words it chooses from.
SENTENCES = {
    # Measurements
    "invalid_entries": (
        "{invalid} of {entries} values of the measurement are invalid and were left out: the model is a guess"
        " there, and errors are measured on the others. If it looks wrong, use a more complete measurement."
    ),
    "spikes_left_out": (
        "{spikes} of {samples} samples are far brighter than those about them and were left out: stray light,"
        " or faults of the detector."
    ),
    "few_samples": (
        "The measurement has only {samples} samples: between them, the model is a guess. Errors are measured"
        " on {judged} {held_out:fitted|held-out} samples. Check the model with {MEASUREMENT_RENDER}, or use a"
        " denser measurement."
    ),
    "anisotropic_samples": (
        "The surface is anisotropic, like brushed metal: {pairs} pairs of samples that differ only in azimuth"
        " differ by a factor of {factor} (median), pairs with the same azimuth by {same_azimuth_factor}. The"
        " model is isotropic, a mean over azimuths. Use a tabulated measurement with azimuths for an"
        " anisotropic model."
    ),
    "noise_exceeds_tolerance": (
        "The noise of the measurement exceeds {MAX_ERROR} at {count} of the reported views: at"
        " {worst:degrees}, values that should be equal differ by {difference}. A smaller error is"
        " meaningless there; a larger {MAX_ERROR} gives a smaller model of the same quality."
    ),
    "narrow_highlight": (
        "The highlight at {views:degrees} is so sharp that the usual directions capture as little as"
        " {share:percent} of its energy. Its error was measured with closer directions; no action is needed."
    ),
    "partial_coverage": (
        "At view angles of {views:degrees} the measurement covers as little as {share:percent} of the light"
        " directions. Errors are measured on these; for the others, the model is a guess. Check it with"
        " {MEASUREMENT_RENDER}."
    ),
    "no_view_covered": (
        "The error of the model is not known and reported as 1: the measurement covers none of the views at"
        " which errors are reported. Check the model with {MEASUREMENT_RENDER}."
    ),
    "black_measurement": "The measurement is black at every view. Check that it is the right file.",
    "dark_measurement": (
        "The material reflects at most {albedo:percent} of the light at any view, less than soot. Check that"
        " it is the right file and has the right scale."
    ),
    "measurement_not_reciprocal": (
        "The measurement changes by {change:percent} when light and camera are exchanged, which no real"
        " surface does, and so does the model. Renders with Velour are correct regardless. For other"
        " programs, enable {RECIPROCAL} and fit again."
    ),
    "implausible_albedo": (
        "The measurement reflects {albedo} times the light it receives at {view:degrees}{azimuth:azimuths},"
        " far more than measurement errors explain. Check that it is the right file and has the right scale."
    ),
    "measured_albedo_above_one": (
        "The measurement reflects up to {albedo} times the light it receives, at"
        " {view:degrees}{azimuth:azimuths}. Enable {LIMIT_ALBEDO} and fit again, or lower the exposure."
    ),
    "views_left_out": (
        "{uncovered} of {sampled} view angles are outside the measurement and were left out, so the model is"
        " a guess there. Use a more complete measurement, or avoid these angles."
    ),
    "out_of_gamut": (
        "{outside} of {values} colors of the measurement are too saturated for the color space (Rec. 709)."
        " The model uses the nearest colors, which alone causes an error of up to {error}; no action is"
        " needed."
    ),
    "repeated_directions": (
        "{views} views and {lights} lights of the BTF repeat an earlier direction under other angles (phi 0"
        " and 360, or any phi at theta 0). Interpolation uses only the earlier ones. Remove the others from"
        " the set if they differ."
    ),
    "images_outside_folder": (
        "{index}: {outside} of {images} images are outside the folder of the index; the first is {first}."
        " Check that these are the intended files."
    ),
    "images_channels_ignored": (
        "{images} of {all} images of the BTF have further channels, which are ignored. The first is {first}:"
        " only the image{layer:layer} is used, not {channels:some}. If the colors are in another layer,"
        " choose that layer."
    ),
    "images_parts_ignored": (
        "{images} of {all} images of the BTF have several parts, of which one is used. The first is {first}:"
        " part{part:name} of {parts} is used. If the colors are in another part, choose it as the layer."
    ),
    "images_channel_missing": (
        "{images} of {all} images of the BTF lack one of the channels R, G and B, which is treated as 0. The"
        " first is {first}. Save the images with all three channels, or choose another layer."
    ),
    "images_color_space_ignored": (
        "{images} of {all} images of the BTF have a color profile other than sRGB, which is not applied. The"
        " first is {first}, with the profile {space}. Convert the images to sRGB for the right colors."
    ),
    "values_not_finite": (
        "{values} values of the BTF are not finite and were replaced by the mean of their image. If spots are"
        " visible, capture it again."
    ),
    # Fits and models
    "views_exceed_tolerance": (
        "The model exceeds {MAX_ERROR} ({tolerance}, twice that beyond 75\N{DEGREE SIGN}) at {views:degrees}:"
        " its errors there are {errors}. Fit again with another {MODEL}, or raise {MAX_LOBES} if the model"
        " has that many; {SIZE_PLOT} shows the errors of all sizes that were tried."
    ),
    "views_not_covered": (
        "The measurement has no view at {views:degrees}, so the model is a guess there. Use a more complete"
        " measurement, or avoid these angles."
    ),
    "fitted_views_exceed_tolerance": (
        "{missed} of {fitted} fitted views exceed {MAX_ERROR} ({tolerance}) with at most {lobes} lobes, the"
        " first at {views:degrees}{azimuths:azimuths}. The worst, at {worst:degrees}{worst_azimuth:azimuths},"
        " has an error of {error}. Fit again with another {MODEL}, or raise {MAX_LOBES} if the model has that"
        " many."
    ),
    "black_model": (
        "The model is black: the measurement is darker than any value that can be fitted. Check that it is"
        " the right file and has the right scale."
    ),
    "model_not_reciprocal": (
        "The model changes by {change:percent} when light and camera are exchanged. Renders with Velour are"
        " correct regardless. For other programs, enable {RECIPROCAL} and fit again."
    ),
    "model_albedo_above_one": (
        "The model reflects up to {albedo} times the light it receives, at {view:degrees}{azimuth:azimuths},"
        " the measurement only {measured} times. Raise {MAX_LOBES} or enable {LIMIT_ALBEDO}, and fit again."
    ),
    "model_bounded": (
        "The model was reduced to {bytes:size}, which makes it coarser: {views} views and {lobes} lobes"
        " remain. Raise {MAX_SIZE} for a better model."
    ),
    "roughened": (
        "The model was made rougher by {roughness}. Its errors are those of the original model; no action is"
        " needed."
    ),
    "tolerance_needs_bytes": _NOT_MET + ". Raise {MAX_SIZE} to about {enough:size}.",
    "tolerance_needs_more_bytes": _NOT_MET
    + (
        ", and more than {largest:size} would be needed. Raise {MAX_ERROR} to {reachable}, or try another"
        " {METHOD}."
    ),
    "tolerance_out_of_reach": _NOT_MET
    + (
        ", and no larger model of this method is known to be better. Raise {MAX_ERROR} to {reachable}, or try"
        " another {METHOD}."
    ),
    "memory_limits_fit": (
        "There was not enough memory for the best model: lobes were chosen by {points} points instead of"
        " {usual}. {memory:memory} would suffice. Use fewer {TEXELS} or allow more memory, and fit again."
    ),
    "fit_not_resumed": "The fit was not resumed but started from the beginning: {reason}",
    "checkpoint_not_written": (
        "The checkpoint could not be written, so the fit cannot be resumed if it is interrupted: {reason}"
    ),
    "scene_needs_full_model": (
        "This scene needs the full model: no smaller model gives images of the same quality. The full model"
        " is rendered; no action is needed."
    ),
    "scene_shows_finest_texels": (
        "This scene shows the finest detail of the material, so it needs the full model. From farther away,"
        " or in a smaller image, a smaller model would suffice."
    ),
    "only_finest_levels_left_out": (
        "Only detail that is too fine for this scene was left out. For a smaller scene model, fit the BTF"
        " with {METHOD} SRBF or SVD, which are also fitted to the views of the scene."
    ),
    # Captures
    "tile_seam": (
        "The tile does not repeat seamlessly along {axis}: its surface jumps by more than {jump:percent} of"
        " its thickness across {share:percent} of its border (root mean square {rms}, thickness {thickness}),"
        " but across {inside:percent} or less of lines inside. The seam will be visible. Set the period, or"
        " make the borders match."
    ),
    "tile_emits_light": (
        "A material of the tile emits light. Its emission is not captured, because a BTF contains only"
        " reflected light."
    ),
    "tile_is_transparent": (
        "A material of the tile is transparent (alpha). The silhouette (VOTF) treats its surface as opaque."
    ),
    "sheets_thickened": (
        "{lines} of {sampled} vertical lines meet a sheet without thickness, which was made about one texel"
        " thick. Add a Solidify modifier, or raise {TEXELS}."
    ),
    "silhouette_differs": (
        "{wrong:percent} of what is seen of the silhouette (VOTF) differs from the tile, mostly because some"
        " faces have normals that point inwards. Recalculate the normals of the tile's meshes (Mesh > Normals"
        " > Recalculate Outside)."
    ),
    "rays_lost": "{rays} rays never left the structure of the tile and were counted as misses.",
    "path_values_not_finite": (
        "{values} path values were not finite and were counted as 0. Check the materials of the tile for"
        " invalid values."
    ),
    # Scenes
    "triangles_left_out": (
        "Mesh {mesh}: {triangles} triangles without area or with coordinates that are not finite were left"
        " out."
    ),
    "flat_instances_left_out": "{instances} instances have a scale of 0 and were left out.",
    "silhouettes_without_uvs": (
        "{instances} instances have a material with a silhouette (VOTF), but no texture coordinates that"
        " cover their surface; they were rendered without the silhouette. Unwrap their meshes."
    ),
    "silhouette_folds": (
        "The silhouette (VOTF) of material {material} reaches from {bottom:meters} to {top:meters} above the"
        " surface and folds over itself on {triangles} of {sampled} triangles, where the surface has radii of"
        " curvature down to {radius:meters}. Make its tiles smaller (they are {tile:meters} wide)."
    ),
    "no_light": (
        "The scene has no light, so its image is black. Add a light, an emissive mesh or an environment."
    ),
    "faces_without_normals": "{file}: {faces} of {all} faces have no normals and are shaded flat.",
    "faces_without_uvs": "{file}: {faces} of {all} faces have no texture coordinates; (0, 0) is used.",
    "faces_left_out": "{file}: {faces} faces have fewer than 3 corners and were left out.",
    # Images
    "channels_ignored": (
        "{file}: only the image{layer:layer} is used; other channels are ignored: {channels:some}."
    ),
    "parts_ignored": "{file}: part{part:name} of {parts} is used; the other parts are ignored.",
    "channel_missing": "{file}: one of the channels R, G and B is missing and is treated as 0.",
    "xyz_as_rgb": (
        "{file}: its channels X, Y and Z are used as red, green and blue. If they are CIE XYZ, save the image"
        " as RGB or with its chromaticities."
    ),
    "orientation_ignored": (
        f"{{file}}: according to its header, the image is stored {{orientation:{_ORIENTATIONS}}}. {_IGNORED}"
    ),
    "exposure_ignored": (
        f"{{file}}: according to its header, its values must be divided by an exposure. {_IGNORED}"
    ),
    "primaries_ignored": f"{{file}}: according to its header, its colors are not in Rec. 709. {_IGNORED}",
    "color_space_ignored": (
        "{file}: its color profile {space} is not applied; its values are treated as sRGB. Convert the image"
        " to sRGB for the right colors."
    ),
    "window_ignored": (
        "{file}: according to its header, it is a part of an image of {width} x {height} pixels."
        f" {_IGNORED}"
    ),
    "infinite_values": "{file:subject}: {values} values are infinite and were replaced by {replacement}.",
    "nan_values": "{file:subject}: {values} values are not numbers (NaN) and were replaced by 0.",
    "negative_values": "{file:subject}: {values} values are negative and were replaced by 0.",
    # Model files of other versions
    "stored_sentence": "{text}",
    "unknown_warning": (
        "The model has a warning of a later version of Velour ('{code}'). Update Velour to read it."
    ),
}


def sentence(warning: dict, settings: dict = PANEL, metres: float = 1.0) -> str:
    """`warning`: {code, values} as from the library; `settings`: names of settings, PANEL or COMMAND_LINE;
    `metres`: meters per unit of its lengths."""
    try:
        return _Words(settings, metres).format(SENTENCES[warning["code"]], **warning["values"])
    except (KeyError, TypeError, ValueError, IndexError):  # of a damaged model file
        listed = ", ".join(f"{name}: {value}" for name, value in warning["values"].items())
        return f"{warning['code']} ({listed})"


def sentences(warnings: list[dict], settings: dict = PANEL, metres: float = 1.0) -> list[str]:
    """`warnings`: "warning_codes" of a report or info of the library."""
    return [sentence(warning, settings, metres) for warning in warnings]


class _Words(string.Formatter):
    """Writes values in the forms of the sentences; names in capitals are settings."""

    def __init__(self, settings: dict, metres: float):
        self._settings, self._metres = settings, metres

    def get_value(self, key, args, kwargs):
        return self._settings[key] if isinstance(key, str) and key.isupper() else kwargs[key]

    def format_field(self, value, format_spec):
        if "|" in format_spec:
            return format_spec.split("|")[value]
        return _FORMS[format_spec](self._metres * value if format_spec == "meters" else value)


def _number(value) -> str:
    if isinstance(value, list):
        return _listed([_number(v) for v in value])
    return f"{value:.6g}" if isinstance(value, float) else str(value)


def _listed(words: list[str]) -> str:
    return ", ".join(words)


def _degrees(value) -> str:
    angles = value if isinstance(value, list) else [value]
    return _listed([f"{round(angle, 1):g}\N{DEGREE SIGN}" for angle in angles])


def _some(names: list[str]) -> str:
    most = 6
    return _listed(names) if len(names) <= most else f"{_listed(names[:most])} and {len(names) - most} more"


_FORMS = {
    "": _number,
    "azimuths": lambda angles: f" (azimuth {_degrees(angles)})" if angles else "",
    "degrees": _degrees,
    "layer": lambda name: f" of layer '{name}'" if name else "",
    "memory": lambda size: f"{math.ceil(size / 1e6)} MB",  # rounded up: as much must suffice
    "meters": lambda length: f"{length:.3g} m",
    "name": lambda name: f" '{name}'" if name else "",
    "percent": lambda share: f"{100 * share:.3g}%",
    "size": data_size,
    "some": _some,
    "subject": lambda file: file or "The environment image",
}
