"""Reads shader nodes as Layers."""

import math

import bpy

from ..color import luminance_weights
from ..newer import UNKNOWN
from ..plugs import fed_by
from .layer import BLACK, Factor, Layer, diffuse
from .relief import read_coat_relief, read_relief
from .values import own_value

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


class _Principled:
    """Values and pictures of a Principled BSDF's inputs, by the parameters of Shader.add_layer."""

    def __init__(self, plug, reader):
        self.plug, self.reader = plug, reader
        self.values, self.pictures = {}, {}

    def read(self, name, *sockets, largest=math.inf, least=-math.inf):
        """Reads the first of `sockets` that exists, within bounds."""
        value, picture = self.reader.number(self.plug.input(*sockets))
        if not isinstance(value, tuple):
            value = min(max(value, least), largest)
        self.values[name] = value
        self.pictures |= {name: picture} if picture else {}

    def has(self, name):
        """Whether a weight that was read is above 0 somewhere."""
        return name in self.pictures or self.values[name] > 0.0

    def drop(self, name):
        self.values.pop(name)
        self.pictures.pop(name, None)


def _read_principled(plug, reader):
    found = _Principled(plug, reader)
    for name, socket in _PRINCIPLED.items():
        found.read(name, socket)
    _read_specular(found)
    found.values["lobe"] = _lobe(plug, reader)
    if _is_layered(plug):
        _read_layered(found)
    else:
        _read_disney(found)
    _read_transmission(found)
    glow = _glow(plug.input("Emission Color", "Emission"), plug.input("Emission Strength"), reader)
    dimming = [name for name in ("coat", "sheen") if glow and _is_layered(plug) and name in found.values]
    for name in dimming:
        reader.note(plug, f"its {name} does not dim its emission.")
    _note_ignored(plug, reader)
    layer = Layer("principled", found.values, found.pictures, relief=read_relief(plug, reader), glow=glow)
    if "coat" in found.values:
        layer = layer._replace(coat_relief=read_coat_relief(plug, reader))
    return [layer]


def _read_transmission(found):
    """Glass of a Principled BSDF, and whether its index is below 1, if they have an effect."""
    plug = found.plug
    found.read("transmission", "Transmission Weight", "Transmission", least=0.0, largest=1.0)
    has_glass = found.has("transmission")
    if not has_glass:
        found.drop("transmission")
    if "index" not in found.values and (has_glass or _is_layered(plug)):
        _read_index(found)
        if not has_glass and found.values["index"] >= 1.0:
            found.drop("index")
    if has_glass and plug.input("Transmission Roughness"):
        found.read("transmission_roughness", "Transmission Roughness")


def _read_index(found):
    found.read("index", "IOR", least=1e-5)


def _is_layered(plug):
    """Whether it is the Principled BSDF of Blender 4.0 and newer."""
    return plug.input("Coat Weight") is not None


def _read_disney(found):
    """Parameters specific to Principled before 4.0, if they have an effect. Its tints are the shares of the
    base color's hue in the dielectric reflection and in sheen [Bur12]."""
    found.values["formula"] = "disney"
    _note_beyond_range(found, "metallic", "Metallic")
    _note_beyond_range(found, "roughness", "Roughness")
    found.read("coat", "Clearcoat")
    _note_beyond_range(found, "coat", "Clearcoat")
    if found.has("coat"):
        found.read("coat_roughness", "Clearcoat Roughness")
    else:
        found.drop("coat")
    found.read("sheen", "Sheen")
    if found.has("sheen"):
        _read_hue(found, "Sheen Tint", "sheen_tint", luminance_weights())
    else:
        found.drop("sheen")
    _read_hue(found, "Specular Tint", "specular_tint", _GRAY)


def _note_beyond_range(found, name, socket):
    """Notes a constant that Cycles does not clamp, and clamps it."""
    value = found.values[name]
    if name not in found.pictures and not 0.0 <= value <= 1.0:
        found.values[name] = min(max(value, 0.0), 1.0)
        found.reader.note(found.plug, f"'{socket}' is {value:g}; {found.values[name]:g} is used instead.")


def _read_hue(found, socket, name, weights):
    """A tint that has a share of the base color's hue; none if it is white."""
    plug, reader, color = found.plug, found.reader, found.values["base_color"]
    share = min(max(reader.value(plug.input(socket)), 0.0), 1.0)
    gray = sum(float(w) * c for w, c in zip(weights, color, strict=True))
    if share == 0.0 or gray <= 0.0:
        return
    if "base_color" in found.pictures:
        reader.note(plug, f"'{socket}' is not supported with a varying base color; ignored.")
        return
    found.values[name] = tuple(1.0 - share + share * c / gray for c in color)


