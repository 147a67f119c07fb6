"""scripts/farm: frames that are done are kept, others are rendered; a job is for one state of a .blend."""

import wave
from concurrent.futures import ThreadPoolExecutor

import bpy
import numpy as np

from support import inputs
from support.farm import FarmTest


class Farm(FarmTest):
    def test_frames_that_are_done_are_kept(self):
        self.assertEqual(self.status()[0], 3)
        done = self.node("--frames", "1-2")
        self.assertEqual(done.returncode, 0, done.stdout)
        self.assertEqual(self.pictures(), ["shot_0001.exr", "shot_0002.exr"])
        said = ["not done yet: 3", "2 of 3 frames done, 0 failed, 1 left"]
        self.assertEqual(self.status()[1].splitlines(), said)

        kept, whole = self.picture(1).stat().st_mtime_ns, self.picture(2).read_bytes()
        self.picture(2).write_bytes(whole[:-100])
        killed = self.output / "farm/partial/0002/node-1"  # what a run that was killed leaves
        killed.mkdir(parents=True)
        (killed / "picture_0002.exr").write_bytes(whole[:50])
        for task in range(3):
            done = self.node("--task", task)
            self.assertEqual(done.returncode, 0, done.stdout)
        self.assertEqual(self.picture(1).stat().st_mtime_ns, kept)
        self.assertGreater(len(self.picture(2).read_bytes()), len(whole) - 100)
        self.assertFalse(killed.exists())
        self.assertEqual(self.status(), (0, "3 of 3 frames done, 0 failed, 0 left\n"))
        self.assertEqual(self.node("--task", 3).returncode, 1)

    def test_two_runs_of_a_frame(self):
        """Whichever is first clears away what the other one has."""
        with ThreadPoolExecutor(2) as pool:
            for node in pool.map(lambda _: self.node("--frames", 1), range(2)):
                self.assertEqual(node.returncode, 0, node.stdout)
        self.assertEqual(self.pictures(), ["shot_0001.exr"])
        self.assertEqual(self.status()[0], 3)

    def test_picture_of_somebody_else(self):
        """Whole, but not rendered by Velour."""
        inputs.native().images.write(self.picture(1), np.ones((60, 80, 4), np.float32))
        self.assertIn("not done yet: 1-3", self.status()[1])
        self.assertEqual(self.node("--frames", 1).returncode, 0)
        self.assertIn("not done yet: 2-3", self.status()[1])

    def test_layers_and_preferences(self):
        """A multilayer file, of whose layers one shows the model; with the node's preferences."""
        bpy.ops.wm.open_mainfile(filepath=str(self.blend))
        bpy.context.scene.view_layers.new("Empty").layer_collection.exclude = True
        bpy.ops.wm.save_mainfile()
        output = self.folder / "layers"
        options = ("--output", output, "--format", "OPEN_EXR_MULTILAYER", "--preferences")
        done = self.farm(self.blend, "--no-submit", *options)
        self.assertEqual(done.returncode, 0, done.stdout)
        self.output = output
        done = self.node("--frames", 2, environment={"BLENDER_USER_CONFIG": str(self.folder / "config")})
        self.assertEqual(done.returncode, 0, done.stdout)
        data = self.picture(2).read_bytes()
        self.assertIn(b"Empty", data)
        self.assertIn(bpy.data.images["paint.velour"].velour.sha256.encode(), data)

    def test_parts_of_a_frame(self):
        """Tasks that share a frame; the last one makes its picture."""
        self.job_of("parts", 64, "--parts", "2", "--frames", "1-2")
        for task, pictures in (
            (2, []),
            (1, []),
            (0, ["shot_0001.exr"]),
            (3, ["shot_0001.exr", "shot_0002.exr"]),
        ):
            done = self.node("--task", task)
            self.assertEqual(done.returncode, 0, done.stdout)
            self.assertEqual(self.pictures(), pictures)
        self.assertEqual(self.status(), (0, "2 of 2 frames done, 0 failed, 0 left\n"))
        self.assertFalse((self.output / "farm/partial/0001").exists())
        self.assert_like_one_run(1e-3)  # half floats

    def test_sequencer(self):
        """Its pictures do not say what rendered them. Sounds alone put none out."""
        bpy.ops.wm.open_mainfile(filepath=str(self.blend))
        scene, sound = bpy.context.scene, self.shots / "silence.wav"
        with wave.open(str(sound), "wb") as file:
            file.setparams((1, 2, 8000, 0, "NONE", ""))
            file.writeframes(bytes(8000))
        editor = scene.sequence_editor_create()
        strips = editor.strips if hasattr(editor, "strips") else editor.sequences
        strips.new_sound("silence", str(sound), 1, 1)
        self.save_and_make("heard")
        done = self.node("--frames", "1")
        self.assertEqual(done.returncode, 0, done.stdout)

        strips.new_scene("all of it", scene, 2, 1)
        said = self.save_and_make("seen", status=1)
        self.assertIn("'Scene' puts out its sequencer (strip 'all of it')", said)
        self.assertIn("switch off Output > Post Processing > Sequencer", said)
        self.assertFalse(self.output.exists())
        scene.render.use_sequencer = False
        self.save_and_make("off")

    def test_pictures_that_the_compositor_writes(self):
        """The job does not look at them; parts would write them with some samples alone."""
        bpy.ops.wm.open_mainfile(filepath=str(self.blend))
        scene = bpy.context.scene
        if hasattr(scene, "compositing_node_group"):  # since Blender 5
            tree = scene.compositing_node_group = bpy.data.node_groups.new("Comp", "CompositorNodeTree")
        else:
            scene.use_nodes = True
            tree = scene.node_tree
        inner = bpy.data.node_groups.new("Inner", "CompositorNodeTree")
        node = inner.nodes.new("CompositorNodeOutputFile")
        node.name = "Beside"
        tree.nodes.new("CompositorNodeGroup").node_tree = inner
        said = self.save_and_make("written")
        self.assertIn("node 'Beside' writes pictures of its own, of which the job checks none", said)
        said = self.save_and_make("shared", "--parts", "2", status=1)
        self.assertIn("mute it, or leave --parts out", said)
        node.mute = True
        self.assertNotIn("Beside", self.save_and_make("muted", "--parts", "2"))

    def test_a_noise_threshold_has_no_parts(self):
        """Said before anything is submitted."""
        bpy.ops.wm.open_mainfile(filepath=str(self.blend))
        bpy.context.scene.velour.use_noise_target = True
        said = self.save_and_make("noisy", "--parts", "2", status=1)
        self.assertIn("has a noise threshold, which looks at a whole picture", said)

    def test_what_no_frame_would_survive(self):
        """Refused before anything is submitted, but a missing model only fails the frames that show it."""
        (self.shots / "paint.velour").unlink()
        bpy.ops.wm.open_mainfile(filepath=str(self.blend))
        scene = bpy.context.scene
        said = self.save_and_make("torn")
        self.assertRegex(said, r"paint\.velour.*Find Missing Files.*\n.*frames done")
        camera, scene.camera = scene.camera, None
        self.assertIn("has no camera", self.save_and_make("blind", status=1))
        scene.timeline_markers.new("Cut", frame=1).camera = camera
        self.save_and_make("cut")
        scene.render.use_multiview = True
        self.assertIn("is stereoscopic", self.save_and_make("stereo", status=1))

    def test_more_parts_than_camera_rays(self):
        bpy.ops.wm.open_mainfile(filepath=str(self.blend))
        settings = bpy.context.scene.velour
        settings.samples, settings.split = 32, 8
        self.assertIn("too few for 5 parts", self.save_and_make("many", "--parts", "5", status=1))
        self.save_and_make("enough", "--parts", "4")
        bpy.context.view_layer.samples = 5  # camera rays
        self.save_and_make("override", "--parts", "5")

    def test_linked_libraries(self):
        """Also what a library links: frames of another state of them are refused, and jobs without them."""
        inner, outer = self.shots / "sets/inner.blend", self.shots / "outer.blend"
        inner.parent.mkdir()
        bpy.ops.wm.open_mainfile(filepath=str(self.blend))
        self._save_library(inner, bpy.data.meshes.new("Shared"))
        mesh = self._link(inner, "meshes", "Shared")
        self._save_library(outer, bpy.data.objects.new("Prop", mesh))
        bpy.context.scene.collection.objects.link(self._link(outer, "objects", "Prop"))
        self.save_and_make("linked")
        self.assertEqual(set(self.saved_job()["libraries"]), {"outer.blend", "sets/inner.blend"})
        self.assertEqual(self.node("--frames", "1").returncode, 0)
        with open(inner, "ab") as file:
            file.write(b"\0")
        done = self.node("--frames", "2")
        self.assertEqual(done.returncode, 1, done.stdout)
        self.assertIn(f"{inner} changed since the job was made", done.stdout)
        inner.unlink()
        done = self.farm(self.blend, "--no-submit", "--output", self.folder / "without")
        self.assertEqual(done.returncode, 1, done.stdout)
        self.assertIn(f"the library {inner} cannot be read", done.stdout)

    def _save_library(self, path, block):
        """A file of this data-block, which the .blend that is open then has no more."""
        bpy.data.libraries.write(str(path), {block}, path_remap="RELATIVE_ALL")
        bpy.ops.wm.open_mainfile(filepath=str(self.blend))

    def _link(self, path, kind, name):
        with bpy.data.libraries.load(str(path), link=True, relative=True) as (_found, wanted):
            setattr(wanted, kind, [name])
        return getattr(bpy.data, kind)[name]

    def test_another_blend(self):
        """What is half done is not finished from another state of the scene."""
        with open(self.blend, "ab") as file:
            file.write(b"\0")
        done = self.farm(self.blend, "--no-submit")
        self.assertEqual(done.returncode, 1, done.stdout)
        self.assertIn("is of another .blend:", done.stdout)

    def test_no_velour_here(self):
        output = self.folder / "nothing"
        done = self.farm(self.blend, "--no-submit", "--addon", "velours", "--output", output)
        self.assertEqual(done.returncode, 1, done.stdout)
        self.assertIn("there is no add-on 'velours' in this Blender", done.stdout)
        self.assertFalse(output.exists())
