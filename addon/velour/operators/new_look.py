"""A scene to look at a material: a ball on a turntable in a studio, ready to render."""

import math

import bpy
import numpy as np
from bpy.props import StringProperty
from mathutils import Vector

from ..core import presets
from ..core.ball import ball_mesh, studio
from ..native import VelourError
from . import add_preset
from .approximate import approximate_new

NAME = "Velour Look"
_TURN_FRAMES = 120
_SIDE = 1024  # pixels
_STUDIO_ROWS = 512
_GROUND = 0.18  # albedo
_LENS = 85.0  # millimeters
_EYE = Vector((0.0, -7.5, 2.6))
_TARGET = Vector((0.0, 0.0, 0.95))


class VELOUR_OT_new_look(bpy.types.Operator):
    bl_idname = "velour.new_look"
    bl_label = NAME
    bl_description = "Add a scene with a ball on a turntable, a studio and a camera, to judge materials in"
    bl_options = {"REGISTER", "UNDO"}

    preset: StringProperty(
        name="Preset", description="Preset material of the ball. Empty: the first one", options={"SKIP_SAVE"}
    )

    def execute(self, context):
        try:
            material, info = self._material()
        except (OSError, ValueError, VelourError) as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        scene = bpy.data.scenes.new(NAME)
        _set_up(scene)
        ball = _ball(scene, material)
        _ground(scene)
        _camera(scene)
        scene.world = _world()
        window = context.window
        if window is not None:
            window.scene = scene
        view_layer = scene.view_layers[0]
        view_layer.objects.active = ball
        ball.select_set(True, view_layer=view_layer)
        if material is not None:
            approximate_new(context, material, info)
        return {"FINISHED"}

    def _material(self):
        """Material of the ball and info of its model; None for both without presets."""
        listed = presets.listed()
        if self.preset:
            return add_preset.make(add_preset.find(self.preset), self.report)
        return add_preset.make(listed[0], self.report) if listed else (None, None)


def _set_up(scene):
    render = scene.render
    render.engine = "VELOUR"
    render.resolution_x = render.resolution_y = _SIDE
    render.resolution_percentage = 100
    scene.frame_start, scene.frame_end = 1, _TURN_FRAMES
    settings = scene.velour
    settings.samples, settings.use_noise_target, settings.noise_target = 2048, True, 0.02


def _ball(scene, material):
    """The ball, as a child of the turntable."""
    turntable = bpy.data.objects.new("Turntable", None)
    turntable.empty_display_type = "CIRCLE"
    turntable.empty_display_size = 1.4
    for frame, angle in ((1, 0.0), (1 + _TURN_FRAMES, 2 * math.pi)):
        turntable.rotation_euler[2] = angle
        turntable.keyframe_insert("rotation_euler", index=2, frame=frame)
    for curve in _curves(turntable.animation_data.action):
        for key in curve.keyframe_points:
            key.interpolation = "LINEAR"
    ball = bpy.data.objects.new("Ball", _mesh())
    ball.parent, ball.location = turntable, (0, 0, 1)
    if material is not None:
        ball.data.materials.append(material)
    scene.collection.objects.link(turntable)
    scene.collection.objects.link(ball)
    return ball


def _curves(action):
    """F-curves of an action with one slot; Blender 5 keeps them in channel bags."""
    if hasattr(action, "fcurves"):
        return action.fcurves
    return [
        curve
        for layer in action.layers
        for strip in layer.strips
        for bag in strip.channelbags
        for curve in bag.fcurves
    ]


def _mesh():
    arrays = ball_mesh()
    mesh = bpy.data.meshes.new("Ball")
    mesh.from_pydata(arrays["positions"].tolist(), [], arrays["triangles"].tolist())
    uvs = arrays["corner_uvs"].reshape(-1, 2)
    # The ball counts tiles; here the texture coordinates run from 0 to 1 around and from pole to pole.
    mesh.uv_layers.new(name="UVMap").data.foreach_set("uv", (uvs / uvs.max(axis=0)).ravel())
    mesh.polygons.foreach_set("use_smooth", np.ones(len(mesh.polygons), bool))
    mesh.update()
    return mesh


def _ground(scene):
    mesh = bpy.data.meshes.new("Ground")
    side = 40.0
    corners = [(x * side, y * side, 0.0) for x, y in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
    mesh.from_pydata(corners, [], [(0, 1, 2, 3)])
    material = bpy.data.materials.new("Ground")
    if material.node_tree is None:
        material.use_nodes = True
    shader = next(node for node in material.node_tree.nodes if node.bl_idname == "ShaderNodeBsdfPrincipled")
    shader.inputs["Base Color"].default_value = (_GROUND, _GROUND, _GROUND, 1.0)
    shader.inputs["Roughness"].default_value = 0.7
    mesh.materials.append(material)
    scene.collection.objects.link(bpy.data.objects.new("Ground", mesh))


def _camera(scene):
    camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
    camera.location = _EYE
    camera.rotation_euler = (_TARGET - _EYE).to_track_quat("-Z", "Y").to_euler()
    camera.data.lens = _LENS
    scene.collection.objects.link(camera)
    scene.camera = camera


def _world():
    """A world of the studio's picture, packed into the file."""
    pixels = studio(_STUDIO_ROWS)
    image = bpy.data.images.new("Velour Studio", pixels.shape[1], pixels.shape[0], float_buffer=True)
    opaque = np.concatenate([pixels[::-1], np.ones((*pixels.shape[:2], 1), np.float32)], axis=-1)
    image.pixels.foreach_set(opaque.ravel())
    image.update()
    image.pack()
    world = bpy.data.worlds.new("Velour Studio")
    if world.node_tree is None:
        world.use_nodes = True
    nodes = world.node_tree.nodes
    background = next(node for node in nodes if node.bl_idname == "ShaderNodeBackground")
    picture = nodes.new("ShaderNodeTexEnvironment")
    picture.image, picture.location = image, (background.location[0] - 300, background.location[1])
    world.node_tree.links.new(picture.outputs["Color"], background.inputs["Color"])
    return world
