"""Passes that tell of surfaces, beside those of Cycles."""

import bpy
import numpy as np

from parity import engines, stage
from parity.case import ParityTest
from parity.shaders import Tree
from support import scenes

_SINCE_5 = {"IndexOB": "Object Index", "IndexMA": "Material Index"}
_MOST_OFF = 0.005  # of the pixels: where edges meet, one picture shows what no neighbor of the other does


class Passes(ParityTest):
    effort = engines.WHOLE  # each pixel is looked at

    def setUp(self):
        super().setUp()
        stage.ground(12)
        ball = stage.sphere(1.0, 0.7, 24, 12)
        box = stage.box((-2.0, -1.5, 0), (-1.0, 0.5, 1.5), 0.3)
        ball.name, box.name = "Ball", "Box ä"
        ball.location = (1, 0, 1)
        ball.pass_index, box.pass_index = 3, 7
        ball.active_material.pass_index, box.active_material.pass_index = 11, 13
        box.parent = bpy.data.objects["Ground"]
        stage.sharp_sun()
        stage.world((0.3, 0.3, 0.3))
        stage.camera()
        self.layer = bpy.context.view_layer
        self.show = scenes.composite(self.scene)

    def _pictures(self, switch, name, samples=1, channels=3):
        """Renders by Cycles and Velour, with the pass switched on."""
        setattr(self.layer, f"use_pass_{switch}", True)
        return self._rendered(name, samples, channels)

    def _rendered(self, name, samples=1, channels=3):
        found = []
        for engine in ("CYCLES", "VELOUR"):
            self.scene.render.engine = engine
            self.layer.update_render_passes()
            name = name if name in self._sockets() else _SINCE_5.get(name, name)
            self.show(name)
            self.scene.cycles.samples = self.scene.velour.samples = engines.WHOLE.samples * samples
            found.append(scenes.render(self.folder, f"{name}-{engine.lower()}")[..., :channels])
        return found

    def _sockets(self):
        nodes = scenes.compositor(self.scene).nodes
        return next(node for node in nodes if node.bl_idname == "CompositorNodeRLayers").outputs

    def _assert_near(self, theirs, ours, slack):
        """Each pixel lies between what Cycles has of its neighbors: a first sample may show one of them."""
        off = _outside(theirs, ours, slack)
        self.assertLess(off, _MOST_OFF)
        self.assertGreater(_outside(theirs, np.roll(ours, 3, axis=1), slack), 2 * _MOST_OFF)  # the control

    def test_position(self):
        self._assert_near(*self._pictures("position", "Position"), 1e-3)

    def test_denoising_normal(self):
        """Along the camera's axes, however the camera stands."""
        self.layer.cycles.denoising_store_passes = self.layer.velour.use_pass_denoising = True
        for scale in ((1, 1, 1), (-1, 2, 0.5)):
            with self.subTest(scale=scale):
                self.scene.camera.scale = scale
                theirs, ours = self._rendered("Denoising Normal")
                self.assertLess(theirs[..., 2].min(), -0.9)  # of what faces the camera
                self._assert_near(theirs, ours, 0.02)

    def test_denoising_albedo(self):
        """With what shines by itself: the sky, of which a transparent film has none, and a surface."""
        tree = Tree(bpy.data.objects["Box ä"].active_material)
        tree.end(tree.add(tree.diffuse((0.3, 0.2, 0.1)), tree.emission((1, 0.5, 0.2), 4)))
        self.layer.cycles.denoising_store_passes = self.layer.velour.use_pass_denoising = True
        for transparent in (False, True):
            with self.subTest(transparent=transparent):
                self.scene.render.film_transparent = transparent
                theirs, ours = self._rendered("Denoising Albedo")
                np.testing.assert_allclose(theirs.max(axis=(0, 1)), (4.3, 2.2, 0.9), rtol=1e-5)
                np.testing.assert_allclose(theirs[-1, 0], 0 if transparent else 0.3, rtol=1e-5)
                # Directions below a smooth surface's own faces reflect nothing in Velour.
                self._assert_near(theirs, ours, 0.01)

    def test_uv(self):
        for name in ("Ball", "Box ä"):
            bpy.context.view_layer.objects.active = bpy.data.objects[name]
        theirs, ours = self._pictures("uv", "UV")
        self.assertGreater(theirs[..., 0].max(), 0.5)
        self.assertEqual(theirs[..., 2].max(), ours[..., 2].max())
        self._assert_near(theirs, ours, 0.02)

    def test_indices(self):
        for switch, name, numbers in (
            ("object_index", "IndexOB", [0, 3, 7]),
            ("material_index", "IndexMA", [0, 11, 13]),
        ):
            with self.subTest(name):
                theirs, ours = self._pictures(switch, name, channels=1)
                self.assertEqual(np.unique(ours).tolist(), numbers)
                self._assert_near(theirs, ours, 0)

    def test_mist(self):
        mist = self.scene.world.mist_settings
        for falloff in ("LINEAR", "QUADRATIC", "INVERSE_QUADRATIC"):
            with self.subTest(falloff):
                mist.start, mist.depth, mist.falloff = 6, 6, falloff
                theirs, ours = self._pictures("mist", "Mist", 1, 1)
                np.testing.assert_allclose(ours.mean(), theirs.mean(), atol=2e-3)
                self.assertLess((np.abs(theirs - ours) > 0.03).mean(), _MOST_OFF)

    def test_mist_of_an_orthographic_camera(self):
        lens = self.scene.camera.data
        lens.type, lens.ortho_scale = "ORTHO", 8
        mist = self.scene.world.mist_settings
        mist.start, mist.depth, mist.falloff = 6, 6, "LINEAR"
        theirs, ours = self._pictures("mist", "Mist", 1, 1)
        np.testing.assert_allclose(ours.mean(), theirs.mean(), atol=2e-3)

    def test_vector(self):
        theirs, ours = self._pictures("vector", "Vector", channels=4)
        np.testing.assert_array_equal(theirs, 0)
        np.testing.assert_array_equal(ours, 0)

    def test_cryptomattes(self):
        for kind in ("object", "material", "asset"):
            with self.subTest(kind):
                name = f"Crypto{kind.title()}00"
                theirs, ours = self._pictures(f"cryptomatte_{kind}", name, 1, 4)
                self._assert_ids(theirs, ours)

    def test_cryptomatte_of_no_material(self):
        bpy.data.objects["Ball"].data.materials.clear()
        self._assert_ids(*self._pictures("cryptomatte_material", "CryptoMaterial00", 1, 4))

    def test_cryptomatte_through_glass_and_holdout(self):
        """What is half there covers half; of a holdout there is nothing."""
        bpy.data.objects["Box ä"].is_holdout = True
        tree = bpy.data.objects["Ball"].active_material.node_tree
        mix, clear = tree.nodes.new("ShaderNodeMixShader"), tree.nodes.new("ShaderNodeBsdfTransparent")
        surface = tree.nodes["Material Output"].inputs["Surface"]
        tree.links.new(surface.links[0].from_socket, mix.inputs[1])
        tree.links.new(clear.outputs[0], mix.inputs[2])
        tree.links.new(mix.outputs[0], surface)
        mix.inputs[0].default_value = 0.3
        self._assert_ids(*self._pictures("cryptomatte_object", "CryptoObject00", 4, 4), slack=0.12)

    def _assert_ids(self, theirs, ours, slack=0.2):
        """The same ids, of which each covers as much of the pixels."""
        ids = np.unique(_bits(theirs))
        self.assertEqual(set(ids) - {0}, set(np.unique(_bits(ours))) - {0})
        for number in set(ids) - {0}:
            one, other = _coverage(theirs, number), _coverage(ours, number)
            np.testing.assert_allclose(other.mean(), one.mean(), atol=2e-3)
            self.assertLess((np.abs(one - other) > slack).mean(), _MOST_OFF)


def _outside(theirs, ours, slack):
    """The share of pixels inside the border that are not between the least and the most of 3 x 3."""
    rows, columns = theirs.shape[0] - 2, theirs.shape[1] - 2
    near = np.stack([theirs[y : y + rows, x : x + columns] for y in range(3) for x in range(3)])
    inner = ours[1:-1, 1:-1]
    off = (inner < near.min(axis=0) - slack) | (inner > near.max(axis=0) + slack)
    return off.any(axis=-1).mean()


def _bits(pixels):
    """Bit patterns of the ids, by which ids are compared."""
    return np.ascontiguousarray(pixels[..., ::2]).view(np.uint32)


def _coverage(pixels, number):
    return (pixels[..., 1::2] * (_bits(pixels) == number)).sum(axis=-1)
