"""Pictures of worlds lie where Cycles shows them, and those of a sequence come when they do there."""

import math

import addon_utils
import bpy
import numpy as np
from mathutils import Euler

from support import inputs, scenes
from support.blender import BlenderTest


class World(BlenderTest):
    def _environment(self, rotation=(0, 0, 0), kind="POINT"):
        """Dark but for one bright spot, seen by the camera looking along +y."""
        image = bpy.data.images.new("sky", 64, 32, float_buffer=True)
        pixels = np.zeros((32, 64, 4), np.float32)
        pixels[20:22, 40:42] = 10.0  # right of the center, above the horizon
        image.pixels.foreach_set(pixels.ravel())
        image.pack()
        tree = scenes.set_world().node_tree
        node, mapping = tree.nodes.new("ShaderNodeTexEnvironment"), tree.nodes.new("ShaderNodeMapping")
        coordinates = tree.nodes.new("ShaderNodeTexCoord")
        node.image, mapping.vector_type = image, kind
        mapping.inputs["Rotation"].default_value = rotation
        tree.links.new(coordinates.outputs["Generated"], mapping.inputs["Vector"])
        tree.links.new(mapping.outputs[0], node.inputs["Vector"])
        tree.links.new(node.outputs[0], tree.nodes["Background"].inputs["Color"])

    def test_image_sequences(self):
        """The file that a frame shows is that of Cycles: first frame, offset, and over again."""
        addon_utils.enable("cycles")
        node = self._sequence((0.1, 0.3, 0.6, 1.0))
        user, shown = node.image_user, []
        user.frame_duration = 3
        for start, offset, cyclic, frame in (
            *((1, 0, False, 1), (1, 0, False, 9)),
            *((4, 1, True, 3), (4, 1, True, 7)),
        ):
            user.frame_start, user.frame_offset, user.use_cyclic = start, offset, cyclic
            bpy.context.scene.frame_set(frame)
            ours, theirs = (self._level(engine) for engine in ("VELOUR", "CYCLES"))
            self.assert_close(ours, theirs, 1e-3)
            shown.append(round(ours, 1))
        self.assertEqual(shown, [0.1, 0.6, 1.0, 0.3])

    def _sequence(self, levels):
        """The node of a world whose files are of one gray each."""
        for number, level in enumerate(levels, 1):
            path = self.folder / f"sky_{number:03}.exr"
            inputs.native().images.write(path, np.full((4, 8, 3), level, np.float32))
        tree = scenes.set_world().node_tree
        node = tree.nodes.new("ShaderNodeTexEnvironment")
        node.image = bpy.data.images.load(str(self.folder / "sky_001.exr"))
        node.image.source = "SEQUENCE"
        tree.links.new(node.outputs[0], tree.nodes["Background"].inputs["Color"])
        scenes.add_camera()
        return node

    def _level(self, engine):
        scene = scenes.use_engine(samples=1, size=4)
        scene.render.engine = engine
        scene.cycles.samples, scene.cycles.use_denoising = 1, False
        scene.world.cycles.sampling_method = "NONE"  # its importance map alone would take seconds
        return float(scenes.render(self.folder, engine)[..., 1].mean())

    def _bright_direction(self, engine):
        """Where the spot is seen: the brightest of six looks, and its center there."""
        scene = scenes.use_engine(samples=16, size=48)
        scene.render.engine = engine
        if engine == "CYCLES":
            scene.cycles.samples, scene.cycles.use_denoising = 16, False
            scene.world.cycles.sampling_method = "NONE"  # its importance map alone would take seconds
        camera = scenes.add_camera()
        camera.location, camera.data.lens_unit, camera.data.angle = (0, 0, 0), "FOV", math.radians(100)
        best = None
        for turn in range(4):
            camera.rotation_euler = Euler((math.pi / 2, 0, turn * math.pi / 2))
            weight = scenes.render(self.folder, f"{engine}{turn}")[..., 1]
            if best is None or weight.sum() > best[1].sum():
                best = turn, weight
        turn, weight = best
        self.assertGreater(weight.max(), 1.0)
        y, x = np.unravel_index(np.argsort(weight.ravel())[-4:], weight.shape)
        return turn, x.mean(), y.mean()

    def test_against_cycles(self):
        addon_utils.enable("cycles")
        for rotation, kind in (
            ((0, 0, 0), "POINT"),
            ((0.2, -0.3, 1.0), "POINT"),
            ((0.2, -0.3, 1.0), "TEXTURE"),
        ):
            with self.subTest(rotation=rotation, kind=kind):
                bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
                self._environment(rotation, kind)
                ours, theirs = self._bright_direction("VELOUR"), self._bright_direction("CYCLES")
                self.assertEqual(ours[0], theirs[0])
                np.testing.assert_allclose(ours[1:], theirs[1:], atol=1.5)
