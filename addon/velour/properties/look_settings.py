"""Settings of a measured node that became inputs of its group: scripts may set them by their former names."""

import warnings

from ..export.measured_look import INPUTS
from ..export.nodes import model_texture, nodes_of


def stored_or_input(field, default):
    """Accessors of a property: the group's input, or what a material of the former layout stores.

    field: of a MeasuredLook, and the property's name.
    """

    def get(settings):
        socket = next(iter(_sockets(settings, field)), None)
        value = _storage(settings).get(field, default) if socket is None else socket.default_value
        return tuple(value)[:3] if hasattr(value, "__len__") else value

    def put(settings, value):
        value = _clamped(settings, field, value)
        is_color = hasattr(value, "__len__")
        is_evaluated = settings.id_data.is_evaluated  # by an F-curve of the former layout
        sockets = [] if is_evaluated else _sockets(settings, field)
        for socket in sockets:
            socket.default_value = (*value, 1.0) if is_color else value
        if not sockets:
            _storage(settings)[field] = value
        if sockets or (_measured_groups(settings) and not is_evaluated):
            _warn(field, bool(sockets))

    return {"get": get, "set": put}


def _clamped(settings, field, value):
    """Blender does not clamp numbers for a setter."""
    limits = settings.bl_rna.properties[field]
    low, high = limits.hard_min, limits.hard_max
    return tuple(min(max(v, low), high) for v in value) if limits.is_array else min(max(value, low), high)


def _storage(settings):
    """Where Blender itself keeps properties: since 5.0 apart from the users' own."""
    apart = getattr(settings, "bl_system_properties_get", None)
    return apart(do_create=True) if apart else settings


def _sockets(settings, field):
    """The inputs that replace a setting; none in the former layout, or if the model has no such input."""
    nodes = _measured_groups(settings)
    return [node.inputs[INPUTS[field]] for node in nodes if INPUTS[field] in node.inputs]


def _measured_groups(settings):
    """The group nodes of settings: the settings' own node, or all users of the group that contains it."""
    tree = settings.id_data
    node = next((node for node in tree.nodes if _has(node, settings)), None)
    if node is None:
        return []
    if node.bl_idname == "ShaderNodeGroup":
        return [node] if node.node_tree and model_texture(node.node_tree) else []
    return nodes_of(tree) if node.velour.enabled and not tree.is_embedded_data else []


def _has(node, settings):
    own = getattr(node, "velour", None)
    return own is not None and settings in (own, own.placement)


def _warn(field, has_input):
    place = "placement.rotation" if field == "rotation" else field
    name = INPUTS[field]
    if has_input:
        sentence = (
            f"node.velour.{place} is an input of the node now: set node.inputs['{name}'].default_value."
        )
    else:
        sentence = f"node.velour.{place} has no effect: the node has no input '{name}', because of its model."
    # The frames above: put() and the script.
    warnings.warn(sentence, DeprecationWarning, stacklevel=3)
