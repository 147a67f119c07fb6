"""Cameras: where things fall in the picture."""

from parity import stage
from parity.case import TownTest


class Camera(TownTest):
    def test_perspective(self):
        self.assert_parity("Camera: perspective")

    def test_focal_length(self):
        self.lens.lens = 21
        self.assert_parity("Camera: focal length")

    def test_sensor_fit(self):
        for fit in ("HORIZONTAL", "VERTICAL"):
            with self.subTest(fit):
                self.lens.sensor_fit = fit
                self.lens.sensor_width, self.lens.sensor_height = 40, 18
                self.assert_parity(f"Camera: sensor fit {fit.lower()}")

    def test_upright_picture(self):
        self.scene.render.resolution_x, self.scene.render.resolution_y = 96, 128
        self.assert_parity("Camera: upright picture")

    def test_shift(self):
        self.lens.shift_x, self.lens.shift_y = 0.2, -0.15
        self.assert_parity("Camera: shift")

    def test_orthographic(self):
        self.lens.type, self.lens.ortho_scale, self.lens.shift_x = "ORTHO", 5.0, 0.1
        self.assert_parity("Camera: orthographic scale and shift")

    def test_clipping(self):
        self.lens.clip_start, self.lens.clip_end = 8.0, 12.0
        for kind in ("PERSP", "ORTHO"):
            with self.subTest(kind):
                self.lens.type = kind
                self.assert_parity(f"Camera: clipping, {kind.lower()}")

    def test_pixel_aspect(self):
        self.scene.render.pixel_aspect_x = 1.6
        self.assert_parity("Camera: pixel aspect wide")
        self.scene.render.pixel_aspect_x, self.scene.render.pixel_aspect_y = 1.0, 1.4
        self.assert_parity("Camera: pixel aspect high")

    def test_scaled_camera(self):
        self.camera.scale = (2, 0.5, 3)
        self.assert_parity("Camera: scale of its object")

    def test_mirrored_camera(self):
        self.camera.scale = (-1, 1, 1)
        self.assert_parity("Camera: mirrored")

    def test_parented_camera(self):
        parent = stage.link(stage.bpy.data.objects.new("Parent", None))
        parent.rotation_euler, parent.scale = (0.1, 0.05, -0.2), (1.1, 1.2, 0.9)
        self.camera.parent = parent
        self.assert_parity("Camera: parent with scale and shear")

    def test_resolution_percentage(self):
        self.scene.render.resolution_x, self.scene.render.resolution_percentage = 200, 57
        self.assert_parity("Camera: resolution percentage")
