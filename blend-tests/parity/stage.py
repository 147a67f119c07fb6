"""Gray diffuse things to look at."""

import bpy
import numpy as np

from support import scenes


def link(obj):
    bpy.context.scene.collection.objects.link(obj)
    return obj


def without_terminator(obj):
    """Keeps Cycles from moving shadow rays off smooth surfaces, which lets light through their rim."""
    # A property of the object itself since Blender 5.0, where the older one still exists but has no effect.
    (
        obj if hasattr(obj, "shadow_terminator_geometry_offset") else obj.cycles
    ).shadow_terminator_geometry_offset = 0.0
    return obj


def gray(albedo):
    return scenes.diffuse_material((albedo,) * 3, f"Gray {albedo:g}")


def mesh(points, faces, material, name="Mesh", smooth=False):
    data = bpy.data.meshes.new(name)
    data.from_pydata([tuple(p) for p in points], [], faces)
    data.polygons.foreach_set("use_smooth", [smooth] * len(data.polygons))
    data.materials.append(material)
    return without_terminator(link(bpy.data.objects.new(name, data)))


def ground(size=20.0, albedo=0.5):
    half = size / 2
    corners = [(-half, -half, 0), (half, -half, 0), (half, half, 0), (-half, half, 0)]
    return mesh(corners, [(0, 1, 2, 3)], gray(albedo), "Ground")


def box(low, high, albedo):
    corners = [(x, y, z) for z in (low[2], high[2]) for y in (low[1], high[1]) for x in (low[0], high[0])]
    faces = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
    return mesh(corners, faces, gray(albedo), "Box")


def town(count=6, spacing=1.0):
    """Boxes of many heights and grays on a ground: edges in every block of a picture."""
    random = np.random.default_rng(1)
    ground()
    half = (count - 1) / 2
    for i in range(count):
        for j in range(count):
            x, y = (i - half) * spacing, (j - half) * spacing
            side, height = random.uniform(0.2, 0.4, 2)
            box((x - side, y - side, 0), (x + side, y + side, 3 * height), round(random.uniform(0.1, 0.9), 2))


def sphere(radius=1.0, albedo=0.7, segments=16, rings=8, smooth=True):
    bpy.ops.mesh.primitive_uv_sphere_add(segments=segments, ring_count=rings, radius=radius)
    obj = bpy.context.object
    obj.data.polygons.foreach_set("use_smooth", [smooth] * len(obj.data.polygons))
    obj.data.materials.append(gray(albedo))
    return without_terminator(obj)


def twin(obj):
    """A second user of the mesh, behind the camera: else Cycles interpolates normals in world space."""
    link(obj.copy()).location.y = -30


def camera(location=(5, -7, 5), rotation=(1.05, 0, 0.61), lens=50.0):
    data = bpy.data.cameras.new("Camera")
    data.lens = lens
    obj = link(bpy.data.objects.new("Camera", data))
    obj.location, obj.rotation_euler = location, rotation
    bpy.context.scene.camera = obj
    return obj


def shear(obj, scale, rotation=(0, 0, 0)):
    """By an unevenly scaled parent: axes of what is turned within it are no longer perpendicular."""
    parent = link(bpy.data.objects.new("Rig", None))
    parent.scale, parent.rotation_euler = scale, rotation
    obj.parent = parent
    return obj


def lamp(kind, energy, location=(0, 0, 3), rotation=(0, 0, 0), **settings):
    data = bpy.data.lights.new("Lamp", kind)
    data.energy = energy
    for name, value in settings.items():
        setattr(data, name, value)
    obj = link(bpy.data.objects.new("Lamp", data))
    obj.location, obj.rotation_euler = location, rotation
    return obj


def world(color=(1, 1, 1), strength=1.0):
    """A world whose importance map is built at once."""
    made = scenes.set_world(color, strength)
    made.cycles.sampling_method, made.cycles.sample_map_resolution = "MANUAL", 64
    return made


def sharp_sun(energy=3.0):
    return lamp("SUN", energy, rotation=(0.5, 0.3, 0.2), angle=0.0)
