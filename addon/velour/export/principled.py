"""The analytic stand-in of materials that are not measured."""

from .image_nodes import UnsupportedError, named_uv_maps, picture_of
from .nodes import active_output, first_input, source

DEFAULT = {"base_color": (0.8, 0.8, 0.8), "metallic": 0.0, "roughness": 0.5, "specular": 0.5}

# Our parameter: the names of Blender's input socket over the versions.
_PRINCIPLED = {
    "base_color": ("Base Color",),
    "metallic": ("Metallic",),
    "roughness": ("Roughness",),
    "specular": ("Specular IOR Level", "Specular"),
    "alpha": ("Alpha",),
}
_TEXTURED = ("base_color", "metallic", "roughness", "alpha")
# Inputs that Velour does not render, and the value at which that makes no difference.
_IGNORED = {
    "Subsurface": 0.0,
    "Subsurface Weight": 0.0,
    "Specular Tint": 0.0,
    "Anisotropic": 0.0,
    "Sheen": 0.0,
    "Sheen Weight": 0.0,
    "Clearcoat": 0.0,
    "Coat Weight": 0.0,
    "Transmission": 0.0,
    "Transmission Weight": 0.0,
}
_LINK_ONLY = ("Normal", "Clearcoat Normal", "Coat Normal", "Tangent")


def principled_values(material, notes):
    """Keywords of Scene.add_principled_material, and `pictures`: Pictures in the place of numbers.

    Says in `notes` what it leaves out.
    """
    if material is None:
        return dict(DEFAULT)
    if not material.use_nodes or material.node_tree is None:
        return _without_nodes(material)
    owner = f"Material '{material.name}'"
    output = active_output(material.node_tree, "ShaderNodeOutputMaterial")
    node = source(output.inputs["Surface"]) if output else None
    if node is None:
        notes.add(f"{owner}: it has no surface shader; rendered black.")
        return {**DEFAULT, "base_color": (0, 0, 0), "specular": 0.0}
    for name in ("Volume", "Displacement"):
        if source(output.inputs[name]):
            notes.add(f"{owner}: {name.lower()} is not supported; ignored.")
    reader = _READERS.get(node.bl_idname)
    if reader is None:
        notes.add(f"{owner}: node '{node.name}' ({node.bl_label}) is not supported; rendered grey.")
        return dict(DEFAULT)
    return reader(node, owner, notes)


def _without_nodes(material):
    return {
        "base_color": tuple(material.diffuse_color[:3]),
        "metallic": material.metallic,
        "roughness": material.roughness,
        "specular": material.specular_intensity,
    }


def _read_principled(node, owner, notes):
    inputs = {name: first_input(node, *sockets) for name, sockets in _PRINCIPLED.items()}
    pictures = _pictures({name: inputs[name] for name in _TEXTURED}, node, owner, notes)
    values = {
        name: _own_value(socket) if name in _TEXTURED else _value(socket, node, owner, notes)
        for name, socket in inputs.items()
    }
    values["pictures"] = pictures
    emission = first_input(node, "Emission Color", "Emission")
    strength = first_input(node, "Emission Strength")
    color, factor = _value(emission, node, owner, notes), _value(strength, node, owner, notes)
    values["emission"] = tuple(factor * c for c in color)
    _note_ignored(node, owner, notes)
    return values


def _read_diffuse(node, owner, notes):
    color = node.inputs["Color"]
    if node.inputs["Roughness"].default_value > 0:
        notes.add(f"{owner}: node '{node.name}': roughness of a diffuse shader is ignored.")
    values = {"base_color": _own_value(color), "metallic": 0.0, "roughness": 1.0, "specular": 0.0}
    return {**values, "pictures": _pictures({"base_color": color}, node, owner, notes)}


def _read_emission(node, owner, notes):
    color = _value(node.inputs["Color"], node, owner, notes)
    strength = _value(node.inputs["Strength"], node, owner, notes)
    emission = tuple(strength * c for c in color)
    return {"base_color": (0, 0, 0), "metallic": 0.0, "roughness": 1.0, "specular": 0.0, "emission": emission}


_READERS = {
    "ShaderNodeBsdfPrincipled": _read_principled,
    "ShaderNodeBsdfDiffuse": _read_diffuse,
    "ShaderNodeEmission": _read_emission,
}


def _pictures(sockets, node, owner, notes):
    """The Picture of each socket to which an image is linked; other links are noted."""
    found = {}
    for name, socket in sockets.items():
        try:
            picture = picture_of(socket)
        except UnsupportedError as reason:
            _note_link(socket, node, owner, notes, f" ({reason})")
            continue
        if picture:
            found[name] = picture
    if len({picture.coordinates for picture in found.values()}) > 1:
        shown = named_uv_maps(node.id_data)[0]
        notes.add(f"{owner}: its pictures ask for several UV maps; all are shown by '{shown}'.")
    return found


def _value(socket, node, owner, notes):
    """The socket's own value; what is linked to it is noted."""
    if socket is not None and source(socket):
        _note_link(socket, node, owner, notes)
    return _own_value(socket)


def _own_value(socket):
    """A number, or three of a colour."""
    value = socket.default_value if socket else 0.0
    return value if isinstance(value, float) else tuple(value[:3])


def _note_link(socket, node, owner, notes, reason=""):
    notes.add(
        f"{owner}: node '{node.name}': the link to '{socket.name}' is ignored; its own value is used{reason}."
    )


def _note_ignored(node, owner, notes):
    for name, harmless in _IGNORED.items():
        socket = node.inputs.get(name)
        if socket is None:
            continue
        value = socket.default_value
        # Newer tints are colours, of which white makes no difference.
        off = abs(value - harmless) if isinstance(value, float) else max(abs(c - 1.0) for c in value[:3])
        if source(socket) or off > 1e-6:
            notes.add(f"{owner}: node '{node.name}': '{name}' is not supported; ignored.")
    for name in _LINK_ONLY:
        if name in node.inputs and source(node.inputs[name]):
            notes.add(f"{owner}: node '{node.name}': '{name}' is not supported; ignored.")
