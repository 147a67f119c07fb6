"""Evaluates nodes at a few points in Blender, and writes rows of program_values.inc (scripts/program_values).

A row: version, operation, choices, values of the input registers, first output register, values.
"""

import sys
from pathlib import Path

import bpy
import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[4] / "addon"))
from velour.native import table  # found by the line above

VERSION = bpy.app.version
NEW, NEWEST = VERSION >= (4, 1), VERSION >= (5, 0)
POINTS = np.array([(0.13, 0.72, 0.41), (-2.31, 0.58, -0.17), (3.74, 2.26, -1.93)], np.float32)
_USUAL = {"Detail": 0.0, "Roughness": 0.5, "Lacunarity": 2.0, "Offset": 0.0, "Gain": 1.0, "Distortion": 0.0}
_COLORS = {"Color1": (0.1, 0.2, 0.3, 1), "Color2": (0.6, 0.5, 0.4, 1), "Mortar": (0.9, 0.1, 0.5, 1)}
_OCTAVES = ("Detail", "Roughness", "Lacunarity")
_NOISE = ("Vector", "W", "Scale", *_OCTAVES, "Offset", "Gain", "Distortion")
_VORONOI = ("Vector", "W", "Scale", *_OCTAVES, "Smoothness", "Exponent", "Randomness")
_WAVE = ("Vector", "Scale", "Distortion", "Detail", "Detail Scale", "Detail Roughness", "Phase Offset")
_BRICK = ("Vector", *_COLORS, "Scale", "Mortar Size", "Mortar Smooth", "Bias", "Brick Width", "Row Height")
_PLACE = {"W": 0.37, "Scale": 1.7}
_BOTH = {"Fac": 0, "Color": 1}  # outputs
_FRACTALS = ("FBM", "MULTIFRACTAL", "HYBRID_MULTIFRACTAL", "RIDGED_MULTIFRACTAL", "HETERO_TERRAIN")


def cases():
    """Operation, choices, idname, properties, values of inputs, names of inputs, {output: first register}.

    Inputs named @name are linked to the point's first coordinate, or to the point if they are not numbers.
    """
    if not NEW:
        yield from _musgrave()
        return
    yield from _voronoi()
    if NEWEST:
        return
    yield from _noise()
    yield from _patterns()
    yield from _numbers()


def _noise():
    for d in range(4):
        place = {"noise_dimensions": f"{d + 1}D"}
        for octaves in ((0.0, 0.5, 2.0, 0.0), (2.6, 0.4, 2.0, 0.0), (1.0, 0.7, 2.0, 0.8)):
            inputs = _PLACE | dict(zip((*_OCTAVES, "Distortion"), octaves, strict=True))
            yield "noise", (d, 0, 1, 1), "TexNoise", place, inputs, _NOISE, _BOTH
        for kind, name in enumerate(_FRACTALS):
            inputs = _PLACE | dict(zip(_OCTAVES, (2.6, 0.6, 1.9), strict=True))
            inputs |= {"Offset": 0.4, "Gain": 1.3, "Distortion": 0.2}
            properties = {**place, "noise_type": name, "normalize": False}
            yield "noise", (d, kind, 0, 1), "TexNoise", properties, inputs, _NOISE, _BOTH
        outputs = {"Value": 0, "Color": 1}
        yield "white_noise", (d,), "TexWhiteNoise", place, {"W": 0.37}, ("Vector", "W"), outputs


def _musgrave():
    """As noise with one octave less, and a roughness in place of a dimension."""
    for d in range(4):
        for kind, name in enumerate(_FRACTALS):
            for detail in (2.6, 0.4):
                inputs = {**_PLACE, "Detail": detail, "Lacunarity": 1.9, "Offset": 0.4, "Gain": 1.3}
                ours = inputs | {"Detail": detail - 1, "Roughness": 1.9**-0.8}
                inputs["Dimension"] = 0.8
                properties = {"musgrave_dimensions": f"{d + 1}D", "musgrave_type": name}
                case = ("noise", (d, kind, 0, 0), "TexMusgrave", properties, inputs, _NOISE, {"Fac": 0})
                yield *case, ours


