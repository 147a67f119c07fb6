"""Reads shader nodes as Layers."""

import bpy

from ..color import luminance_weights
from ..plugs import fed_by
from .layer import Factor, Layer, diffuse
from .relief import read_relief

# Velour's parameter: Blender's input, which may be textured.
_PRINCIPLED = {
    "base_color": "Base Color",
    "metallic": "Metallic",
    "roughness": "Roughness",
    "alpha": "Alpha",
}
_USUAL_F0 = 0.04  # reflectance at IOR 1.5
_GRAY = (0.3, 0.6, 0.1)  # luminance weights of Blender before 4.0
# Inputs that Velour does not support; at 0 they have no effect.
_IGNORED = (
    "Subsurface",
    "Subsurface Weight",
    "Anisotropic",
    "Diffuse Roughness",
    "Thin Film Thickness",
    "Thin Wall",
)
# No property reveals it: whether facets or the surface divide light between reflection and refraction.
_GLASS_FRESNEL = "facets" if bpy.app.version >= (3, 6) else "surface"
_REFRACTION_FRESNEL = "facets" if bpy.app.version >= (4, 0) else "surface"
# No property reveals the masking-shadowing function.
SEPARABLE_SHADOWS = bpy.app.version < (3, 5)
# No property reveals it: since 4.5, coats conserve energy and attenuate the base accordingly.
_COAT_LOBE = "whole" if bpy.app.version >= (4, 5) else "single"
# No property reveals it: rough diffuse conserves energy since Principled has a diffuse roughness.
_INTERREFLECTION = bpy.app.version >= (4, 3)
# No property reveals it: a random walk between facets before 4.0, a factor on single scattering since.
_RANDOM_WALK = (
    "its distribution 'Multiscatter GGX' is rendered as in Blender 4, with differences of a few percent."
)
_LINK_ONLY = ("Clearcoat Normal", "Tangent")


def _read_principled(plug, reader):
    values, pictures = {}, {}
    for name, socket in _PRINCIPLED.items():
        values[name], picture = reader.number(plug.input(socket))
        pictures |= {name: picture} if picture else {}
    values["specular"] = _specular(plug, reader)
    values["lobe"] = _lobe(plug, reader)
    values |= _layered(plug, reader) if _is_layered(plug) else _disney(plug, reader, values, pictures)
    values |= _transmission(plug, reader)
    glow = _glow(plug.input("Emission Color", "Emission"), plug.input("Emission Strength"), reader)
    if glow and "coat" in values:
        reader.note(plug, "its coat does not dim its emission.")
    _note_ignored(plug, reader)
    return [Layer("principled", values, pictures, relief=read_relief(plug, reader), glow=glow)]


def _transmission(plug, reader):
    """Glass of a Principled BSDF, and whether its index is below 1, if they have an effect."""
    share = min(max(reader.value(plug.input("Transmission Weight", "Transmission")), 0.0), 1.0)
    if share <= 0.0 and not _is_layered(plug):
        return {}
    index = max(reader.value(plug.input("IOR")), 1e-5)
    if share <= 0.0:
        return {"index": index} if index < 1.0 else {}
    added = plug.input("Transmission Roughness")
    values = {"transmission_roughness": reader.value(added)} if added else {}
    return {"transmission": share, "index": index, **values}


def _is_layered(plug):
    """Whether it is the Principled BSDF of Blender 4.0 and newer."""
    return plug.input("Coat Weight") is not None


def _disney(plug, reader, values, pictures):
    """Parameters specific to Principled before 4.0, if they have an effect. Its tints are the shares of the
    base color's hue in the dielectric reflection and in sheen [Bur12]."""
    found = {"formula": "disney"}
    coat = min(reader.value(plug.input("Clearcoat")), 1.0)
    if coat > 0.0:
        found |= {"coat": coat, "coat_roughness": reader.value(plug.input("Clearcoat Roughness"))}
    sheen = reader.value(plug.input("Sheen"))
    if sheen > 0.0:
        found |= {"sheen": sheen}
        found |= _hue(plug, reader, "Sheen Tint", "sheen_tint", values, pictures, luminance_weights())
    return found | _hue(plug, reader, "Specular Tint", "specular_tint", values, pictures, _GRAY)


