"""Surfaces that glow, as lights."""

import math
import unittest

import bpy

from parity import stage
from parity.case import ALWAYS, NEVER, ParityTest, record
from parity.shaders import Tree, image
from support import level
from support.judge import judge_renders

SQUARE = [(-1, -1, 0), (1, -1, 0), (1, 1, 0), (-1, 1, 0)]


class Glow(ParityTest):
    """A ground with a box, lit by what glows above it."""

    def setUp(self):
        super().setUp()
        self.ground = stage.ground(12, 0.6)
        stage.box((-0.6, -0.4, 0), (0.2, 0.3, 0.9), 0.8)
        stage.camera((0, -6, 6), (0.78, 0, 0), 45)
        bpy.context.scene.world = None
        self.material = bpy.data.materials.new("Glow")
        self.tree = Tree(self.material)

    def _glow(self, color=(1, 0.7, 0.4), strength=8.0):
        self.tree.end(self.tree.emission(color, strength))

    def _square(self, location=(0.8, 0.6, 2.2), scale=0.5, rotation=(0, 0, 0)):
        obj = stage.mesh(SQUARE, [(0, 1, 2, 3)], self.material, "Square")
        layer = obj.data.uv_layers.new(name="UVMap")
        layer.data.foreach_set("uv", [0, 0, 1, 0, 1, 1, 0, 1])
        obj.location, obj.rotation_euler, obj.scale = location, rotation, (scale,) * 3
        return obj

    def test_square(self):
        self._glow()
        self._square()
        self.assert_parity("Glowing surface: square")

    def test_negative(self):
        stage.world((0.5, 0.5, 0.5))
        self._glow(strength=-2.0)
        self._square()
        self.assert_parity("Glowing surface: negative strength")

    def test_below_coat_and_sheen(self):
        """Since 4.0 they dim the emission of a Principled BSDF."""
        shader = self.tree.nodes.new("ShaderNodeBsdfPrincipled")
        if "Coat Weight" not in shader.inputs:
            self.skipTest("before 4.0 coat and sheen do not dim emission")
        shader.inputs["Emission Strength"].default_value = 5.0
        self.tree.end(shader.outputs[0])
        self._square(scale=1.2, rotation=(-0.6, 0, 0))
        for name in ("Coat", "Sheen"):
            with self.subTest(name):
                shader.inputs[f"{name} Weight"].default_value = 1.0
                self.assert_ignored(
                    f"Principled BSDF: emission below its {name.lower()}",
                    f"its {name.lower()} does not dim its emission",
                )
                shader.inputs[f"{name} Weight"].default_value = 0.0

    def test_bounce(self):
        scene = bpy.context.scene
        scene.velour.bounces = scene.cycles.max_bounces = scene.cycles.diffuse_bounces = 1
        self._glow()
        self._square()
        self.assert_parity("Glowing surface: one bounce")

    def test_turned(self):
        self._glow()
        self._square(rotation=(math.pi, 0, 0))
        self.assert_parity("Glowing surface: both sides")

    @unittest.skipUnless(level.LONG, level.REASON)
    def test_standing(self):
        """Near the square's plane older Cycles is darker than Lambert's formula, by up to a tenth."""
        self._glow()
        self._square((1.5, 0.5, 1), 0.9, (math.pi / 2, 0, 0.8))
        self.assert_approximate("Glowing surface: seen edge-on", 2, exact=((4, 0), NEVER))

    def test_picture(self):
        """Drawing rays, older Cycles is up to a tenth off from closed forms of the texels' light."""
        self._glow(self.tree.picture(image(6, 4)), self.tree.picture(image(8, 4, low=0, high=12)))
        self._square(scale=0.9).visible_camera = False
        samples = 2 if bpy.app.version >= (4, 0, 0) else 1
        self.assert_approximate("Glowing surface: image", 3, samples, exact=((4, 0), NEVER))
        ours = self.pictures("VELOUR", 2)
        self._leave_to_bounces()
        verdict = judge_renders(ours, self.pictures("CYCLES", 8))
        record("Glowing surface: image, Cycles' by bounces", verdict, "honored")
        self.assertTrue(verdict.agrees, str(verdict))

    def _leave_to_bounces(self):
        if hasattr(self.material.cycles, "sample_as_light"):
            self.material.cycles.sample_as_light = False
        else:
            self.material.cycles.emission_sampling = "NONE"  # 3.5 and newer

    def test_ball(self):
        self._glow(strength=20.0)
        bpy.ops.mesh.primitive_uv_sphere_add(segments=32, ring_count=16, radius=0.3, location=(1, 0.5, 1.5))
        bpy.context.object.data.materials.append(self.material)
        self.assert_parity("Glowing surface: sphere of 960 triangles", samples=6, up_to=0.5)

    def test_instances(self):
        self._glow(strength=20.0)
        first = self._square((-2, -1, 0.6), 0.1)
        for i in range(1, 12):
            copy = stage.link(first.copy())
            copy.location = (-2 + 1.3 * (i % 4), -1 + 1.2 * (i // 4), 0.6 + 0.1 * i)
        self.assert_parity("Glowing surface: instances", samples=2)

    def test_shear(self):
        self._glow()
        parent = stage.link(bpy.data.objects.new("Parent", None))
        parent.scale, parent.location = (1.8, 0.4, 1), (0.5, 0.5, 2)
        child = self._square((0, 0, 0), 0.5, (0.15, 0.1, 0.6))
        child.parent = parent
        child.visible_camera = False
        self.assert_parity("Glowing surface: sheared")

    def test_metal(self):
        tree = Tree(self.ground.data.materials[0])
        tree.end(tree.glossy(0.4))
        self._glow()
        self._square()
        self.assert_parity("Glowing surface: seen in rough metal", samples=4)

    def test_hidden_from_camera(self):
        self._glow()
        self._square((0, 0, 1.6)).visible_camera = False
        self.assert_parity("Glowing surface: hidden from the camera")

    def test_hidden_from_bounces(self):
        self._glow()
        hidden = self._square((0, 0, 1.6))
        hidden.visible_diffuse = hidden.visible_glossy = False
        self._square((-1.5, 0.5, 1.5), 0.3)
        self.assert_parity("Glowing surface: hidden from diffuse and glossy rays")

    def test_no_shadow(self):
        self._glow()
        self._square((0.3, 0.3, 1.6), 0.4).visible_shadow = False
        self._square((0.3, 0.3, 2.6), 0.6)
        self.assert_approximate("Glowing surface: casts no shadow", 3, exact=(ALWAYS, (4, 0)))

    def test_part(self):
        tree = self.tree
        glow = tree.add(tree.emission(strength=5.0), tree.transparent((0.3, 0.8, 0.6)))
        tree.end(tree.mix(tree.picture(image(4, 4)), glow, tree.diffuse()))
        self._square(scale=0.9)
        stage.lamp("AREA", 100, (0.5, 0.5, 4))
        self.assert_parity("Glowing surface: mixed, under a lamp")

    def test_principled(self):
        glow = {"Emission": (1, 0.5, 0.2, 1), "Emission_Strength": 8.0}
        principled = self.tree.node(
            "ShaderNodeBsdfPrincipled", Base_Color=(0, 0, 0, 1), Alpha=0.6, Specular=0.0, **glow
        )
        self.tree.end(principled)
        self._square()
        stage.world((0.6, 0.8, 1), 0.1)
        self.assert_parity("Glowing surface: Principled BSDF with alpha, under a sky")

    def test_not_drawn_to(self):
        self._leave_to_bounces()
        self._glow()
        self._square(scale=2)
        self.assert_parity("Glowing surface: no rays are drawn to it", samples=3)
