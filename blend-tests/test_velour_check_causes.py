"""velour-check names what has changed: each change of a small scene by its kind and its owner."""

import unittest
from pathlib import Path

import bpy
import numpy as np

from support import level, scenes
from support.check_folder import CheckFolderTest

_FEW = ("--seeds", 4)  # of a reference, which have 16
_DATA = Path(__file__).parent / "scenes/data"


class Causes(CheckFolderTest):
    def setUp(self):
        super().setUp()
        _dress_up()

    def test_each_change_is_named(self):
        self.save("shot")
        self.update()
        report = self.folder / "report.xml"
        self._assert_named(_CHANGES, _EXPECTED, "--junit", report)
        text = report.read_text()
        self.assertEqual(text.count("<testcase"), 2 + len(_EXPECTED))
        self.assertEqual(text.count("<failure message="), len(_EXPECTED))

    @unittest.skipUnless(level.LONG, level.REASON)
    def test_changes_are_named_through_an_open_lens(self):
        """Every pixel mixes several objects."""
        lens = bpy.context.scene.camera.data.dof
        lens.use_dof, lens.focus_distance, lens.aperture_fstop = True, 2.0, 0.03
        self.save("shot")
        self.update(*_FEW)
        self._assert_named(_LENS_CHANGES, _LENS_EXPECTED)

    def _assert_named(self, changes, expected, *options):
        """The changes are those of "shot", whose reference is there; "seed" is none."""
        for name, change in changes.items():
            bpy.ops.wm.open_mainfile(filepath=str(self.shots / "shot.blend"))
            change()
            self.save(name)
        self.references(*changes)
        status, said, outcomes = self.check(*options)
        self.assertEqual(status, 1, said)
        for name in {"shot", *changes} - set(expected):
            self.assertTrue(outcomes[name]["passed"], said)
        for name, (kind, words) in expected.items():
            with self.subTest(name):
                found = [(cause["kind"], cause["sentence"]) for cause in outcomes[name]["causes"]]
                self.assertEqual([each for each, _ in found], [kind], said)
                self.assertIn(words, found[0][1])
                self.assertIn(f"{kind}: ", (self.shots / "velour-check/index.html").read_text())

    def test_update_asks_before_it_replaces(self):
        self.save("shot")
        self.update(*_FEW)
        kept = self._bytes()
        bpy.context.scene.cycles.film_exposure *= 1.1
        self.save("shot")
        status, said, _ = self.check("--update", *_FEW)
        self.assertEqual((status, self._bytes()), (1, kept), said)
        for words in ("to approve: shot: exposure: ", "1 reference kept", "--yes"):
            self.assertIn(words, said)
        page = (self.shots / "velour-check/index.html").read_text()
        self.assertIn("reference until now", page)
        self.assertIn("exposure: ", page)
        status, said, _ = self.check("--update", "--yes", *_FEW)
        self.assertEqual(status, 0, said)
        self.assertIn("1 reference replaced", said)
        self.assertNotIn(self._bytes()[0], kept)
        # A former reference has no passes.
        (self.shots / "shot.passes.npz").unlink()
        status, said, _ = self.check()
        self.assertEqual(status, 0, said)
        self.assertIn("compared without causes", (self.shots / "velour-check/index.html").read_text())

    def _bytes(self):
        return [(self.shots / f"shot{end}").read_bytes() for end in (".exr", ".error.exr", ".passes.npz")]


def _dress_up():
    """A textured ball and a box on a floor of a measured material, under a lamp and a sky with a sun."""
    ball, floor = bpy.data.objects["Sphere"], bpy.data.objects["Plane"]
    ball.active_material = _textured("Tiles", _image("Tiles", 1))
    floor.data.materials.clear()
    floor.data.materials.append(scenes.measured_material((_DATA / "plastic.velour").read_bytes(), "Plastic"))
    bpy.ops.mesh.primitive_cube_add(size=0.8, location=(-1.6, 0.6, -0.6))
    bpy.context.object.data.materials.append(scenes.diffuse_material((0.2, 0.5, 0.3), "Green"))
    tree = scenes.set_world().node_tree
    sky, place = tree.nodes.new("ShaderNodeTexEnvironment"), tree.nodes.new("ShaderNodeMapping")
    sky.image = _sky()
    source = tree.nodes.new("ShaderNodeTexCoord").outputs["Generated"]
    tree.links.new(source, place.inputs["Vector"])
    tree.links.new(place.outputs[0], sky.inputs["Vector"])
    tree.links.new(sky.outputs[0], tree.nodes["Background"].inputs["Color"])


