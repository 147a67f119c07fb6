"""A render that fails exits non-zero and leaves no picture: every cause, format and way to render."""

import contextlib
import os
import unittest
from pathlib import Path

import bpy

from support import inputs, level, scenes
from support.blender import FULL_DISK, BlenderTest, interrupt_blender, run_blender

_FORMATS = {"PNG": ".png", "OPEN_EXR": ".exr", "OPEN_EXR_MULTILAYER": ".exr"}
_WAYS = ("-f", 1), ("-a",)
_FEW = {} if level.LONG else {"formats": ("OPEN_EXR_MULTILAYER",), "ways": _WAYS[:1]}
# Makes the export raise what nobody foresaw.
_BREAK_EXPORT = (
    "import importlib; final = importlib.import_module('velour.engine.final');"
    " final.final_view = lambda *a, **k: 1 / 0"
)


class ExitCodes(BlenderTest):
    def _scene(self, material=None):
        scene = scenes.use_engine(samples=8, size=16)
        scene.frame_start, scene.frame_end = 1, 3
        scenes.add_camera()
        scenes.add_sphere(material)
        scenes.set_world()
        return scene

    def _save(self):
        path = self.folder / "scene.blend"
        bpy.ops.wm.save_as_mainfile(filepath=str(path))
        return path

    def _render(self, blend, kind, frames, *before):
        output = self.folder / kind / "picture_####"
        return run_blender(blend, *before, "-E", "VELOUR", "-o", output, "-F", kind, *frames)

    def _written(self, kind):
        return (
            sorted(path.name for path in (self.folder / kind).glob("*"))
            if (self.folder / kind).is_dir()
            else []
        )

    def _all_fail(self, words, *before, formats=tuple(_FORMATS), ways=_WAYS):
        """One cause is as another to `formats` and `ways`: the short suite tries all with one cause."""
        blend = self._save()
        for kind in formats:
            for frames in ways:
                with self.subTest(format=kind, frames=frames[0]):
                    child = self._render(blend, kind, frames, *before)
                    self.assertEqual(child.returncode, 1, child.stdout)
                    self.assertEqual(self._written(kind), [])
                    for word in words:
                        self.assertIn(word, child.stdout)

    def test_good_render(self):
        """The control: the same runs exit 0 and write what was asked for."""
        self._scene()
        blend = self._save()
        for kind, suffix in _FORMATS.items():
            with self.subTest(format=kind):
                child = self._render(blend, kind, ("-s", 1, "-e", 2, "-a"))
                self.assertEqual(child.returncode, 0, child.stdout)
                self.assertEqual(self._written(kind), [f"picture_000{n}{suffix}" for n in (1, 2)])

    def test_missing_model_file(self):
        data = inputs.model_bytes(inputs.lambert_measurement())
        path = self.folder / "paint.velour"
        path.write_bytes(data)
        self._scene()
        bpy.ops.velour.load_material(filepath=str(path), pack=False)
        name = bpy.context.object.active_material.name
        path.unlink()
        self._all_fail([f"Material '{name}'", "paint.velour", "Find Missing Files"], **_FEW)

    def test_changed_model_file(self):
        path = self.folder / "paint.velour"
        path.write_bytes(inputs.model_bytes(inputs.lambert_measurement()))
        self._scene()
        bpy.ops.velour.load_material(filepath=str(path), pack=False)
        path.write_bytes(inputs.model_bytes(inputs.glossy_measurement()))
        self._all_fail(["paint.velour", "has changed", "Accept Changed File"], **_FEW)

    def test_corrupt_packed_model(self):
        data = inputs.model_bytes(inputs.lambert_measurement())
        self._scene(material := scenes.measured_material(data))
        measured = inputs.module("operators.measured")
        scenes.velour_node(material).image = measured.packed_model(data[: len(data) // 2], "Paint")
        self._all_fail(["Material 'Paint'"], **_FEW)

    def test_no_model(self):
        self._scene()
        bpy.ops.velour.add_material()
        self._all_fail(["Material 'Measured'", "has no model"], **_FEW)

    def test_no_camera(self):
        scene = self._scene()
        scene.camera = None
        self._all_fail(["amera"], **_FEW)

    def test_refused_scene_behind_the_compositor(self):
        """Blender itself would go on, and save black pictures."""
        scene = self._scene()
        other = scene.copy()
        other.camera = scene.camera.copy()
        other.camera.data = scene.camera.data.copy()
        other.camera.data.type = "PANO"
        other.collection.objects.link(other.camera)
        scene.use_nodes = True
        if hasattr(scene, "compositing_node_group"):  # 5.0 and newer
            tree = scene.compositing_node_group = bpy.data.node_groups.new("Compositor", "CompositorNodeTree")
            tree.interface.new_socket("Image", in_out="OUTPUT", socket_type="NodeSocketColor")
            layers, end = tree.nodes.new("CompositorNodeRLayers"), tree.nodes.new("NodeGroupOutput")
            tree.links.new(layers.outputs[0], end.inputs[0])
        else:
            layers = scene.node_tree.nodes["Render Layers"]
        layers.scene = other
        self._all_fail(["pano cameras are not supported"], **_FEW)

    def test_missing_world_image(self):
        self._scene()
        tree = bpy.context.scene.world.node_tree
        node = tree.nodes.new("ShaderNodeTexEnvironment")
        node.image = bpy.data.images.new("sky.hdr", 1, 1)
        node.image.source, node.image.filepath_raw = "FILE", "//sky.hdr"
        tree.links.new(node.outputs[0], tree.nodes["Background"].inputs["Color"])
        self._all_fail(["World 'World'", "sky.hdr"], **_FEW)

    def test_unforeseen_exception(self):
        self._scene()
        self._all_fail(["ZeroDivisionError"], "--python-expr", _BREAK_EXPORT)

    def test_fails_on_the_second_frame(self):
        scene = self._scene()
        scene.render.use_motion_blur = False
        camera = scene.camera
        for frame, kind in ((1, 0), (2, 2)):
            camera.data.type = ("PERSP", "ORTHO", "PANO")[kind]
            camera.data.keyframe_insert("type", frame=frame)
        blend = self._save()
        child = self._render(blend, "OPEN_EXR", ("-a",))
        self.assertEqual(child.returncode, 1, child.stdout)
        self.assertEqual(self._written("OPEN_EXR"), ["picture_0001.exr"])

    def test_failed_layer_ends_the_frame(self):
        """Blender would render the other view layers, and discard them. The next frame starts afresh."""
        scene = self._scene()
        scene.view_layers.new("Other")
        scene.render.use_persistent_data = True  # keeps the engine
        child = self._render(self._save(), "OPEN_EXR", ("-f", 1), "--python-expr", _BREAK_EXPORT)
        self.assertEqual(child.stdout.count("ZeroDivisionError: "), 2, child.stdout)  # traceback and report
        camera, scene.camera.data.type = scene.camera.data, "PANO"
        for kind in ("PANO", "PERSP"):
            camera.type = kind
            scene.render.filepath = str(self.folder / f"{kind}.png")
            with contextlib.suppress(RuntimeError):
                bpy.ops.render.render(write_still=True)
            self.assertEqual(os.path.exists(scene.render.filepath), kind == "PERSP")

    def test_full_disk(self):
        """Blender itself says that it has saved the file."""
        if "VELOUR_BPY" in os.environ:
            self.skipTest("the module bpy leaves signals to its Python")
        self._scene()
        blend = self._save()
        for kind, frames in (("OPEN_EXR", ("-a",)), ("OPEN_EXR_MULTILAYER", ("-f", 1)), ("TIFF", ("-f", 1))):
            with self.subTest(kind):
                child = self._render(blend, kind, frames, "--python-expr", FULL_DISK)
                self.assertEqual(child.returncode, 1, child.stdout)
                self.assertEqual(child.stdout.count("free space on the disk"), 1, child.stdout)
                self.assertEqual(self._written(kind), [])

    def test_interrupt(self):
        if "VELOUR_BPY" in os.environ:
            self.skipTest("the module bpy leaves Ctrl-C to its Python")
        scene = self._scene()
        scene.velour.samples = 1 << 20
        scene.render.resolution_x = scene.render.resolution_y = 512
        blend = self._save()
        for kind in _FEW.get("formats", _FORMATS):
            with self.subTest(format=kind):
                output = self.folder / kind / "picture_####"
                arguments = (blend, "-E", "VELOUR", "-o", output, "-F", kind, "-f", 1)
                status, text, seconds = interrupt_blender(*arguments, after="Sample ")
                self.assertEqual(status, 1, text)
                self.assertEqual(self._written(kind), [])
                self.assertLess(seconds, 3.0)

    def test_bounds_of_a_picture(self):
        """What a farm checks: all parts are there and every scanline reads."""
        scene = self._scene()
        scene.view_layers[0].use_pass_z = scene.view_layers[0].use_pass_normal = True
        scene.view_layers[0].velour.use_pass_sample_count = True
        child = self._render(self._save(), "OPEN_EXR_MULTILAYER", ("-f", 1))
        self.assertEqual(child.returncode, 0, child.stdout)
        path = Path(self.folder / "OPEN_EXR_MULTILAYER" / "picture_0001.exr")
        header = path.read_bytes()[:4096]
        for channel in (b"Combined.R", b"Depth.Z", b"Normal.X", b"Sample Count.X"):
            self.assertIn(channel, header)


if __name__ == "__main__":
    unittest.main()
