"""scripts/farm: frames that an engine ends, or their own time limit, and that the next run goes on with."""

import bpy

from support.farm import FarmTest

_ONE_PASS = 0.001  # seconds: any pass takes longer
_TURN = "    while not job.wait(timeout=_POLL_SECONDS):\n"
# What an engine does: the program that runs Blender is told to end, once.
_END_NODE = """
        if job.poll().fraction > 0.05 and not _Clock.__dict__.get("told"):
            _Clock.told = True
            import os, signal
            os.kill(os.getppid(), signal.SIGTERM)
"""


class FarmEnds(FarmTest):
    def test_a_frame_that_the_engine_ends_goes_on(self):
        self.job_of("ended", 500)
        ended = self.another_stage("ends", "engine/final.py", _TURN, _TURN + _END_NODE)
        done = self.node("--frames", "1-2", environment=ended)
        self.assertEqual(done.returncode, 3, done.stdout)
        self.assertIn("frame 1: ended by SIGTERM; the next run goes on from there", done.stdout)
        (film,) = (self.output / "farm/partial/0001/film").glob("*.exr")
        status, said = self.status()
        self.assertEqual((status, said.splitlines()[0]), (3, "not done yet: 1-3"))
        end = self.film_end(1)
        done = self.node("--frames", "1")
        self.assertEqual(done.returncode, 0, done.stdout)
        self.assertFalse(film.exists())
        self.assertGreaterEqual(self.first_sample(1), end)
        self.assert_like_one_run(0)

    def test_a_frame_that_is_ended_while_it_is_written(self):
        """It is done, and no other begins."""
        self.job_of("written", 64)
        told = "def _forget_written(scene, *_args):\n"
        kill = "    import os, signal, time; os.kill(os.getppid(), signal.SIGTERM); time.sleep(1)\n"
        ended = self.another_stage("writes", "engine/frame_parts.py", told, told + kill)
        done = self.node("--frames", "1-2", environment=ended)
        self.assertEqual(done.returncode, 3, done.stdout)
        self.assertEqual(self.status()[1].splitlines()[0], "not done yet: 2-3")

    def test_a_frame_out_of_time_goes_on(self):
        """Its own limit: it has not failed, and further runs get it done, to the bits of one run."""
        said = self.job_of("limited", 3, time_limit=_ONE_PASS)
        self.assertIn("a time limit of 0.001 s: a frame that it ends is left, and the next run goes on", said)
        failure = self.output / "farm/failed/0001.txt"
        failure.write_text("An attempt before.\n")
        done = self.node("--frames", "1-2")
        self.assertEqual(done.returncode, 3, done.stdout)
        for frame in (1, 2):
            self.assertIn(f"frame {frame}: ended by the .blend's own time limit; the next run", done.stdout)
        self.assertFalse(failure.exists())
        self.assertEqual(self.status(), (3, "not done yet: 1-3\n0 of 3 frames done, 0 failed, 3 left\n"))
        for end, code in ((1, 3), (2, 0)):
            self.assertEqual(self.film_end(1), end)
            done = self.node("--frames", "1")
            self.assertEqual(done.returncode, code, done.stdout)
        self.assertEqual(self.pictures(), ["shot_0001.exr"])
        self.assert_like_one_run(0)

    def test_a_noise_threshold_out_of_time(self):
        """It cannot be gone on with: what there is counts as done, and is told before."""
        bpy.ops.wm.open_mainfile(filepath=str(self.blend))
        bpy.context.scene.velour.use_noise_target = True
        bpy.context.scene.velour.noise_target = 1e-4
        bpy.ops.wm.save_mainfile()
        said = self.job_of("noisy", 1 << 20, time_limit=_ONE_PASS)
        self.assertIn("a frame that it ends above the noise threshold counts as done", said)
        done = self.node("--frames", "1")
        self.assertEqual(done.returncode, 0, done.stdout)
        self.assertIn("1 of 3 frames done, 0 failed, 2 left", self.status()[1])