def _textured(name, image):
    material = scenes.diffuse_material(name=name)
    tree = material.node_tree
    texture = tree.nodes.new("ShaderNodeTexImage")
    texture.image = image
    tree.links.new(texture.outputs["Color"], tree.nodes["Diffuse BSDF"].inputs["Color"])
    return material


def _image(name, phase):
    rows, columns = np.mgrid[0:16, 0:16]
    checkers = (rows // 4 + columns // 4 + phase) % 2
    return _packed(name, np.where(checkers[..., None], (0.8, 0.7, 0.5), (0.1, 0.2, 0.3)))


def _sky():
    rows, columns = np.mgrid[0:32, 0:64]
    sky = np.full((32, 64, 3), 0.2)
    sky[16:] = (0.3, 0.5, 0.9)
    sky *= 1 + 0.5 * np.sin(columns / 3)[..., None]
    sky[(rows - 26) ** 2 + (columns - 40) ** 2 < 12] = (12, 10, 8)
    return _packed("Sky", sky)


def _packed(name, pixels):
    height, width = pixels.shape[:2]
    image = bpy.data.images.new(name, width, height, float_buffer=True)
    image.pixels.foreach_set(np.dstack([pixels, np.ones((height, width))]).astype(np.float32).ravel())
    image.pack()
    return image


def _seed():
    bpy.context.scene.velour.seed = 77


def _expose():
    bpy.context.scene.cycles.film_exposure *= 1.01


def _turn_world():
    bpy.context.scene.world.node_tree.nodes["Mapping"].inputs["Rotation"].default_value[2] += np.radians(1)


def _swap_texture():
    bpy.data.materials["Tiles"].node_tree.nodes["Image Texture"].image = _image("Other", 0)


def _refit():
    bpy.data.materials["Plastic"].name = "Former"
    worse = scenes.measured_material((_DATA / "plastic_worse.velour").read_bytes(), "Plastic")
    bpy.data.objects["Plane"].material_slots[0].material = worse


def _shift_uv_map():
    layer = bpy.data.objects["Sphere"].data.uv_layers.active
    for corner in layer.data:
        corner.uv[0] += 0.05


def _move():
    bpy.data.objects["Cube"].location.x += 0.02


def _smooth():
    bpy.data.objects["Sphere"].data.polygons.foreach_set("use_smooth", [False] * 512)


def _dim():
    bpy.data.lights["Lamp"].energy *= 0.9


def _move_camera():
    bpy.context.scene.camera.location.z += 0.05


def _focus():
    bpy.context.scene.camera.data.dof.focus_distance *= 1.5


# Kind of cause and words of its sentence, by file.
_EXPECTED = {
    "exposed": ("exposure", "times 1.0"),
    "turned": ("world", "turned"),
    "swapped": ("material", "'Tiles', its texture"),
    "refitted": ("material", "'Plastic'"),
    "shifted": ("geometry", "UV map of object 'Sphere'"),
    "camera": ("geometry", "camera"),
}
_CHANGES = {
    "seed": _seed,
    "exposed": _expose,
    "turned": _turn_world,
    "swapped": _swap_texture,
    "refitted": _refit,
    "shifted": _shift_uv_map,
    "camera": _move_camera,
}
_LENS_CHANGES = {"swapped": _swap_texture, "refitted": _refit, "shifted": _shift_uv_map, "focused": _focus}
_LENS_EXPECTED = {name: _EXPECTED[name] for name in ("swapped", "refitted", "shifted")}
_LENS_EXPECTED["focused"] = ("geometry", "depth of field")
if level.LONG:
    _CHANGES |= {"moved": _move, "flat": _smooth, "dimmed": _dim}
    _EXPECTED |= {
        "moved": ("geometry", "object 'Cube'"),
        "flat": ("geometry", "object 'Sphere'"),
        "dimmed": ("light", "lamps"),
    }


if __name__ == "__main__":
    unittest.main()
