"""Depth of field."""

from parity import stage
from parity.case import TownTest


class DepthOfField(TownTest):
    def setUp(self):
        super().setUp()
        self.dof = self.lens.dof
        self.dof.use_dof, self.dof.focus_distance, self.dof.aperture_fstop = True, 9.0, 0.1

    def test_distance(self):
        self.assert_parity("Depth of field: f-stop and distance")

    def test_focus_object(self):
        focus = stage.link(stage.bpy.data.objects.new("Focus", None))
        focus.location = (2.0, -2.0, 0.5)
        self.dof.focus_object = focus
        self.assert_parity("Depth of field: focus on an object")

    def test_blades(self):
        self.dof.aperture_fstop, self.dof.aperture_blades, self.dof.aperture_rotation = 0.05, 3, 0.4
        self.assert_parity("Depth of field: blades and rotation")

    def test_ratio(self):
        self.dof.aperture_fstop, self.dof.aperture_ratio = 0.05, 2.0
        self.assert_parity("Depth of field: anamorphic ratio")

    def test_orthographic(self):
        self.lens.type, self.lens.ortho_scale, self.dof.aperture_fstop = "ORTHO", 6.0, 2.0
        self.assert_parity("Depth of field: orthographic")
