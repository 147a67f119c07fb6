"""The world by itself, for the scripts that run inside Blender: its picture in a mirror ball.

One small picture shows nearly all directions, whether the scene's camera sees the world or not.
"""

import math

import bpy
import inside

_SIZE, _SAMPLES = 64, 32


class MirrorBall:
    """A scene of its own with the world of another one."""

    def __init__(self, scene):
        self._source = scene
        self._scene = made = bpy.data.scenes.new("World by itself")
        inside.show_renders(made)
        made.render.engine = "VELOUR"
        made.render.resolution_x = made.render.resolution_y = _SIZE
        made.render.resolution_percentage = 100
        made.velour.samples, made.velour.split, made.velour.bounces = _SAMPLES, 1, 1
        made.view_layers[0].use_pass_normal = True  # otherwise Velour refuses a black world
        made.collection.objects.link(_ball())
        made.camera = _camera()
        made.collection.objects.link(made.camera)

    def render(self, path, frame, seed):
        self._scene.world = self._source.world
        self._scene.frame_set(frame)
        self._scene.velour.seed = seed
        inside.render(self._scene, path)


def _ball():
    mesh = bpy.data.meshes.new("Mirror ball")
    rings, segments = 32, 64
    points = [(0.0, 0.0, 1.0)]
    for ring in range(1, rings):
        theta = math.pi * ring / rings
        for segment in range(segments):
            phi = 2 * math.pi * segment / segments
            points.append((math.sin(theta) * math.cos(phi), math.sin(theta) * math.sin(phi), math.cos(theta)))
    points.append((0.0, 0.0, -1.0))
    faces = []
    for segment in range(segments):
        following = (segment + 1) % segments
        faces.append((0, 1 + segment, 1 + following))
        for ring in range(rings - 2):
            above = 1 + ring * segments
            below = above + segments
            faces.append((above + segment, below + segment, below + following, above + following))
        last = 1 + (rings - 2) * segments
        faces.append((last + segment, len(points) - 1, last + following))
    mesh.from_pydata(points, [], faces)
    mesh.polygons.foreach_set("use_smooth", [True] * len(faces))
    mesh.materials.append(_mirror())
    return bpy.data.objects.new("Mirror ball", mesh)


def _mirror():
    material = bpy.data.materials.new("Mirror")
    material.use_nodes = True
    tree = material.node_tree
    tree.nodes.clear()
    shader, output = (tree.nodes.new(f"ShaderNode{kind}") for kind in ("BsdfGlossy", "OutputMaterial"))
    shader.inputs["Color"].default_value = (1, 1, 1, 1)
    shader.inputs["Roughness"].default_value = 0.0
    tree.links.new(shader.outputs[0], output.inputs["Surface"])
    return material


def _camera():
    data = bpy.data.cameras.new("Mirror ball")
    data.type, data.ortho_scale = "ORTHO", 2.0
    camera = bpy.data.objects.new("Mirror ball's camera", data)
    camera.location, camera.rotation_euler = (0, -5, 0), (math.pi / 2, 0, 0)
    return camera