def _read_layered(found):
    """Parameters specific to the Principled BSDF of 4.0 and newer, if they have an effect."""
    found.values["formula"] = "layered"
    found.read("specular_tint", "Specular Tint")
    if "specular_tint" not in found.pictures and set(found.values["specular_tint"]) == {1.0}:
        found.drop("specular_tint")
    found.read("coat", "Coat Weight", least=0.0)
    _note_beyond_range(found, "coat", "Coat Weight")
    if found.has("coat"):
        found.read("coat_roughness", "Coat Roughness")
        found.read("coat_index", "Coat IOR", least=1.0)
        found.read("coat_tint", "Coat Tint")
        found.values["coat_lobe"] = _COAT_LOBE
    else:
        found.drop("coat")
    found.read("sheen", "Sheen Weight")
    if found.has("sheen"):
        found.read("sheen_roughness", "Sheen Roughness")
        found.read("sheen_tint", "Sheen Tint")
    else:
        found.drop("sheen")


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


def _read_specular(found):
    """Specular level, where 0.5 means IOR 1.5, as in Blender: it scales the IOR's reflectance at normal
    incidence. Before 4.0 that reflectance is fixed at 4%, and IOR applies to transmission only."""
    found.read("specular", "Specular IOR Level", "Specular")
    if not found.plug.input("Specular IOR Level"):
        return
    _read_index(found)
    if "specular" in found.pictures or "index" in found.pictures:
        found.values["specular_of_index"] = 1
        return
    index = found.values["index"]
    found.drop("index")
    found.values["specular"] *= ((index - 1.0) / (index + 1.0)) ** 2 / _USUAL_F0


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
    item = node.bl_rna.properties[name].enum_items.get(getattr(node, name))
    return item.name if item else UNKNOWN


def _note_anisotropy(plug, reader):
    amount = plug.input("Anisotropy")  # 4.0 and newer; a separate node before
    if amount and (fed_by(amount) or abs(own_value(amount)) > 1e-6):
        reader.note(plug, "'Anisotropy' is not supported; ignored.")


def _read_emission(plug, reader):
    glow = _glow(plug.input("Color"), plug.input("Strength"), reader)
    return [glow or Layer("emission", {"base_color": (0.0, 0.0, 0.0)}, {})]


def _glow(color, strength, reader):
    """An emission Layer; None if it emits nothing."""
    color, picture = reader.number(color)
    strength, gain = reader.number(strength)
    if gain is None and strength == 0.0:
        return None
    if picture is None and gain is None:
        radiance = tuple(strength * c for c in color)
        return Layer("emission", {"base_color": radiance}, {}) if any(radiance) else None
    pictures = {"base_color": picture} if picture else {}
    return Layer("emission", {"base_color": color}, pictures, (Factor("gain", strength, gain),))


def _read_transparent(plug, reader):
    color, picture = reader.number(plug.input("Color"))
    return [Layer("transparent", {"base_color": color}, {"base_color": picture} if picture else {})]


def _read_sheen(plug, reader):
    """The fuzz of a Principled BSDF, which has nothing else."""
    if plug.node.distribution != "MICROFIBER":
        label = _label(plug.node, "distribution")
        reader.note(plug, f"its distribution '{label}' is not supported; rendered as Microfiber.")
    found = _Principled(plug, reader)
    found.read("sheen_tint", "Color")
    found.read("sheen_roughness", "Roughness")
    values = {**BLACK, "formula": "layered", "sheen": 1.0, **found.values}
    return [Layer("principled", values, found.pictures, relief=read_relief(plug, reader))]


def _read_volume(plug, reader):
    """Nothing: Cycles ignores volume shaders in a surface."""
    return []


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
    "ShaderNodeBsdfSheen": _read_sheen,
    "ShaderNodeVolumeAbsorption": _read_volume,
    "ShaderNodeVolumeScatter": _read_volume,
    "ShaderNodeVolumePrincipled": _read_volume,
    "ShaderNodeVolumeCoefficients": _read_volume,
}


def note_linked(plug, reader, name):
    """Notes an unsupported link to an input."""
    if fed_by(plug.input(name)):
        reader.note(plug, f"'{name}' is not supported; ignored.")


def _note_ignored(plug, reader):
    for name in _IGNORED:
        _note_unused(plug, reader, name)
    note_linked(plug, reader, "Tangent")


def _note_unused(plug, reader, name):
    """Notes an unsupported input that has an effect."""
    socket = plug.input(name)
    if socket and (fed_by(socket) or abs(own_value(socket)) > 1e-6):
        reader.note(plug, f"'{name}' is not supported; ignored.")