def _voronoi():
    found = {"Distance": 0, "Color": 1, "Position": 4, "W": 7, "Radius": 8}
    metrics = ("EUCLIDEAN", "MANHATTAN", "CHEBYCHEV", "MINKOWSKI")
    for d in range(4):
        for feature, name in enumerate(("F1", "F2", "SMOOTH_F1", "DISTANCE_TO_EDGE", "N_SPHERE_RADIUS")):
            for metric in range(4 if d == 2 and feature < 3 else 1):
                shown = ["Distance", "Color", "Position", "W"] if feature < 3 else ["Distance"]
                shown = ["Radius"] if feature == 4 else [n for n in shown if _has(d, n)]
                for detail, normal in ((0.0, False), (1.6, True)) if feature < 4 else ((0.0, False),):
                    inputs = {**_PLACE, "Smoothness": 0.6, "Exponent": 0.7, "Randomness": 0.9}
                    inputs |= {"Detail": detail, "Roughness": 0.6, "Lacunarity": 1.9}
                    properties = {"voronoi_dimensions": f"{d + 1}D", "feature": name, "normalize": normal}
                    properties["distance"] = metrics[metric]
                    choices = d, feature, metric, normal + 2 * NEWEST
                    outputs = {n: found[n] for n in shown}
                    yield "voronoi", choices, "TexVoronoi", properties, inputs, _VORONOI, outputs


def _has(d, name):
    return (name != "Position" or d > 0) and (name != "W" or d in (0, 3))


def _patterns():
    for kind, name in enumerate(("BANDS", "RINGS")):
        for axis in range(4):
            properties = {"wave_type": name, "wave_profile": ("SIN", "SAW", "TRI")[axis % 3]}
            properties["bands_direction"] = ("X", "Y", "Z", "DIAGONAL")[axis]
            properties["rings_direction"] = ("X", "Y", "Z", "SPHERICAL")[axis]
            inputs = {"Scale": 0.7, "Detail": 1.5, "Detail Scale": 1.3, "Detail Roughness": 0.4}
            inputs |= {"Distortion": 0.0 if axis == 1 else 2.0, "Phase Offset": 0.6}
            yield "wave", (kind, axis, axis % 3), "TexWave", properties, inputs, _WAVE, {"Fac": 0}
    kinds = ("LINEAR", "QUADRATIC", "EASING", "DIAGONAL", "SPHERICAL", "QUADRATIC_SPHERE", "RADIAL")
    for number, kind in enumerate(kinds):
        yield "gradient", (number,), "TexGradient", {"gradient_type": kind}, {}, ("Vector",), {"Fac": 0}
    names = ("Vector", "Color1", "Color2", "Scale")
    inputs = {"Color1": _COLORS["Color1"], "Color2": _COLORS["Color2"], "Scale": 1.3}
    yield "checker", (), "TexChecker", {}, inputs, names, _BOTH
    for smooth in (0.0, 0.3):
        properties = {"offset": 0.3, "squash": 1.4, "offset_frequency": 2, "squash_frequency": 3}
        inputs = {"Scale": 1.3, "Mortar Size": 0.2, "Mortar Smooth": smooth, "Bias": 0.1, "Brick Width": 0.8}
        inputs |= {**_COLORS, "Row Height": 0.6}
        names, ours = (*_BRICK, "offset", "squash"), {**inputs, "offset": 0.3, "squash": 1.4}
        yield "brick", (2, 3), "TexBrick", properties, inputs, names, _BOTH, ours
    for depth in (0, 2, 7, 10):
        inputs = {"Scale": 1.7, "Distortion": 0.8}
        properties = {"turbulence_depth": depth}
        yield "magic", (depth,), "TexMagic", properties, inputs, ("Vector", "Scale", "Distortion"), _BOTH


def _numbers():
    for number, name in enumerate(map(str.upper, table.MATH)):
        inputs, names = {"Value_001": 0.6, "Value_002": 0.25}, ("@Value", "Value_001", "Value_002")
        yield "math", (number,), "Math", {"operation": name}, inputs, names, {"Value": 0}
    for number, name in enumerate(map(str.upper, table.VECTOR_MATH[:27])):  # the others are newer
        inputs = {"Vector_001": (0.6, -1.2, 0.35), "Vector_002": (0.2, 0.9, -0.4), "Scale": 0.7}
        output = {"Value": 3} if name in ("DOT_PRODUCT", "DISTANCE", "LENGTH") else {"Vector": 0}
        yield "vector_math", (number,), "VectorMath", {"operation": name}, inputs, ("Vector", *inputs), output
    for number, name in enumerate(map(str.upper, table.BLENDS)):
        inputs = {"Factor_Float": 0.35, "B_Color": (0.2, 0.75, 0.4, 1)}
        properties = {"data_type": "RGBA", "blend_type": name}
        names = ("Factor_Float", "@A_Color", "B_Color")
        yield "mix_color", (number, 1), "Mix", properties, inputs, names, {"Result_Color": 0}
    for number, name in enumerate(("LINEAR", "STEPPED", "SMOOTHSTEP", "SMOOTHERSTEP")):
        inputs = {"From Min": -1.0, "From Max": 2.5, "To Min": 0.3, "To Max": -0.9, "Steps": 3.0}
        properties = {"interpolation_type": name, "clamp": number < 2}
        yield "map_range", (number, 1), "MapRange", properties, inputs, ("@Value", *inputs), {"Result": 0}
    for number, name in enumerate(("RGB", "HSV", "HSL")):
        inputs = {"Green": 0.6, "Blue": 0.45}
        yield "combine", (number,), "+CombineColor", {"mode": name}, inputs, ("@Red", *inputs), {"Color": 0}
        channels = {"Red": 0, "Green": 1, "Blue": 2}
        yield "separate", (number,), "+SeparateColor", {"mode": name}, {}, ("@Color",), channels


