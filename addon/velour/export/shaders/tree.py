"""Reads the layers of a material's surface from its active output."""

from ..conversions import converted
from ..image_nodes import UnsupportedError
from ..newer import has_nodes
from ..nodes import active_output, former_node, model_texture
from ..plugs import Plug, fed_by, inside, is_measured
from ..programs import displaced
from .layer import Factor, Layer, black, diffuse, gray, simplified, split
from .measured import former_layer, read_measured
from .readers import READERS
from .values import Reader

_MOST_LAYERS = 64  # nested mixes with shared shaders can have far more


def surface_layers(material, notes, unit=1.0, opens_measured=False):
    """The Layers of a material; notes what is left out.

    unit: length of Blender's unit in the library's scene.
    opens_measured: read the nodes in measured groups instead of their models.
    """
    if material is None:
        return [gray()]
    former = None if opens_measured else former_node(material)
    if former is not None:
        return [former_layer(former)]
    if not has_nodes(material):
        return [diffuse(tuple(material.diffuse_color[:3]))]  # the viewport color, as in Cycles
    owner = f"Material '{material.name}'"
    output = active_output(material.node_tree, "ShaderNodeOutputMaterial")
    plug, volume = (fed_by(Plug(output.inputs[name])) if output else None for name in ("Surface", "Volume"))
    if volume:
        notes.add(f"{owner}: volume is not supported; ignored.")
    if plug is None and volume:  # its surface is the border of the volume
        return [Layer("transparent", {"base_color": (1.0, 1.0, 1.0)}, {})]
    if plug is None:
        notes.add(f"{owner}: it has no surface shader; rendered black.")
        return [black()]
    reader = Reader(owner, notes, unit, opens_measured)
    _read_displacement(fed_by(Plug(output.inputs["Displacement"])), material, reader)
    layers = simplified(_read(plug, reader))
    if reader.steps_left <= 0 or len(layers) > _MOST_LAYERS:
        notes.add(f"{owner}: mixing more than {_MOST_LAYERS} shaders is not supported; rendered gray.")
        return [gray()]
    return layers if _shadows_are_clear(material) else _with_opaque_shadows(layers, reader)


def _with_opaque_shadows(layers, reader):
    """Layers whose transparent parts stop shadow rays."""
    parts = [part for each in layers for part in split(each)]
    if all(part.kind != "transparent" for part in parts):
        return layers
    shadow = reader.compiler.computed_source("shadow_ray")
    if shadow is None:
        reader.notes.add(f"{reader.owner}: too many computed inputs; light passes through it.")
        return layers
    # Cycles finds part of the world's light, or all if it is of one color, by rays that are no shadow rays.
    reader.notes.add(
        f"{reader.owner}: its opaque shadows also block the light of the world, which Cycles lets through."
    )
    stops = Factor("rest", 0.0, shadow)
    return [part.weighed(stops) if part.kind == "transparent" else part for part in parts]


def _read_displacement(plug, material, reader):
    """Bends the surface's normal by displacement as bump; notes other displacement."""
    if plug is None or (_is_relief_of_model(plug) and not reader.opens_measured):
        return
    if _displacement_method(material) != "BUMP":
        reader.notes.add(f"{reader.owner}: displacement is not supported other than as bump; ignored.")
        return
    try:
        reader.compiler.displaced_normal = displaced(reader.compiler, plug)
    except UnsupportedError as reason:
        reader.notes.add(f"{reader.owner}: displacement is ignored: {reason}.")


def _is_relief_of_model(plug):
    """Whether a measured group displaces the surface in other engines; its model has the relief."""
    return bool(plug.groups) and model_texture(plug.groups[-1].node_tree) is not None


def _displacement_method(material):
    """BUMP, DISPLACEMENT or BOTH; a Cycles setting before Blender 4.1."""
    of_cycles = getattr(getattr(material, "cycles", None), "displacement_method", "BUMP")
    return getattr(material, "displacement_method", of_cycles)


def _shadows_are_clear(material):
    """Whether transparent surfaces cast transparent shadows; a Cycles setting before Blender 4.2."""
    of_cycles = getattr(getattr(material, "cycles", None), "use_transparent_shadow", True)
    return getattr(material, "use_transparent_shadow", of_cycles)


def _read(plug, reader):
    """Layers of the shader at an output."""
    if reader.steps_left <= 0:
        return []
    reader.steps_left -= 1
    node = plug.node
    if plug.socket.type != "SHADER":
        return _read_color(plug, reader)
    if node.bl_idname == "ShaderNodeMixShader":
        return _read_mix(plug, reader)
    if node.bl_idname == "ShaderNodeAddShader":
        return [layer for part in _shaders(plug, reader) for layer in part]
    if is_measured(plug):
        if not reader.opens_measured:
            return read_measured(plug, reader)
        inner = fed_by(inside(plug))
        return _read(inner, reader) if inner else []
    read = READERS.get(node.bl_idname)
    if read is None:
        reader.notes.add(
            f"{reader.owner}: node '{node.name}' ({node.bl_label}) is not supported; rendered gray."
        )
        return [gray()]
    return read(plug, reader)


def _read_color(plug, reader):
    """An emission of the color or number that is linked where a shader belongs, as in Cycles."""
    compiler = reader.compiler
    try:
        value = converted(compiler.draft, compiler.output(plug), (plug.socket.type, "RGBA"))
        if value.first < 0:
            return [Layer("emission", {"base_color": compiler.draft.constants_of(value)}, {})]
        if found := compiler.draft.output(value, "color"):
            return [Layer("emission", {"base_color": (1.0, 1.0, 1.0)}, {"base_color": found})]
        reason = "the material has too many computed inputs"
    except UnsupportedError as why:
        reason = why
    reader.note(plug, f"its emission is not supported ({reason}); ignored.")
    return []


def _shaders(plug, reader):
    """Layers of each shader that is mixed or added; empty if nothing is linked."""
    fed = [fed_by(shader) for shader in plug.inputs("NodeSocketShader")]
    return [_read(shader, reader) if shader else [] for shader in fed]


def _read_mix(plug, reader):
    factor = plug.input("Fac", "Factor")
    value, picture = reader.number(factor)
    parts = zip(_shaders(plug, reader), ("rest", "share"), strict=False)
    return [layer.weighed(Factor(kind, value, picture)) for part, kind in parts for layer in part]
