"""The base of parity tests."""

import contextlib
import io
import json

import addon_utils
import bpy

from support import blender, level
from support.judge import judge_renders

from . import engines, stage

ALWAYS, NEVER = (0,), (99,)
SEEN = 5.0


class ParityTest(blender.BlenderTest):
    """Starts from an empty file set up for both engines."""

    bounces = 0
    effort = engines.USUAL

    def setUp(self):
        super().setUp()
        addon_utils.enable("cycles")
        self.scene = engines.set_up(self.bounces, self.effort)

    def pictures(self, engine, samples=1, first_seed=0):
        return engines.pictures(engine, self.folder, samples, first_seed, self.effort)

    def verdict(self, samples=1):
        theirs = self.pictures("CYCLES", samples)
        self.assertGreater(float(theirs[..., :3].std(axis=(1, 2)).max()), 0.0, "The scene shows nothing.")
        return judge_renders(self.pictures("VELOUR", samples), theirs)

    @contextlib.contextmanager
    def whole_effort(self):
        """Small mismatches are seen."""
        before, self.effort = self.effort, engines.WHOLE
        engines.set_size(self.effort)
        yield
        self.effort = before
        engines.set_size(self.effort)

    def assert_parity(self, feature, samples=1, seen=SEEN, up_to=0.0):
        """Both engines render the scene as it is; no block may differ by more than chance. `seen`: per cent
        that half of the blocks may be off by at most without being seen. `up_to`: per cent of the mean of a
        known difference, which the samples of scripts/test --all alone can tell."""
        verdict = self.verdict(samples)
        record(feature, verdict, "approximated" if up_to else "honored")
        known = level.LONG and verdict.percent <= up_to
        self.assertTrue(verdict.agrees or known, f"{feature}: {verdict}")
        self.assertLess(verdict.sees, seen, f"{feature}: it needs more samples. {verdict}")

    def assert_approximate(self, feature, most_percent, samples=1, exact=None):
        """A known mismatch, which may not grow. `exact`: the Blender from which on there is none, and the one
        from which on there is again."""
        if exact is not None and exact[0] <= bpy.app.version < exact[1]:
            return self.assert_parity(feature, samples)
        verdict = self.verdict(samples)
        if verdict.agrees or verdict.percent > most_percent:
            with self.whole_effort():
                verdict = self.verdict(samples)
        record(feature, verdict, "approximated")
        self.assertFalse(verdict.agrees, f"{feature} is exact by now: say so. {verdict}")
        self.assertLessEqual(verdict.percent, most_percent, f"{feature}: {verdict}")
        return None

    def assert_ignored(self, feature, sentence):
        """What Velour leaves out, and says so before it renders."""
        said = io.StringIO()
        with contextlib.redirect_stdout(said):
            ours = self.pictures("VELOUR")
        verdict = judge_renders(ours, self.pictures("CYCLES"))
        record(feature, verdict, "ignored with a warning")
        self.assertFalse(verdict.agrees, f"{feature} makes no difference here. {verdict}")
        self.assertIn(sentence, said.getvalue())


class TownTest(ParityTest):
    """Boxes under a sharp sun, seen at an angle."""

    def setUp(self):
        super().setUp()
        stage.town()
        stage.sharp_sun()
        self.camera = stage.camera()
        self.lens = self.camera.data


class BoxTest(ParityTest):
    """A box on a ground, seen from above; lamps are out of the picture."""

    def setUp(self):
        super().setUp()
        stage.ground(12, 0.6)
        stage.box((-0.6, -0.4, 0.3), (0.2, 0.3, 0.9), 0.8)
        stage.camera((0, 0, 9), (0, 0, 0), 50)


def record(feature, verdict, word):
    record_row(feature, word, percent=verdict.percent, z=verdict.z, sees=verdict.sees)


def record_row(feature, word, **numbers):
    """A line for the table of docs/results/blender_parity.md."""
    row = {"feature": feature, "verdict": word, **numbers, "blender": bpy.app.version_string}
    with (blender.folder() / "rows.jsonl").open("a") as file:
        file.write(json.dumps(row) + "\n")
