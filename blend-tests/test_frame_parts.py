"""Final renders that several runs share out, or that are ended and gone on with; what a frame takes."""

import os
import re
import resource
import signal
import sys
import unittest
from unittest import mock

import bpy
import numpy as np

from support import inputs, level, scenes
from support.blender import FULL_DISK, BlenderTest, printed, run_blender

OWN_PROCESS = "the largest of its child processes is measured"
_ROUNDING = 1e-6
# A batch engine that ends Blender while it renders a view layer.
_END_LAYER = """
import importlib, os, signal

final = importlib.import_module("velour.engine.final")
follow = final._follow

def ended(engine, delivery, job, begin, end):
    if delivery.result.layers[0].name == {layer!r}:
        while job.poll().fraction < 0.05:
            pass
        os.kill(os.getpid(), signal.SIGTERM)
        os.kill(os.getpid(), signal.SIGTERM)  # to a group, of which one hands it on
    follow(engine, delivery, job, begin, end)

final._follow = ended
"""
# Likewise, once the last sample is rendered.
_END_WRITING = """
import os, signal
import bpy

bpy.app.handlers.render_post.append(lambda *_: os.kill(os.getpid(), signal.SIGTERM))
"""
# As after ulimit -v, with so many bytes left.
_LIMIT_ADDRESSES = """
import re, resource

size = int(re.search(r"VmSize:\\s+(\\d+)", open("/proc/self/status").read())[1]) << 10
resource.setrlimit(resource.RLIMIT_AS, (size + {left}, size + {left}))
"""