def _hue(plug, reader, name, key, values, pictures, weights):
    """A tint that has a share of the base color's hue, by the parameter's name; nothing if it is white."""
    share = min(max(reader.value(plug.input(name)), 0.0), 1.0)
    gray = sum(float(w) * c for w, c in zip(weights, values["base_color"], strict=True))
    if share == 0.0 or gray <= 0.0:
        return {}
    if "base_color" in pictures:
        reader.note(plug, f"'{name}' is not supported with a varying base color; ignored.")
        return {}
    return {key: tuple(1.0 - share + share * c / gray for c in values["base_color"])}


def _layered(plug, reader):
    """Parameters specific to the Principled BSDF of 4.0 and newer, if they have an effect."""
    values = {"formula": "layered"}
    tint = reader.value(plug.input("Specular Tint"))
    if min(tint) != 1.0 or max(tint) != 1.0:
        values["specular_tint"] = tint
    coat = min(reader.value(plug.input("Coat Weight")), 1.0)
    if coat > 0.0:
        values["coat"] = coat
        values["coat_roughness"] = reader.value(plug.input("Coat Roughness"))
        values["coat_index"] = max(reader.value(plug.input("Coat IOR")), 1.0)
        values["coat_tint"] = reader.value(plug.input("Coat Tint"))
        values["coat_lobe"] = _COAT_LOBE
        note_linked(plug, reader, "Coat Normal")
    sheen = reader.value(plug.input("Sheen Weight"))
    if sheen > 0.0:
        values["sheen"] = sheen
        values["sheen_roughness"] = reader.value(plug.input("Sheen Roughness"))
        values["sheen_tint"] = reader.value(plug.input("Sheen Tint"))
    return values


def _lobe(plug, reader):
    """GGX masking and multiple scattering of a Principled or Glossy BSDF; notes other distributions."""
    distribution = plug.node.distribution
    if distribution == "MULTI_GGX":
        if bpy.app.version < (4, 0):
            reader.note(plug, _RANDOM_WALK)
        return "whole"
    if distribution not in ("GGX", "SHARP"):
        reader.note(
            plug, f"its distribution '{_label(plug.node, 'distribution')}' is not supported; rendered as GGX."
        )
    return "separable" if SEPARABLE_SHADOWS else "single"


def _specular(plug, reader):
    """Specular level, where 0.5 means IOR 1.5, as in Blender: it scales the IOR's reflectance at normal
    incidence. Before 4.0 that reflectance is fixed at 4%, and IOR applies to transmission only."""
    level = reader.value(plug.input("Specular IOR Level", "Specular"))
    if not plug.input("Specular IOR Level"):
        return level
    index = max(reader.value(plug.input("IOR")), 1e-5)
    return level * ((index - 1.0) / (index + 1.0)) ** 2 / _USUAL_F0


def _read_diffuse(plug, reader):
    color, picture = reader.number(plug.input("Color"))
    roughness, rough = reader.number(plug.input("Roughness"))
    relief = read_relief(plug, reader)
    pictures = {"base_color": picture} if picture else {}
    if rough is None and roughness <= 0.0 and relief is None:
        return [diffuse(color)._replace(pictures=pictures)]
    pictures |= {"roughness": rough} if rough else {}
    values = {"base_color": color, "roughness": roughness, "interreflection": _INTERREFLECTION}
    return [Layer("diffuse", values, pictures, relief=relief)]


def _read_glossy(plug, reader):
    color, picture = reader.number(plug.input("Color"))
    roughness, rough = reader.number(plug.input("Roughness"))
    if plug.node.distribution == "SHARP":
        roughness, rough = 0.0, None
    _note_anisotropy(plug, reader)
    note_linked(plug, reader, "Tangent")
    found = {"base_color": picture, "roughness": rough}
    values = {"base_color": color, "roughness": roughness, "lobe": _lobe(plug, reader)}
    pictures = {name: p for name, p in found.items() if p}
    return [Layer("glossy", values, pictures, relief=read_relief(plug, reader))]


