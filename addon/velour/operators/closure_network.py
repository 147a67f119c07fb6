"""Blender's own nodes in the place of a measured material: BSDFs with curves over the view angle.

They render in Cycles and EEVEE, on any device, wherever the file is opened. theta_v is the angle between
the shading normal N and the direction Incoming, toward the viewer. A lobe is a Glossy BSDF about its own
normal N':

    N' = normalize(N + tilt (Incoming - N))    1: toward the viewer; negative: away from the viewer
    alpha_x, alpha_y = roughness^2 (1 - anisotropy), roughness^2 / (1 - anisotropy)     if anisotropy >= 0
                       roughness^2 / (1 + anisotropy), roughness^2 (1 + anisotropy)     otherwise

x lies in the plane of incidence or, for anisotropic measurements, along the tangent of the UV map.
"""

import math
from typing import NamedTuple

import bpy
import numpy as np

from ..export.color import rec709_to_working
from .node_builder import NodeBuilder, remove_built

_TAG = "velour_closures"
_SAME = 1e-5  # curves that vary by less are constants
_PARTS, _SUMS = 5.5, 9.7  # columns where BSDFs and their sums begin
_CURVE, _ROW = -330, -60  # from a color's curve to the next row, and between rows
_BLUR_ROWS = 4  # rows of a stretched lobe's roughness and anisotropy, where they are blurred


class Inputs(NamedTuple):
    """Sockets that control a network, usually of the tree's Group Input. None: the control is left out."""

    tint: bpy.types.NodeSocket | None = None  # factor on colors
    normal: bpy.types.NodeSocket | None = (
        None  # replaces the surface's unless it is (0, 0, 0), as if unlinked
    )
    exposure: bpy.types.NodeSocket | None = None  # brightens by powers of 2
    rotation: bpy.types.NodeSocket | None = None  # turns the tangent of anisotropic measurements: radians
    roughness: bpy.types.NodeSocket | None = None  # blurs lobes as it would blur a mirror


def build(tree, closures, tint=None, normal=None, exposure=None, rotation=None, roughness=None):
    """Adds the network to a ShaderNodeTree; returns the output socket of its BSDF.

    closures: a dict of curves, each a list of values at equal steps of theta_v from 0 to 90 degrees:
    "diffuse", albedos, and "lobes", a list of dicts of "distribution" ("GGX" or "BECKMANN"), "color",
    "roughness", "tilt" and "anisotropy". Colors are linear Rec. 709 and may exceed 1. "frame", the direction
    of x: "incidence" (the default) or "surface". The other arguments: see Inputs.

    Replaces the nodes that the last call added to the tree; what was linked to their output stays linked.
    """
    shown_by = remove_built(tree, _TAG)
    nodes = NodeBuilder(tree, _TAG, "For Cycles and EEVEE")
    bsdf = _Network(nodes, closures, Inputs(tint, normal, exposure, rotation, roughness)).bsdf()
    for socket in shown_by:
        tree.links.new(bsdf, socket)
    return bsdf


