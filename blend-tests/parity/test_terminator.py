"""Smooth shading on coarse meshes under light that comes in flat: no steps where Cycles has none."""

import math

import bpy
import numpy as np

from parity import stage
from parity.case import ParityTest
from parity.shaders import Tree
from support import scenes

OFFSET = "shadow_terminator_geometry_offset"


class Terminator(ParityTest):
    def setUp(self):
        super().setUp()
        stage.camera((0, -6, 0), (math.pi / 2, 0, 0), 60)
        stage.lamp("SUN", 3.0, rotation=(0.3, math.radians(75), 0), angle=0.0)

    def _ball(self, segments, offset=0.1):
        ball = stage.sphere(1.0, 0.8, segments, segments // 2)
        setattr(ball if hasattr(ball, OFFSET) else ball.cycles, OFFSET, offset)
        return ball

    def test_coarse(self):
        self._ball(12)
        self.assert_parity("Shadow terminator: ball of 12 segments", up_to=0.3)

    def test_fine(self):
        self._ball(24)
        self.assert_parity("Shadow terminator: ball of 24 segments")

    def test_wide(self):
        self._ball(16, 0.4)
        self.assert_parity("Shadow terminator: offset 0.4", up_to=0.3)

    def test_scaled(self):
        """Cycles takes the height over the triangle from the unscaled object."""
        self._ball(16, 0.4).scale = (1.2, 0.8, 1.0)
        self.assert_approximate("Shadow terminator: offset 0.4, scaled", 2)

    def test_no_steps(self):
        """Along the equator light falls once, from the lit limb to the dark one, as in Cycles."""
        self._ball(12)
        scene = scenes.use_engine(samples=64, size=96)
        variations = {}
        for engine in ("VELOUR", "CYCLES"):
            scene.render.engine = engine
            if engine == "CYCLES":
                scene.cycles.samples, scene.cycles.use_denoising, scene.cycles.max_bounces = 64, False, 0
            row = scenes.render(self.folder, engine)[..., 1][48]
            variations[engine] = np.abs(np.diff(row[row > 0])).sum()
        self.assertLess(variations["VELOUR"], 1.2 * variations["CYCLES"])
        bpy.context.scene.render.engine = "VELOUR"


class SmoothEdges(ParityTest):
    """A cylinder with smooth caps: at its edges, normals are 45 degrees from those of the faces."""

    def setUp(self):
        super().setUp()
        stage.camera((3, -4, 2.5), (1.1, 0, math.atan2(3, 4)), 60)
        stage.sharp_sun()
        stage.world((0.5, 0.6, 0.8))
        bpy.ops.mesh.primitive_cylinder_add(vertices=16, radius=0.8)
        self.cylinder = bpy.context.object
        mesh = self.cylinder.data
        mesh.polygons.foreach_set("use_smooth", [True] * len(mesh.polygons))
        mesh.materials.append(bpy.data.materials.new("Smooth"))
        self.tree = Tree(mesh.materials[0])

    def test_shaders(self):
        tree = self.tree
        glossy = {"Base_Color": (0.9, 0.6, 0.3, 1), "Metallic": 0.3, "Roughness": 0.4}
        shaders = {
            "diffuse": lambda: tree.diffuse((0.8, 0.6, 0.4)),
            "glossy": lambda: tree.glossy(0.3),
            "Principled": lambda: tree.node(
                "ShaderNodeBsdfPrincipled", settings={"distribution": "GGX"}, **glossy
            ),
            "mixed": lambda: tree.mix(0.5, tree.diffuse((0.2, 0.5, 0.7)), tree.glossy(0.5)),
        }
        for name, shader in shaders.items():
            with self.subTest(name):
                tree.nodes.clear()
                tree.end(shader())
                self.assert_parity(f"Smooth edges: {name}", up_to=0.6)
