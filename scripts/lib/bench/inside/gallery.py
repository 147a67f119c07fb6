"""Presets of Velour on sculptures and draped cloth, in the studio of the look scene."""

import math

import bpy
import numpy as np

from . import scene as build

_BOUNCES = 6
_CLOTH_CELLS = 110  # along a side
_CLOTH_FRAMES = 70


def main(task):
    """Renders one scene as NAME.png into the folder; returns the engine's report."""
    scene = build.empty(task["size"], task["samples"], _BOUNCES)
    _set_display_transform(scene.view_settings)
    scene.velour.use_noise_target, scene.velour.noise_target = True, task["noise"]
    scene.velour.use_denoising = True
    before = set(bpy.data.scenes)
    bpy.ops.velour.new_look()
    (studio,) = set(bpy.data.scenes) - before
    scene.world = studio.world
    bpy.context.window.scene = scene
    bpy.data.scenes.remove(studio)
    SCENES[task["scene"]]()
    return build.render(task["folder"], task["name"])


def _set_display_transform(settings):
    """The first that this Blender has: its list of them is made at run time, and cannot be asked for."""
    for name in ("AgX", "Filmic"):
        try:
            settings.view_transform = name
            return
        except TypeError:
            continue


def metals():
    """Metals and paints on sculptures."""
    _ground()
    _dress(_monkey((0.0, 0.1, 0.0), 1.25, -14), "Midnight Car Paint")
    _dress(_knot((-2.35, 0.55, 0.0), 0.43), "Polished Gold")
    _dress(_ball((2.2, 0.5, 0.0), 0.85), "Brushed Aluminum")
    _dress(_ball((-1.05, -1.5, 0.0), 0.42), "Red Enamel")
    _dress(_knot((1.25, -1.45, 0.0), 0.34, turn=70), "Satin Copper")
    _dress(_ball((3.35, -0.75, 0.0), 0.5), "Glazed Porcelain")
    _dress(_ball((-3.3, -0.85, 0.0), 0.45), "Brushed Brass")
    build.camera((0.15, -8.4, 2.5), (0.05, 0, 0.78), lens=36)


def cloths():
    """Cloths draped over balls and a block."""
    _ground()
    places = ((-2.3, 0.3, "Denim"), (0.0, -0.1, "Crimson Velvet"), (2.3, 0.3, "Knitted Wool"))
    for x, y, preset in places:
        form = _ball((x, y, 0.0), 0.72) if preset != "Crimson Velvet" else _pedestal((x, y, 0.0))
        _dress(_draped(form, side=3.5), preset)
    build.camera((0, -8.6, 3.0), (0, 0, 0.45), lens=46)


def product():
    """A flask and a cup of enamel, worn to the metal: measured materials that nodes mix."""
    _ground()
    _dress(_flat_cloth((0.35, -0.35, 0.006), (3.6, 2.3), 14), "Linen")
    flask, cup = (-0.75, 0.1, 0.02), (0.85, -0.35, 0.02)
    body = [(0.0, 0.0), (0.5, 0.0), (0.5, 1.5), (0.3, 1.86), (0.3, 2.0), (0.0, 2.0)]
    _worn(_turned("Flask", body, flask, 0.07), "Red Enamel", "Brushed Aluminum", "Z", (1.42, 1.9))
    sleeve = [(0.49, 0.28), (0.535, 0.28), (0.535, 1.02), (0.49, 1.02)]
    _dress(_turned("Sleeve", sleeve, flask, 0.02), "Brown Leather")
    lid = [(0.0, 1.98), (0.35, 1.98), (0.35, 2.26), (0.0, 2.26)]
    _dress(_turned("Lid", lid, flask, 0.04), "Brushed Brass")
    outside = [(0.0, 0.0), (0.42, 0.0), (0.46, 0.78), (0.44, 0.78), (0.4, 0.05), (0.0, 0.05)]
    handle = [(0.42 + 0.27 * math.sin(a), 0.0, 0.4 - 0.25 * math.cos(a)) for a in np.linspace(0.1, 3.04, 60)]
    for part in (_turned("Cup", outside, cup, 0.03), _tube("Handle", np.array(handle), 0.045)):
        part.location = cup
        part.rotation_euler[2] = math.radians(-35)
        _worn(part, "Glazed Porcelain", "Cast Iron", "Z", (0.66, 0.84))
    build.camera((0.5, -7.4, 2.7), (0.1, 0, 1.02), lens=54)


SCENES = {"metals": metals, "cloths": cloths, "product": product}


def _dress(obj, preset):
    bpy.ops.velour.add_preset(preset=preset, object=obj.name)


