"""Color nodes: mixes, ramps, curves, adjustments, channels."""

from ...native import table
from ..conversions import luminance_of
from ..image_nodes import UnsupportedError
from .blackbody import blackbody
from .curves import curve_range, curve_table, ramp_table
from .math_nodes import by_identifier, known


def _mix_rgb(c, plug):
    blend = known(plug.node, "blend_type", table.BLENDS)
    inputs = [c.input(plug.input(name)) for name in ("Fac", "Color1", "Color2")]
    return c.draft.one("mix_color", inputs, 3, (blend, 1, plug.node.use_clamp))


def _mix(c, plug):
    node = plug.node

    def given(name, kind):
        return c.input(by_identifier(plug, f"{name}_{kind}"))

    if node.data_type == "FLOAT":
        inputs = [given(name, "Float") for name in ("Factor", "A", "B")]
        return c.draft.one("mix_number", inputs, 1, (node.clamp_factor,))
    if node.data_type == "VECTOR":
        if node.factor_mode == "NON_UNIFORM":
            factor = given("Factor", "Vector")
        else:
            factor = c.draft.joined(*(given("Factor", "Float"),) * 3)
        inputs = factor, given("A", "Vector"), given("B", "Vector")
        return c.draft.one("mix_vector", inputs, 3, (node.clamp_factor,))
    if node.data_type != "RGBA":
        raise UnsupportedError(f"'{node.name}' mixes values other than numbers, vectors and colors")
    blend = known(node, "blend_type", table.BLENDS)
    inputs = given("Factor", "Float"), given("A", "Color"), given("B", "Color")
    return c.draft.one("mix_color", inputs, 3, (blend, node.clamp_factor, node.clamp_result))


def _ramp(c, plug):
    ramp = plug.node.color_ramp
    factor = c.input(plug.input("Fac", "Factor"))
    color, alpha = c.draft.step(
        "ramp", (factor,), (3, 1), (ramp.interpolation != "CONSTANT",), ramp_table(ramp)
    )
    return alpha if plug.socket.name == "Alpha" else color


def _curves(c, plug, color, count, combined=None):
    mapping = plug.node.mapping
    low, high = curve_range(mapping, count)
    inputs = (
        c.input(plug.input("Fac", "Factor")),
        color,
        c.draft.number(low),
        c.draft.number(high),
    )
    extends = mapping.extend == "EXTRAPOLATED"
    return c.draft.one("curves", inputs, 3, (extends,), curve_table(mapping, low, high, combined))


def _rgb_curves(c, plug):
    return _curves(c, plug, c.input(plug.input("Color")), 4, combined=3)


def _vector_curves(c, plug):
    return _curves(c, plug, c.input(plug.input("Vector")), 3)


def _float_curve(c, plug):
    value = c.input(plug.input("Value"))
    return _curves(c, plug, c.draft.joined(value, value, value), 1).component(0)


def _hue_saturation(c, plug):
    names = (("Hue",), ("Saturation",), ("Value",), ("Fac", "Factor"), ("Color",))
    return c.draft.one("hue_saturation", [c.input(plug.input(*name)) for name in names], 3)


def _invert(c, plug):
    return c.draft.one("invert", (c.input(plug.input("Fac", "Factor")), c.input(plug.input("Color"))), 3)


def _gamma(c, plug):
    return c.draft.one("gamma", (c.input(plug.input("Color")), c.input(plug.input("Gamma"))), 3)


def _bright_contrast(c, plug):
    inputs = plug.input("Color"), plug.input("Bright", "Brightness"), plug.input("Contrast")
    return c.draft.one("bright_contrast", [c.input(each) for each in inputs], 3)


def _rgb_to_bw(c, plug):
    return luminance_of(c.draft, c.input(plug.input("Color")))


def _model(node):
    return known(node, "mode", table.COLOR_MODELS)


def _separated(c, plug, name, model):
    parts = c.draft.one("separate", (c.input(plug.input(name)),), 3, (model,))
    return parts.component(list(plug.node.outputs).index(plug.socket))


def _combined(c, plug, model):
    parts = [c.input(type(plug)(socket, plug.groups)) for socket in plug.node.inputs[:3]]
    return c.draft.one("combine", parts, 3, (model,))


def _rgb(c, plug):
    return c.draft.vector(plug.socket.default_value)


NODES = {
    "ShaderNodeBlackbody": blackbody,
    "ShaderNodeMixRGB": _mix_rgb,
    "ShaderNodeMix": _mix,
    "ShaderNodeValToRGB": _ramp,
    "ShaderNodeRGBCurve": _rgb_curves,
    "ShaderNodeVectorCurve": _vector_curves,
    "ShaderNodeFloatCurve": _float_curve,
    "ShaderNodeHueSaturation": _hue_saturation,
    "ShaderNodeInvert": _invert,
    "ShaderNodeGamma": _gamma,
    "ShaderNodeBrightContrast": _bright_contrast,
    "ShaderNodeRGBToBW": _rgb_to_bw,
    "ShaderNodeSeparateColor": lambda c, plug: _separated(c, plug, "Color", _model(plug.node)),
    "ShaderNodeSeparateRGB": lambda c, plug: _separated(c, plug, "Image", "rgb"),
    "ShaderNodeSeparateHSV": lambda c, plug: _separated(c, plug, "Color", "hsv"),
    "ShaderNodeCombineColor": lambda c, plug: _combined(c, plug, _model(plug.node)),
    "ShaderNodeCombineRGB": lambda c, plug: _combined(c, plug, "rgb"),
    "ShaderNodeCombineHSV": lambda c, plug: _combined(c, plug, "hsv"),
    "ShaderNodeRGB": _rgb,
}
