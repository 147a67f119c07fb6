"""What the judge must let pass, and what it must not."""

import numpy as np

from parity import stage
from parity.case import ParityTest
from support import judge


class Controls(ParityTest):
    """The town under a sun and a sky."""

    def setUp(self):
        super().setUp()
        stage.town()
        self.sun = stage.sharp_sun()
        stage.world(strength=0.3)
        self.camera = stage.camera()

    def test_other_seeds_pass(self):
        for engine in ("CYCLES", "VELOUR"):
            with self.subTest(engine):
                verdict = judge.judge_renders(self.pictures(engine), self.pictures(engine, first_seed=100))
                self.assertTrue(verdict.agrees, verdict)
                self.assertTrue(0.8 < verdict.rms < 1.25, verdict)

    def test_one_percent_of_exposure_fails(self):
        theirs = self.pictures("CYCLES")
        self.assertTrue(judge.judge_renders(self.pictures("VELOUR"), theirs).agrees)
        self.sun.data.energy *= 1.01
        self.scene.world.node_tree.nodes["Background"].inputs["Strength"].default_value *= 1.01
        self.assertFalse(judge.judge_renders(self.pictures("VELOUR"), theirs).agrees)

    def test_half_a_pixel_fails(self):
        theirs = self.pictures("CYCLES")
        self.camera.data.shift_x += 0.5 / self.scene.render.resolution_x
        self.assertFalse(judge.judge_renders(self.pictures("VELOUR"), theirs).agrees)

    def test_half_a_lamp_fails(self):
        theirs = self.pictures("CYCLES")
        self.sun.data.energy /= 2
        self.assertFalse(judge.judge_renders(self.pictures("VELOUR"), theirs).agrees)


class Scores(ParityTest):
    """Student's t as normal deviates."""

    def test_normal_score(self):
        # Two-sided tails of 0.05 and 0.001, from tables: normal deviates 1.960 and 3.291.
        for freedom, t in ((3, (3.182, 12.924)), (10, (2.228, 4.587)), (120, (1.980, 3.373))):
            scores = judge.normal_score(np.array(t), float(freedom))
            np.testing.assert_allclose(scores, (1.960, 3.291), rtol=0.025)

    def test_noiseless_pictures(self):
        flat = np.full((4, 20, 20, 3), 0.5)
        self.assertTrue(judge.judge_renders(flat, flat).agrees)
        self.assertFalse(judge.judge_renders(flat * 1.01, flat).agrees)
