"""Presets of Velour on sculptures and draped cloth, in the studio of the look scene."""

import math

import bpy
import numpy as np

from . import scene as build

_BOUNCES = 6
_CLOTH_CELLS = 150  # along a side
_CLOTH_FRAMES = 70


def main(task):
    """Renders one scene as NAME.png into the folder; returns the engine's report."""
    scene = build.empty(task["size"], task["samples"], _BOUNCES)
    scene.view_settings.view_transform = _display_transform(scene)
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


def _display_transform(scene):
    names = scene.view_settings.bl_rna.properties["view_transform"].enum_items.keys()
    return next(name for name in ("AgX", "Filmic", "Standard") if name in names)


def metals():
    """Metals and paints on sculptures."""
    _ground()
    _dress(_monkey((0.0, 0.1, 0.0), 1.25, -14), "Midnight Car Paint")
    _dress(_knot((-2.35, 0.35, 0.0), 0.62), "Polished Gold")
    _dress(_ball((2.2, 0.5, 0.0), 0.85), "Brushed Aluminium")
    _dress(_ball((-1.05, -1.5, 0.0), 0.42), "Red Enamel")
    _dress(_knot((1.25, -1.45, 0.0), 0.34, turn=70), "Satin Copper")
    _dress(_ball((3.35, -0.75, 0.0), 0.5), "Glazed Porcelain")
    _dress(_ball((-3.3, -0.85, 0.0), 0.45), "Brushed Brass")
    build.camera((0.15, -8.4, 2.5), (0.05, 0, 0.72), lens=62)


def cloths():
    """Cloths draped over balls and a block."""
    _ground()
    places = ((-2.5, 0.3, "Denim"), (0.0, -0.1, "Crimson Velvet"), (2.5, 0.3, "Knitted Wool"))
    for x, y, preset in places:
        form = _ball((x, y, 0.0), 0.72) if preset != "Crimson Velvet" else _pedestal((x, y, 0.0))
        _dress(_draped(form, side=2.7), preset)
    build.camera((0, -8.6, 3.0), (0, 0, 0.55), lens=58)


SCENES = {"metals": metals, "cloths": cloths}


def _dress(obj, preset):
    bpy.ops.velour.add_preset(preset=preset, object=obj.name)


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
    along, around, thickness = 480, 48, 0.36
    t = np.linspace(0, 2 * math.pi, along, endpoint=False)

    def line(t):
        return np.stack(
            [np.sin(t) + 2 * np.sin(2 * t), 0.9 * np.sin(3 * t), np.cos(t) - 2 * np.cos(2 * t)], axis=-1
        )

    tangent = line(t + 1e-4) - line(t - 1e-4)
    tangent /= np.linalg.norm(tangent, axis=-1, keepdims=True)
    # A frame without twist would not close; one about a fixed axis does, and the knot never runs along it.
    side = np.cross(tangent, (0.0, 1.0, 0.0))
    side /= np.linalg.norm(side, axis=-1, keepdims=True)
    up = np.cross(side, tangent)
    phi = np.linspace(0, 2 * math.pi, around, endpoint=False)
    circle = np.cos(phi)[None, :, None] * side[:, None] + np.sin(phi)[None, :, None] * up[:, None]
    points = size * (line(t)[:, None] + thickness * circle).reshape(-1, 3)
    faces = [
        (
            i * around + j,
            i * around + (j + 1) % around,
            (i + 1) % along * around + (j + 1) % around,
            (i + 1) % along * around + j,
        )
        for i in range(along)
        for j in range(around)
    ]
    obj = _smooth_object("Knot", (points - [0, 0, points[:, 2].min()]).tolist(), faces)
    layer = obj.data.uv_layers.new(name="UVMap")
    corners = [((i + di) / along, (j + dj) / around) for i in range(along) for j in range(around)
               for di, dj in ((0, 0), (0, 1), (1, 1), (1, 0))]  # fmt: skip
    layer.data.foreach_set("uv", np.array(corners, np.float32).ravel())
    obj.location, obj.rotation_euler = place, (0, 0, math.radians(turn))
    return obj


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
    settings.collision_settings.self_distance_min = 0.01
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