def _worn(obj, coat, metal, axis, edge):
    """A mix of two presets: the metal shows in spots, and more of it along an edge (from, to) of an axis."""
    bpy.ops.velour.add_preset(preset=metal, assign=False)
    below = build.measured_node(bpy.data.materials[metal]).group.node_tree
    _dress(obj, coat)
    material = obj.data.materials[0]
    tree, shown = material.node_tree, build.measured_node(material).group

    def node(kind, inputs, **settings):
        made = tree.nodes.new(f"ShaderNode{kind}")
        for name, value in settings.items():
            setattr(made, name, value)
        for name, value in inputs.items():
            if isinstance(value, bpy.types.NodeSocket):
                tree.links.new(value, made.inputs[name])
            else:
                made.inputs[name].default_value = value
        return made.outputs[0]

    place = tree.nodes.new("ShaderNodeTexCoord").outputs["Object"]
    spots = node("TexNoise", {"Vector": place, "Scale": 5.5, "Detail": 9.0, "Roughness": 0.62})
    along = tree.nodes[node("SeparateXYZ", {"Vector": place}).node.name].outputs[axis]
    near = node("MapRange", {"Value": along, "From Min": edge[0], "From Max": edge[1], "To Max": 0.2})
    bare = node("MapRange", {0: node("Math", {0: spots, 1: near}), "From Min": 0.645, "From Max": 0.665})
    second = tree.nodes.new("ShaderNodeGroup")
    second.node_tree = below
    mixed = node("MixShader", {0: bare, 1: shown.outputs[0], 2: second.outputs[0]})
    tree.links.new(mixed, tree.nodes["Material Output"].inputs["Surface"])


def _ground():
    """A floor that curves up into a backdrop."""
    profile = [(-14.0, 0.0), (5.0, 0.0)]
    profile += [(5 + 3 * math.sin(a), 3 - 3 * math.cos(a)) for a in np.linspace(0.1, math.pi / 2, 16)]
    profile += [(8.0, 12.0)]
    points = [(x, y, z) for y, z in profile for x in (-30.0, 30.0)]
    faces = [(2 * i, 2 * i + 1, 2 * i + 3, 2 * i + 2) for i in range(len(profile) - 1)]
    ground = _smooth_object("Ground", points, faces)
    material = build.material("Ground", Base_Color=(0.28, 0.27, 0.26), Roughness=0.55)
    ground.data.materials.append(material)


def _smooth_object(name, points, faces):
    obj = build.polygons(name, points, faces)
    obj.data.polygons.foreach_set("use_smooth", np.ones(len(obj.data.polygons), bool))
    obj.data.update()
    return obj


def _ball(place, radius):
    """A ball that stands at a place of the floor."""
    return build.ball((place[0], place[1], place[2] + radius), radius, segments=128)


def _pedestal(place):
    x, y, z = place
    bpy.ops.mesh.primitive_cube_add(size=1.0, location=(x, y, z + 0.62))
    obj = bpy.context.object
    obj.scale = (0.95, 0.95, 1.24)
    bevel = obj.modifiers.new("Bevel", "BEVEL")
    bevel.width, bevel.segments = 0.08, 5
    return obj


def _monkey(place, size, turn):
    obj = build.monkey(2 * size, (-24, turn))
    obj.location = place
    return build.set_down(obj)


def _knot(place, size, turn=20):
    """A trefoil knot of a round tube, standing on the floor."""
    t = np.linspace(0, 2 * math.pi, 480, endpoint=False)
    line = np.stack(
        [np.sin(t) + 2 * np.sin(2 * t), 0.9 * np.sin(3 * t), np.cos(t) - 2 * np.cos(2 * t)], axis=-1
    )
    line[:, 2] -= line[:, 2].min() - 0.36
    obj = _tube("Knot", size * line, 0.36 * size, is_closed=True)
    obj.location, obj.rotation_euler = place, (0, 0, math.radians(turn))
    return build.set_down(obj)


def _tube(name, line, radius, is_closed=False):
    """A round tube about the points `line` [n x 3], which never runs along y."""
    around = 48
    tangent = np.roll(line, -1, 0) - np.roll(line, 1, 0) if is_closed else np.gradient(line, axis=0)
    tangent /= np.linalg.norm(tangent, axis=-1, keepdims=True)
    # A frame without twist would not close; one about a fixed axis does.
    side = np.cross(tangent, (0.0, 1.0, 0.0))
    side /= np.linalg.norm(side, axis=-1, keepdims=True)
    phi = np.linspace(0, 2 * math.pi, around, endpoint=False)[None, :, None]
    rings = line[:, None] + radius * (
        np.cos(phi) * side[:, None] + np.sin(phi) * np.cross(tangent, side)[:, None]
    )
    return _of_rings(name, rings, np.arange(len(line) + 1) / len(line), is_closed)