def _read_glass(plug, reader):
    return _glass("glass", _GLASS_FRESNEL, plug, reader)


def _read_refraction(plug, reader):
    return _glass("refraction", _REFRACTION_FRESNEL, plug, reader)


def _glass(kind, fresnel, plug, reader):
    color, picture = reader.number(plug.input("Color"))
    roughness, rough = reader.number(plug.input("Roughness"))
    if plug.node.distribution == "SHARP":
        roughness, rough = 0.0, None
    index = max(reader.value(plug.input("IOR")), 1e-5)
    values = {"base_color": color, "roughness": roughness, "index": index, "glass_fresnel": fresnel}
    if rough is not None or roughness > 0.0:
        values["lobe"] = _lobe(plug, reader)
        # Light between facets is closest to what conserves energy, whose facets have their own angles.
        values |= {"glass_fresnel": "facets"} if values["lobe"] == "whole" else {}
    _note_unused(plug, reader, "Thin Film Thickness")
    found = {"base_color": picture, "roughness": rough}
    pictures = {name: p for name, p in found.items() if p}
    return [Layer(kind, values, pictures, relief=read_relief(plug, reader))]


def _read_translucent(plug, reader):
    color, picture = reader.number(plug.input("Color"))
    pictures = {"base_color": picture} if picture else {}
    return [Layer("translucent", {"base_color": color}, pictures, relief=read_relief(plug, reader))]


def _label(node, name):
    """Name of an enum property's value in Blender's UI."""
    return node.bl_rna.properties[name].enum_items[getattr(node, name)].name


def _note_anisotropy(plug, reader):
    amount = plug.input("Anisotropy")  # 4.0 and newer; a separate node before
    if amount and (fed_by(amount) or abs(amount.socket.default_value) > 1e-6):
        reader.note(plug, "'Anisotropy' is not supported; ignored.")


def _read_emission(plug, reader):
    glow = _glow(plug.input("Color"), plug.input("Strength"), reader)
    return [glow or Layer("emission", {"base_color": (0.0, 0.0, 0.0)}, {})]


def _glow(color, strength, reader):
    """An emission Layer; None if it emits nothing."""
    color, picture = reader.number(color)
    strength, gain = reader.number(strength)
    if picture is None and gain is None:
        radiance = tuple(strength * c for c in color)
        return Layer("emission", {"base_color": radiance}, {}) if max(radiance) > 0.0 else None
    pictures = {"base_color": picture} if picture else {}
    return Layer("emission", {"base_color": color}, pictures, (Factor("gain", strength, gain),))


def _read_transparent(plug, reader):
    color, picture = reader.number(plug.input("Color"))
    return [Layer("transparent", {"base_color": color}, {"base_color": picture} if picture else {})]


READERS = {
    "ShaderNodeBsdfPrincipled": _read_principled,
    "ShaderNodeBsdfDiffuse": _read_diffuse,
    "ShaderNodeBsdfGlossy": _read_glossy,
    "ShaderNodeBsdfAnisotropic": _read_glossy,  # from 4.0 on, Glossy BSDF in the Add menu
    "ShaderNodeBsdfGlass": _read_glass,
    "ShaderNodeBsdfRefraction": _read_refraction,
    "ShaderNodeBsdfTranslucent": _read_translucent,
    "ShaderNodeEmission": _read_emission,
    "ShaderNodeBsdfTransparent": _read_transparent,
}


def note_linked(plug, reader, name):
    """Notes an unsupported link to an input."""
    if fed_by(plug.input(name)):
        reader.note(plug, f"'{name}' is not supported; ignored.")


def _note_ignored(plug, reader):
    for name in _IGNORED:
        _note_unused(plug, reader, name)
    for name in _LINK_ONLY:
        note_linked(plug, reader, name)


def _note_unused(plug, reader, name):
    """Notes an unsupported input that has an effect."""
    socket = plug.input(name)
    if socket and (abs(socket.socket.default_value) > 1e-6 or fed_by(socket)):
        reader.note(plug, f"'{name}' is not supported; ignored.")
