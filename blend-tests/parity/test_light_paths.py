"""Clamping, Filter Glossy and Reflective Caustics, as Velour copies them from Cycles."""

import unittest

import bpy
import numpy as np

from parity import stage
from parity.case import BoxTest
from parity.shaders import Tree
from support import level
from support.judge import judge_renders


class LightPaths(BoxTest):
    """Samples of lamps without extent bring the same: what is clamped of them is no matter of chance."""

    bounces = 2

    def setUp(self):
        super().setUp()
        self.scene.cycles.min_light_bounces = self.bounces  # no roulette
        self.material = bpy.data.materials.new("Beside")
        self.tree = Tree(self.material)

    def _copy(self, **values):
        """Sets them for Cycles, and has Velour copy them."""
        for name, value in values.items():
            setattr(self.scene.cycles, name, value)
        bpy.ops.velour.copy_cycles_settings()

    def _beside(self):
        """A wall of the material that shines on the ground."""
        corners = [(1.2, -2, 0), (1.2, 2, 0), (2.2, 2, 2), (2.2, -2, 2)]
        stage.mesh(corners, [(0, 1, 2, 3)], self.material, "Wall")

    def _assert_seen(self, feature, samples=1, most_percent=None):
        """Parity, or a known mismatch; and a picture that the settings change: the control."""
        if most_percent is None:
            self.assert_parity(feature, samples)
        else:
            self.assert_approximate(feature, most_percent, samples)
        ours = self.pictures("VELOUR", samples)
        settings = self.scene.velour
        settings.clamp_direct = settings.clamp_indirect = settings.filter_glossy = 0
        settings.use_reflective_caustics = True
        verdict = judge_renders(self.pictures("VELOUR", samples), ours)
        self.assertFalse(verdict.agrees, f"{feature} makes no difference here. {verdict}")

    def test_clamp_direct(self):
        stage.lamp("POINT", 300, (0.8, 0.6, 2.2), shadow_soft_size=0.0, color=(1, 0.6, 0.3))
        self._copy(sample_clamp_direct=0.8)
        self._assert_seen("Clamp Direct: point lamp")

    def test_clamp_direct_of_soft_light(self):
        """How bright a single sample is depends on how lights are sampled, which is not the same."""
        stage.lamp("AREA", 60, (0.8, 0.6, 2.2), size=0.6)
        self._copy(sample_clamp_direct=1.0)
        self._assert_seen("Clamp Direct: area lamp", most_percent=3)

    def test_clamp_indirect(self):
        self.tree.end(self.tree.diffuse((0.9, 0.5, 0.2)))
        self._beside()
        stage.sharp_sun(6.0)
        self._copy(sample_clamp_indirect=0.3)
        self._assert_seen("Clamp Indirect")

    def test_clamp_indirect_beside_roulette(self):
        """Cycles ends dark paths at random and makes up for it with brighter ones, which are clamped more."""
        self.tree.end(self.tree.diffuse((0.9, 0.5, 0.2)))
        self._beside()
        stage.sharp_sun(6.0)
        self.scene.cycles.min_light_bounces = 0
        self._copy(sample_clamp_indirect=0.3)
        self._assert_seen("Clamp Indirect: with Cycles' roulette", most_percent=3)

    def test_filter_glossy(self):
        """A smooth wall, seen by what the ground scatters."""
        self.tree.end(self.tree.glossy(0.35, color=(0.9, 0.9, 0.9)))
        self._beside()
        stage.lamp("AREA", 100, (-1.5, 0.6, 2.2), size=1.5)
        self._copy(blur_glossy=10.0)
        self._assert_seen("Filter Glossy", samples=4)

    def test_caustics(self):
        self.tree.end(self.tree.node("ShaderNodeBsdfPrincipled", Metallic=1.0, Roughness=0.5))
        self._beside()
        stage.sharp_sun(6.0)
        self._copy(caustics_reflective=False)
        self._assert_seen("Reflective Caustics: off", samples=4)

    @unittest.skipUnless(level.LONG, level.REASON)
    def test_caustics_of_layers(self):
        """The first surface is diffuse and glossy at once, and so is the second."""
        color = (0.8, 0.3, 0.1, 1)
        self.tree.end(self.tree.node("ShaderNodeBsdfPrincipled", Base_Color=color, Roughness=0.4))
        self._beside()
        ground = bpy.data.objects["Ground"]
        ground.data.materials.clear()
        ground.data.materials.append(self.material)
        stage.sharp_sun(6.0)
        self._copy(caustics_reflective=False)
        self._assert_seen("Reflective Caustics: off, Principled BSDF", samples=4)


class Transparent(BoxTest):
    def test_most_bounces(self):
        """Cycles shows nothing behind more surfaces than it may pass."""
        stage.sharp_sun()
        for height in (1.2, 1.3, 1.4):
            material = bpy.data.materials.new("Clear")
            tree = Tree(material)
            tree.end(tree.transparent((0.9, 0.8, 0.7)))
            corners = [(x, y, height) for x, y in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
            stage.mesh(corners, [(0, 1, 2, 3)], material, "Clear")
        self.scene.cycles.transparent_max_bounces = 2
        self.assert_ignored("Transparent bounces", "Transparent Max Bounces of Cycles: not supported")


class Copied(BoxTest):
    def test_all_settings(self):
        cycles, settings = self.scene.cycles, self.scene.velour
        cycles.sample_clamp_direct, cycles.sample_clamp_indirect = 3.0, 7.0
        cycles.blur_glossy, cycles.caustics_reflective = 2.0, False
        bpy.ops.velour.copy_cycles_settings()
        copied = (settings.clamp_direct, settings.clamp_indirect, settings.filter_glossy)
        np.testing.assert_array_equal(copied, (3.0, 7.0, 2.0))
        self.assertFalse(settings.use_reflective_caustics)