def _turned(name, profile, place, rounding):
    """The surface that a line (radius, height) sweeps about z; its corners are rounded within `rounding`."""
    corners = np.array(profile)
    line = [corners[0]]
    for before, at, after in zip(corners[:-2], corners[1:-1], corners[2:], strict=True):
        ends = [at + (end - at) * min(rounding / np.linalg.norm(end - at), 0.5) for end in (before, after)]
        t = np.linspace(0, 1, 9)[:, None]
        line.extend((1 - t) ** 2 * ends[0] + 2 * t * (1 - t) * at + t**2 * ends[1])
    line = np.array([*line, corners[-1]])
    phi = np.linspace(0, 2 * math.pi, 192, endpoint=False)
    flat = np.stack([np.cos(phi), np.sin(phi)], axis=-1)
    rings = np.concatenate(
        [line[:, None, :1] * flat[None], np.broadcast_to(line[:, None, 1:], (len(line), len(phi), 1))],
        axis=-1,
    )
    length = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(line, axis=0), axis=-1))])
    obj = _of_rings(name, rings, length / (2 * math.pi * line[:, 0].max()), False)
    obj.location = place
    return obj


def _of_rings(name, rings, v, is_closed):
    """A smooth surface through rings [n x around x 3]; `v`: texture coordinate of each; u runs around."""
    count, around = rings.shape[:2]
    cells = [(i, j) for i in range(count if is_closed else count - 1) for j in range(around)]
    corners = ((0, 0), (0, 1), (1, 1), (1, 0))
    faces = [tuple((i + di) % count * around + (j + dj) % around for di, dj in corners) for i, j in cells]
    obj = _smooth_object(name, rings.reshape(-1, 3).tolist(), faces)
    coordinates = [((j + dj) / around, v[i + di]) for i, j in cells for di, dj in corners]
    layer = obj.data.uv_layers.new(name="UVMap")
    layer.data.foreach_set("uv", np.array(coordinates, np.float32).ravel())
    return obj


def _flat_cloth(place, size, turn):
    """A cloth that lies on the floor, with a few folds."""
    bpy.ops.mesh.primitive_grid_add(x_subdivisions=240, y_subdivisions=160, size=1.0, location=place)
    cloth = bpy.context.object
    points = np.zeros(3 * len(cloth.data.vertices), np.float32)
    cloth.data.vertices.foreach_get("co", points)
    x, y, z = points.reshape(-1, 3).T
    z += 0.012 * (1 + np.sin(9 * x + 3 * np.sin(4 * y)) * np.cos(5 * y + 2 * x)) * (0.3 + np.abs(x + y))
    cloth.data.vertices.foreach_set("co", np.stack([size[0] * x, size[1] * y, z], axis=-1).ravel())
    cloth.rotation_euler[2] = math.radians(turn)
    bpy.ops.object.shade_smooth()
    return cloth


def _draped(form, side):
    """A square of cloth that Blender's simulation drops over `form` and the floor; the form stays below."""
    form.modifiers.new("Collision", "COLLISION")
    form.collision.thickness_outer = 0.015
    floor = bpy.data.objects["Ground"]
    if "Collision" not in floor.modifiers:
        floor.modifiers.new("Collision", "COLLISION")
    top = form.location.z * 2 + 0.12
    bpy.ops.mesh.primitive_grid_add(
        x_subdivisions=_CLOTH_CELLS, y_subdivisions=_CLOTH_CELLS, size=side,
        location=(form.location.x, form.location.y, top), rotation=(0, 0, math.radians(20)),
    )  # fmt: skip
    cloth = bpy.context.object
    settings = cloth.modifiers.new("Cloth", "CLOTH")
    settings.settings.quality = 6
    settings.settings.mass = 0.25
    settings.settings.bending_stiffness = 0.08
    settings.collision_settings.distance_min = 0.012
    settings.collision_settings.use_self_collision = True
    settings.collision_settings.self_distance_min = 0.012
    settings.point_cache.frame_end = _CLOTH_FRAMES
    scene = bpy.context.scene
    for frame in range(1, _CLOTH_FRAMES + 1):
        scene.frame_set(frame)
    depsgraph = bpy.context.evaluated_depsgraph_get()
    fallen = bpy.data.meshes.new_from_object(cloth.evaluated_get(depsgraph))
    cloth.modifiers.clear()
    cloth.data = fallen
    bpy.context.view_layer.objects.active = cloth
    smooth = cloth.modifiers.new("Smooth", "SUBSURF")
    smooth.levels = smooth.render_levels = 1
    bpy.ops.object.shade_smooth()
    form.modifiers.remove(form.modifiers["Collision"])
    scene.frame_set(1)
    return cloth