class FrameParts(BlenderTest):
    def setUp(self):
        super().setUp()
        self.parts = self.folder / "parts"

    def _save(self, samples=40, size=64, layers=1, name="shot"):
        """A scene with passes that are sums, such as are the first ray's, and ids; all in 32 bits."""
        scene = scenes.use_engine(samples=samples, size=size)
        scenes.add_camera()
        scenes.add_sphere()
        scenes.set_world()
        for number in range(1, layers):
            scene.view_layers.new(f"Layer {number}")
        for layer in scene.view_layers:
            layer.use_pass_z = layer.use_pass_position = layer.use_pass_cryptomatte_object = True
            layer.velour.use_pass_error = True
        settings = scene.render.image_settings
        if hasattr(settings, "media_type"):  # 5.0 and newer
            settings.media_type = "MULTI_LAYER_IMAGE"
        settings.file_format, settings.color_depth = "OPEN_EXR_MULTILAYER", "32"
        path = self.folder / f"{name}.blend"
        bpy.ops.wm.save_as_mainfile(filepath=str(path))
        return path

    def _render(self, blend, name, *options):
        """The frame as `_run` renders it, but by this Blender. Returns what it prints."""
        bpy.ops.wm.open_mainfile(filepath=str(blend))
        bpy.context.scene.render.filepath = str(self._path(name))
        arguments = ["blender", "--", *map(str, options)]
        with mock.patch.object(sys, "argv", arguments), printed() as said:
            bpy.ops.render.render(write_still=True)
            self.assertTrue(self._path(name).exists())
            return said()

    def _refused(self, words, blend, name, *options):
        with self.assertRaisesRegex(RuntimeError, words):
            self._render(blend, name, *options)
        self.assertFalse(self._path(name).exists())

    def _run(self, blend, name, *options, before=(), status=0):
        """Likewise, by a Blender of its own."""
        output = self.folder / f"{name}_####"
        done = run_blender(blend, *before, "-E", "VELOUR", "-o", output, "-f", 1, "--", *options)
        self.assertEqual(done.returncode, status, done.stdout)
        self.assertEqual(self._path(name).exists(), status in (0, -signal.SIGTERM))
        return done.stdout

    def _path(self, name):
        return self.folder / f"{name}_0001.exr"

    def _files(self):
        return sorted(path.name.rpartition("_")[2] for path in self.parts.glob("*"))

    def _channels(self, name):
        """{channel: pixels}, of the first pass alone where each has a part of its own: 5.0 and newer."""
        images = inputs.native().images
        pixels = images.read(self._path(name))
        names = images.header(self._path(name))["channels"]
        return {name: pixels[..., number] for number, name in enumerate(names)}

    def _assert_same(self, one, other, tolerance):
        one, other = self._channels(one), self._channels(other)
        self.assertEqual(one.keys(), other.keys())
        self.assertGreaterEqual(len(one), 4 if bpy.app.version >= (5, 0) else 20)
        for name, pixels in one.items():
            scale = np.abs(pixels[pixels < 1e9]).max(initial=0)  # depth of the sky
            difference = np.abs(pixels - other[name]).max()
            self.assertLessEqual(difference, tolerance * scale, name)

    def test_parts_make_the_frame(self):
        blend = self._save()
        self._render(blend, "whole")
        for number in (3, 1, 2):  # as machines happen to end
            self._render(
                blend, f"part{number}", "--velour-parts", self.parts, "--velour-samples", f"{number}/3"
            )
        self.assertEqual(self._files(), ["0001.0-8.exr", "0001.24-40.exr", "0001.8-24.exr"])
        final = inputs.module("engine.final")
        with mock.patch.object(final, "_follow", wraps=final._follow) as rendered:
            self._render(blend, "merged", "--velour-parts", self.parts)
            rendered.assert_not_called()
        self._assert_same("merged", "whole", _ROUNDING)
        self.assertEqual(self._files(), [])
        header = inputs.native().images.header(self._path("part2"))
        self.assertEqual(header["texts"]["velour.samples"], "8:24")
        self.assertNotIn("velour.samples", inputs.native().images.header(self._path("merged"))["texts"])
        apart = np.abs(self._first(self._channels("part2")) - self._first(self._channels("whole"))).max()
        self.assertGreater(apart, 100 * _ROUNDING)

    @staticmethod
    def _first(channels):
        return next(pixels for name, pixels in channels.items() if name.endswith("Combined.R"))

    def test_parts_are_denoised_once_they_are_together(self):
        """A part shows its noise; the frame is denoised as one that was rendered at once."""
        if reason := inputs.module("export.denoiser").missing():
            self.skipTest(reason)
        blend = self._save()
        bpy.context.scene.velour.use_denoising = True
        bpy.ops.wm.save_mainfile()
        self._render(blend, "whole")
        for number in (2, 1):
            self._render(
                blend, f"part{number}", "--velour-parts", self.parts, "--velour-samples", f"{number}/2"
            )
        self._render(blend, "merged", "--velour-parts", self.parts)
        self._assert_same("merged", "whole", 1e-3)
        texts = {
            name: inputs.native().images.header(self._path(name))["texts"] for name in ("part1", "merged")
        }
        self.assertNotIn("velour.denoised", texts["part1"])
        self.assertIn("at most", texts["merged"]["velour.denoised"])

    def test_what_is_missing_is_rendered(self):
        """Two gaps, of which the second goes on where a part ends."""
        blend = self._save()
        self._render(blend, "whole")
        self._render(blend, "part", "--velour-parts", self.parts, "--velour-samples", "8:24")
        self._render(blend, "merged", "--velour-parts", self.parts)
        self._assert_same("merged", "whole", _ROUNDING)

    def test_an_ended_frame_goes_on(self):
        """To the bits of a frame that nobody ended; with two view layers."""
        blend = self._save(samples=1000, layers=2)
        self._run(blend, "whole")
        parts = ("--velour-parts", self.parts)
        # No layer after the ended one is rendered.
        for layer, before in (("ViewLayer", []), ("Layer 1", ["0001.0-1000.exr"])):
            script = ("--python-expr", _END_LAYER.format(layer=layer))
            said = self._run(blend, "ended", *parts, before=script, status=1)
            found = re.search(r"Stopped at sample (\d+) of 1000; .* Run the same command again", said)
            self.assertTrue(found, said)
            self.assertEqual(self._files(), sorted([f"0001.0-{found[1]}.exr", *before]))
        said = self._run(blend, "ended", "--velour-parts", self.parts)
        self._assert_same("ended", "whole", 0)
        self.assertEqual(self._files(), [])

    def test_sigterm_while_blender_composites_and_writes(self):
        """All is rendered, and nothing of it kept yet: Blender writes the frame, and ends then."""
        blend = self._save()
        command = ("--velour-parts", self.parts)
        self._run(blend, "late", *command, before=("--python-expr", _END_WRITING), status=-signal.SIGTERM)
        self._run(blend, "whole")
        self._assert_same("late", "whole", 0)
        # In an animation of two frames, the second does not begin.
        script = (*("--python-expr", _END_WRITING), "-E", "VELOUR", "-o", self.folder / "anim_####")
        done = run_blender(blend, *script, "-s", 1, "-e", 2, "-a", "--", *command)
        self.assertEqual(done.returncode, -signal.SIGTERM, done.stdout)
        self.assertEqual([path.name for path in self.folder.glob("anim_*")], ["anim_0001.exr"])

    def test_parts_stay_where_they_are_asked_to(self):
        blend = self._save()
        command = ("--velour-parts", self.parts, "--velour-keep-parts")
        self._render(blend, "part", *command, "--velour-samples", "0:8")
        self._render(blend, "whole", *command)
        self.assertEqual(self._files(), ["0001.0-8.exr"])

    def test_a_long_name(self):
        """Signs that become several bytes; file systems have 255 of a name."""
        blend = self._save(name="布" * 30)
        self._render(blend, "part", "--velour-parts", self.parts, "--velour-samples", "0:8")
        self._render(blend, "merged", "--velour-parts", self.parts)
        self.assertEqual(self._files(), [])

    def test_what_was_not_written_is_kept(self):
        """A script renders frame 1 without a file, then writes frame 2: the parts of 1 are still there."""
        blend = self._save()
        self._render(blend, "part", "--velour-parts", self.parts, "--velour-samples", "0:8")
        bpy.ops.wm.open_mainfile(filepath=str(blend))
        path, scene = self.folder / "second.exr", bpy.context.scene
        with mock.patch.object(sys, "argv", ["blender", "--", "--velour-parts", str(self.parts)]):
            bpy.ops.render.render()
            scene.frame_set(2)
            scene.render.filepath = str(path)
            bpy.ops.render.render(write_still=True)
        self.assertTrue(path.exists())
        self.assertEqual(self._files(), ["0001.0-8.exr"])

    def test_a_full_disk_keeps_the_parts(self):
        if "VELOUR_BPY" in os.environ:
            self.skipTest("the module bpy leaves signals to its Python")
        blend = self._save()
        parts = ("--velour-parts", self.parts)
        self._run(blend, "part", *parts, "--velour-samples", "0:8")
        said = self._run(blend, "whole", *parts, before=("--python-expr", FULL_DISK), status=1)
        self.assertIn("free space on the disk", said)
        self.assertEqual(self._files(), ["0001.0-8.exr"])

    def test_the_time_limit_ends_a_frame_that_keeps_its_parts(self):
        blend = self._save(samples=100000)
        bpy.context.scene.velour.time_limit = 0.2
        bpy.ops.wm.save_mainfile()
        self._render(blend, "limited")  # without: the picture as far as it is, which says so
        said = inputs.native().images.header(self._path("limited"))["texts"]["velour.samples"]
        begin, end = map(int, said.split(":"))
        self.assertEqual(begin, 0)
        self.assertTrue(8 <= end < 100000 and end % 8 == 0, said)
        self._refused("Run the same command again to continue", blend, "kept", "--velour-parts", self.parts)
        self.assertEqual(len(self._files()), 1)

    def test_another_state_is_refused(self):
        blend = self._save()
        self._render(blend, "part", "--velour-parts", self.parts, "--velour-samples", "0:8")
        bpy.context.scene.velour.seed += 1
        bpy.ops.wm.save_mainfile()
        words = "belongs to another render, as the blend differs.*remove it, or choose another folder"
        self._refused(words, blend, "merged", "--velour-parts", self.parts)

    def test_another_state_of_a_library_is_refused(self):
        library = self.folder / "parts.blend"
        mesh = bpy.data.meshes.new("Linked")
        bpy.data.libraries.write(str(library), {mesh}, fake_user=True)
        blend = self._save(samples=16, size=16)
        with bpy.data.libraries.load(str(library), link=True) as (_, wanted):
            wanted.meshes = ["Linked"]
        bpy.context.collection.objects.link(bpy.data.objects.new("Linked", wanted.meshes[0]))
        bpy.ops.wm.save_as_mainfile(filepath=str(blend))
        self._render(blend, "first", "--velour-parts", self.parts, "--velour-samples", "1/2")
        bpy.ops.wm.read_homefile(use_empty=True)
        mesh = bpy.data.meshes.new("Linked")
        mesh.from_pydata([(0, 0, 0)], [], [])
        bpy.data.libraries.write(str(library), {mesh}, fake_user=True)
        self._refused("the linked data differs", blend, "other", "--velour-parts", self.parts)

    def test_another_state_of_an_image_or_cache_is_refused(self):
        """The file that a sequence has for the frame, a tile and a mesh cache count; unused files do not."""
        files = {name: self.folder / name for name in ("sky.0001.exr", "map.1001.exr", "m.pc2", "unused.exr")}
        for path in files.values():
            inputs.native().images.write(path.with_suffix(".exr"), np.ones((4, 8, 3), np.float32))
        files["m.pc2"].write_bytes(b"1")
        blend = self._save(samples=16, size=16)
        tree = bpy.context.scene.world.node_tree
        sky = tree.nodes.new("ShaderNodeTexEnvironment")
        sky.image = bpy.data.images.load(str(files["sky.0001.exr"]))
        sky.image.source, sky.image_user.frame_duration = "SEQUENCE", 1
        tree.links.new(sky.outputs["Color"], tree.nodes["Background"].inputs["Color"])
        tiles = bpy.data.images.load(str(files["map.1001.exr"]))
        tiles.source, tiles.filepath, tiles.use_fake_user = "TILED", str(self.folder / "map.<UDIM>.exr"), True
        bpy.data.objects["Sphere"].modifiers.new("Cache", "MESH_CACHE").filepath = str(files["m.pc2"])
        bpy.ops.wm.save_as_mainfile(filepath=str(blend))
        self._render(blend, "first", "--velour-parts", self.parts, "--velour-samples", "1/2")
        for name, path in files.items():
            before = path.read_bytes()
            path.write_bytes(before + b"\0")
            if name == "unused.exr":
                self._render(blend, "other", "--velour-parts", self.parts)
                continue
            self._refused("the linked data differs", blend, "other", "--velour-parts", self.parts)
            path.write_bytes(before)

    def test_a_damaged_part_is_refused(self):
        blend = self._save()
        self._render(blend, "part", "--velour-parts", self.parts, "--velour-samples", "0:8")
        (part,) = self.parts.iterdir()
        whole = part.read_bytes()
        for size in (len(whole) // 2, 100):
            part.write_bytes(whole[:size])
            self._refused(re.escape(part.name), blend, "merged", "--velour-parts", self.parts)

    def test_wrong_options(self):
        blend = self._save()
        folder = ("--velour-parts", self.parts)
        for options, words in (
            (("--velour-part", "1"), "unknown option --velour-part"),
            (("--velour-samples", "0:8"), "needs a folder"),
            ((*folder, "--velour-samples", "0:7"), "multiples of 8"),
            ((*folder, "--velour-samples", "0:80"), "exceed the 40 samples"),
            ((*folder, "--velour-samples", "4/3"), "at most 3"),
            ((*folder, "--velour-samples", "1/6"), "5 camera rays"),
            (("--velour-memory", "some"), "some"),
        ):
            with self.subTest(options=options):
                self._refused(words, blend, "wrong", *options)
        self.assertIn("unknown option", self._run(blend, "wrong", "--velour-part", "1", status=1))
        bpy.context.scene.velour.use_noise_target = True
        bpy.ops.wm.save_mainfile()
        words = "Noise Threshold needs all samples of the image"
        self._refused(words, blend, "wrong", *folder, "--velour-samples", "0:8")

    @unittest.skipUnless(level.LONG, level.REASON)
    def test_memory_is_stated_and_limited(self):
        blend = self._save(samples=1, size=1024)
        said = self._run(blend, "stated")
        stated = re.search(
            r"Estimated memory: (\d+) MiB.*: blender \d+ MiB, scene .*, picture (\d+) MiB", said
        )
        self.assertTrue(stated, said)
        self.assertGreater(int(stated[2]), 1024 * 1024 * 4 * 40 / 2**20)  # sums and passes
        peak = resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss / 1024  # this one's: others are smaller
        self.assertLess(peak, int(stated[1]))
        self.assertGreater(peak, int(stated[1]) / 1.5)
        said = self._run(blend, "refused", "--velour-memory", "100M", status=1)
        self.assertRegex(
            said, r"needs about \d+ MiB of memory \(.*\), more than the limit of 100 MiB \(--velour"
        )
        self.assertIn("only partly exported yet", said)  # before the system might end Blender
        self._run(blend, "allowed", "--velour-memory", "8G")
        above = int(stated[1]) - int(stated[2]) // 2
        said = self._run(blend, "refused", "--velour-memory", f"{above}M", status=1)
        self.assertRegex(said, r"The frame needs about \d+ MiB of memory \(.*, picture")
        script = _LIMIT_ADDRESSES.format(left=int(stated[2]) << 19)
        said = self._run(blend, "refused", before=("--python-expr", script), status=1)
        self.assertRegex(said, r"The frame needs about .*, more than the limit of \d+ MiB \(ulimit -v")