def socket(sockets, name):
    return next(s for s in sockets if s.identifier == name or (s.name == name and s.enabled))


def evaluated(idname, properties, inputs, names, outputs):
    """[points x components] of each output."""
    mesh = bpy.data.meshes.new("points")
    mesh.from_pydata(POINTS.tolist(), [], [])
    obj = bpy.data.objects.new("points", mesh)
    bpy.context.scene.collection.objects.link(obj)
    group = bpy.data.node_groups.new("group", "GeometryNodeTree")
    for way in ("INPUT", "OUTPUT"):
        if hasattr(group, "interface"):
            group.interface.new_socket("Geometry", in_out=way, socket_type="NodeSocketGeometry")
        else:
            (group.inputs if way == "INPUT" else group.outputs).new("NodeSocketGeometry", "Geometry")
    nodes, links = group.nodes, group.links
    node = nodes.new(f"FunctionNode{idname[1:]}" if idname[0] == "+" else f"ShaderNode{idname}")
    for name, value in properties.items():
        setattr(node, name, value)
    for name, value in inputs.items():
        socket(node.inputs, name).default_value = value
    place, apart = nodes.new("GeometryNodeInputPosition"), nodes.new("ShaderNodeSeparateXYZ")
    links.new(place.outputs[0], apart.inputs[0])
    for name in names:
        if name == "Vector" or name.startswith("@"):
            to = socket(node.inputs, name.lstrip("@"))
            links.new(apart.outputs[0] if to.type == "VALUE" else place.outputs[0], to)
    last = nodes.new("NodeGroupInput").outputs[0]
    for name in outputs:
        given = socket(node.outputs, name)
        keep = nodes.new("GeometryNodeStoreNamedAttribute")
        keep.data_type = "FLOAT" if given.type == "VALUE" else "FLOAT_VECTOR"
        keep.inputs["Name"].default_value = name
        links.new(last, keep.inputs[0])
        links.new(given, next(s for s in keep.inputs if s.enabled and s.name == "Value"))
        last = keep.outputs[0]
    links.new(last, nodes.new("NodeGroupOutput").inputs[0])
    obj.modifiers.new("nodes", "NODES").node_group = group
    shown = obj.evaluated_get(bpy.context.evaluated_depsgraph_get()).data
    found = {name: _values(shown.attributes[name]) for name in outputs}
    bpy.data.objects.remove(obj)
    return found


def _values(attribute):
    is_number = attribute.data_type == "FLOAT"
    values = np.empty(len(POINTS) * (1 if is_number else 3), np.float32)
    attribute.data.foreach_get("value" if is_number else "vector", values)
    return values.reshape(len(POINTS), -1)


def registers(point, names, inputs):
    """Values of the input registers of our operation."""
    found = []
    for name in names:
        if name in ("Vector", "@A_Color", "@Color"):
            found += point.tolist()
        elif name.startswith("@"):
            found.append(float(point[0]))
        else:
            value = inputs.get(name, _USUAL.get(name))
            found += list(value[:3]) if isinstance(value, tuple) else [value]
    return found


def _number(value):
    return repr(round(float(np.float32(value)), 9))


def main():
    rows = []
    for turn, (operation, choices, idname, properties, inputs, names, outputs, *ours) in enumerate(cases()):
        found, number = evaluated(idname, properties, inputs, names, outputs), turn % len(POINTS)
        given = ", ".join(map(_number, registers(POINTS[number], names, *(ours or [inputs]))))
        chosen = ", ".join(str(int(choice)) for choice in choices)
        start = f'{{"{bpy.app.version_string[:3]}", Operation::{operation}, {{{chosen}}}, {{{given}}}'
        for name, first in outputs.items():
            values = ", ".join(map(_number, found[name][number]))
            rows.append(f"{start}, {first}, {{{values}}}}},")
    with open(sys.argv[-1], "w") as file:
        file.write("\n".join(rows) + "\n")


main()