class _Network:
    def __init__(self, nodes, closures, inputs):
        self._nodes, self._closures, self._inputs = nodes, closures, inputs
        self._to_working = rec709_to_working().T
        self._y = 0  # of the next part

    def bsdf(self):
        lobes = [lobe for lobe in self._closures["lobes"] if np.max(lobe["color"]) > 0]
        self._add_view(lobes)
        shaders = []
        if np.max(self._closures["diffuse"]) > 0 or not lobes:
            shaders.append(self._add_diffuse())
        shaders += [self._add_lobe(number, lobe) for number, lobe in enumerate(lobes, 1)]
        return self._sum(shaders)

    def _add_view(self, lobes):
        """Adds the nodes that all BSDFs share."""
        nodes = self._nodes
        nodes.begin_part("View and controls")
        geometry = nodes.add("ShaderNodeNewGeometry", 0)
        incoming, self._normal = geometry.outputs["Incoming"], geometry.outputs["Normal"]
        if self._inputs.normal is not None:
            self._normal = self._given_normal(self._inputs.normal, self._normal)
        cosine = nodes.vector("DOT_PRODUCT", 3.1, self._normal, incoming)
        angle = nodes.math("ARCCOSINE", 3.7, cosine, label="View angle")
        self._x = nodes.math("MULTIPLY", 4.3, angle, 2 / math.pi, label="0 facing, 1 grazing")
        self._to_viewer = self._tangent = self._turns = self._blur = None
        if any(_is_used(lobe["tilt"]) for lobe in lobes):
            self._to_viewer = nodes.vector(
                "SUBTRACT", 3.1, incoming, self._normal, y=-60, label="To the viewer"
            )
        if any(_is_used(lobe["anisotropy"]) for lobe in lobes):
            self._add_tangent(incoming)
        self._gain = self._add_gain()
        if self._inputs.roughness is not None:
            self._blur = nodes.math("POWER", 1.9, self._inputs.roughness, 4.0, y=-180, label="Blur")

    def _given_normal(self, given, normal):
        nodes = self._nodes
        length = nodes.vector("DOT_PRODUCT", 0.7, given, given)
        missing = nodes.math("LESS_THAN", 1.3, length, 0.25, label="Not linked")
        either = nodes.vector("MULTIPLY_ADD", 1.9, normal, missing, given, label="Surface's or given")
        return nodes.vector("NORMALIZE", 2.5, either, label="Normal")

    def _add_tangent(self, incoming):
        # Cycles projects it onto the tangent plane. The offset remains there at normal incidence, and on
        # meshes without the UV map, where lobes would be black.
        nodes, offset = self._nodes, (1e-4, 2e-4, 1.5e-4)
        if self._closures.get("frame", "incidence") == "incidence":
            self._tangent = nodes.vector("ADD", 3.1, incoming, offset, y=-120, label="Plane of incidence")
            return
        tangent = nodes.add("ShaderNodeTangent", 3.1, y=-60)
        tangent.direction_type = "UV_MAP"
        self._tangent = nodes.vector("ADD", 3.7, tangent.outputs[0], offset, y=-60, label="Tangent")
        if self._inputs.rotation is not None:
            turn = self._inputs.rotation, 1 / math.tau
            self._turns = nodes.math("MULTIPLY", 3.1, *turn, y=-120, label="Radians to turns")

    def _add_gain(self):
        """The factor on all colors, a socket; None without controls."""
        tint, exposure = self._inputs.tint, self._inputs.exposure
        if exposure is None:
            return tint
        factor = self._nodes.math("POWER", 1.3, 2.0, exposure, y=-120, label="Exposure")
        color = (1.0, 1.0, 1.0) if tint is None else tint
        return self._nodes.vector("SCALE", 1.9, color, factor, y=-120, label="Gain")

    def _add_diffuse(self):
        self._begin_bsdf("Diffuse", rows=0)
        shader = self._nodes.add("ShaderNodeBsdfDiffuse", 3)
        self._nodes.put(shader.inputs["Color"], self._color(self._closures["diffuse"]))
        if self._inputs.normal is not None:
            self._nodes.put(shader.inputs["Normal"], self._normal)
        return shader

    def _add_lobe(self, number, lobe):
        nodes = self._nodes
        is_stretched, is_tilted = _is_used(lobe["anisotropy"]), _is_used(lobe["tilt"])
        is_blurred_by_axis = is_stretched and self._blur is not None
        rows = _BLUR_ROWS if is_blurred_by_axis else 1 + is_stretched
        self._begin_bsdf(f"Lobe {number}", rows=rows + is_tilted)
        is_plain = not is_stretched and hasattr(bpy.types, "ShaderNodeBsdfGlossy")  # gone since Blender 4.0
        shader = nodes.add("ShaderNodeBsdfGlossy" if is_plain else "ShaderNodeBsdfAnisotropic", 3)
        shader.distribution = lobe["distribution"]
        nodes.put(shader.inputs["Color"], self._color(lobe["color"]))
        y = _CURVE
        if is_blurred_by_axis:
            roughness, anisotropy = self._blurred_by_axis(lobe, y)
            y += (_BLUR_ROWS - 1) * _ROW
        else:
            roughness = self._blurred(self._curve(lobe["roughness"], y, "Roughness"), y)
            if is_stretched:
                y += _ROW
                anisotropy = self._curve(lobe["anisotropy"], y, "Anisotropy")
        nodes.put(shader.inputs["Roughness"], roughness)
        if is_stretched:
            nodes.put(shader.inputs["Anisotropy"], anisotropy)
            nodes.put(shader.inputs["Tangent"], self._tangent)
            if self._turns is not None:
                nodes.put(shader.inputs["Rotation"], self._turns)
        if is_tilted:
            y += _ROW
            tilt = self._curve(lobe["tilt"], y, "Tilt")
            tilted = nodes.vector(
                "MULTIPLY_ADD", 1.7, self._to_viewer, tilt, self._normal, y=y, label="Tilted"
            )
            nodes.put(shader.inputs["Normal"], nodes.vector("NORMALIZE", 2.3, tilted, y=y))
        elif self._inputs.normal is not None:
            nodes.put(shader.inputs["Normal"], self._normal)
        return shader

    def _begin_bsdf(self, label, rows):
        """Starts the part of a BSDF, with `rows` rows below that of its color."""
        self._nodes.begin_part(label, _PARTS, self._y)
        self._y += _CURVE + (rows + 2) * _ROW
        x = self._nodes.add("NodeReroute", -0.25, -200)
        self._nodes.put(x.inputs[0], self._x)
        self._part_x = x.outputs[0]

    def _sum(self, shaders):
        bsdf, *others = (shader.outputs[0] for shader in shaders)
        for number, other in enumerate(others):
            self._nodes.begin_part(column=_SUMS + 0.7 * number, y=other.node.location.y)
            both = self._nodes.add("ShaderNodeAddShader")
            self._nodes.put(both.inputs[0], bsdf)
            self._nodes.put(both.inputs[1], other)
            bsdf = both.outputs[0]
        return bsdf

    def _color(self, colors):
        """The color over the view times the gain: a socket or a constant."""
        colors = np.maximum(np.array(colors, float) @ self._to_working, 0)
        if np.ptp(colors, axis=0).max() < _SAME:
            color = tuple(map(float, colors[0]))
        else:
            # Curves in [0, 1] are visible in the node and need no clipping; the rest is a factor.
            brightest = float(colors.max())
            node = self._nodes.add("ShaderNodeRGBCurve", 0, label="Color")
            _set_curves(node.mapping, (colors / brightest).T)
            self._nodes.put(node.inputs["Color"], self._part_x)
            curves = node.outputs["Color"]
            color = self._nodes.vector("SCALE", 1.1, curves, brightest, label="Brightest value")
        if self._gain is None:
            return color
        return self._nodes.vector("MULTIPLY", 1.7, color, self._gain, label="Gain")

    def _curve(self, values, y, label):
        """The value over the view: a socket or a constant."""
        values = np.array(values, float)
        low, high = float(values.min()), float(values.max())
        if high - low < _SAME:
            return float(values[0])
        is_unit = low >= 0 and high <= 1
        node = self._nodes.add("ShaderNodeFloatCurve", 0, y, label, hide=True)
        _set_curves(node.mapping, [values if is_unit else (values - low) / (high - low)])
        self._nodes.put(node.inputs["Value"], self._part_x)
        if is_unit:
            return node.outputs[0]
        span = high - low
        return self._nodes.math("MULTIPLY_ADD", 1.1, node.outputs[0], span, low, y=y, label="Range")

    def _blurred(self, roughness, y):
        """Adds squared alphas, the fourth powers of the roughness."""
        if self._blur is None:
            return roughness
        nodes = self._nodes
        own = nodes.math("POWER", 1.1, roughness, 4.0, y=y, label="Squared alpha")
        both = nodes.math("ADD", 1.7, own, self._blur, y=y, label="Blur", use_clamp=True)
        return nodes.math("POWER", 2.3, both, 0.25, y=y, label="Roughness")

    def _blurred_by_axis(self, lobe, y):
        """Roughness and anisotropy of a stretched lobe: squared alphas add along x and along y."""
        nodes, squares = self._nodes, []
        rows = [y + row * _ROW for row in range(_BLUR_ROWS)]
        for axis, root, row in zip("xy", _roots_of_alphas(lobe), rows, strict=False):
            own = nodes.math("POWER", 1.1, self._curve(root, row, f"Root of alpha {axis}"), 4.0, y=row)
            squares.append(nodes.math("ADD", 1.7, own, self._blur, y=row, label="Blur", use_clamp=True))
        both = nodes.math("MULTIPLY", 2.25, *squares, y=y)
        # Roots of alpha_x / alpha_y and of its inverse, at most 1: one is 1, the other 1 - |anisotropy|.
        along, across = (
            nodes.math("POWER", 2.3, nodes.math("DIVIDE", 1.75, *each, y=row), 0.25, y=row, use_clamp=True)
            for each, row in zip((squares, squares[::-1]), rows[2:], strict=True)
        )
        return (
            nodes.math("POWER", 2.8, both, 0.125, y=y, label="Roughness"),
            nodes.math("SUBTRACT", 2.85, across, along, y=rows[2], label="Anisotropy"),
        )


def _roots_of_alphas(lobe):
    """Roots of alpha_x and of alpha_y over the view: roughness by axis."""
    roughness, anisotropy = (np.array(lobe[key], float) for key in ("roughness", "anisotropy"))
    narrow = np.sqrt(1 - np.abs(anisotropy))
    x, y = roughness * narrow, roughness / narrow
    return np.where(anisotropy < 0, (y, x), (x, y))


def _is_used(values):
    return np.abs(values).max() > 1e-4


def _set_curves(mapping, curves):
    """Sets a node's curves to values in [0, 1] at equal steps, linear between them and constant beyond."""
    mapping.use_clip, mapping.extend = False, "HORIZONTAL"
    for curve, values in zip(mapping.curves, curves, strict=False):
        last = len(values) - 1
        points = curve.points
        points[0].location, points[1].location = (0, values[0]), (1, values[last])
        for i in range(1, last):
            points.new(i / last, values[i])
        for point in points:
            point.handle_type = "VECTOR"
    mapping.update()
