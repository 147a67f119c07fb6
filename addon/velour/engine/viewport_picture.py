"""The picture of a rendered viewport, on its way from the job to the screen."""

import time

import numpy as np

_HALF_MAX = 65504.0


class ViewportPicture:
    """Scene-linear, premultiplied; Blender applies the view transform to what is drawn."""

    def __init__(self):
        self._pixels = np.empty(0, np.float32)
        self._size = None  # size of the last picture taken
        self._is_fresh = False  # the picture is not on the screen yet
        self._version = 0  # version of the job's picture
        self._texture = None
        self._exposure = 1.0  # exposure of the texture
        self.samples = 0
        self.shown_at = self.seconds = 0.0  # time of the last upload; time to take and upload the picture

    def begin(self):
        """Prepares for another job; the screen keeps the picture until the job has one."""
        self._version = self.samples = 0

    def is_behind(self, job):
        picture = job.picture()
        return picture.width > 0 and picture.version != self._version

    def take(self, job):
        """Copies the job's picture if it is new."""
        if not self.is_behind(job):
            return
        begin = time.monotonic()
        count = 4 * job.size[0] * job.size[1]
        if self._pixels.size != count:
            self._pixels = np.empty(count, np.float32)
        picture = job.read(self._pixels)
        self._size, self._version = (picture.width, picture.height), picture.version
        self._is_fresh, self.samples = True, picture.samples
        self.seconds = time.monotonic() - begin

    def draw(self, engine, scene, place, exposure):
        import gpu  # missing without a window, where nothing is drawn
        from gpu_extras.presets import draw_texture_2d

        if self._is_fresh:
            begin = self.shown_at = time.monotonic()
            self._upload(gpu, exposure)
            self._is_fresh = False
            self.seconds += time.monotonic() - begin
        elif self._texture and exposure != self._exposure:
            self._upload(gpu, exposure)
        if self._texture is None:
            return
        gpu.state.blend_set("ALPHA_PREMULT")
        engine.bind_display_space_shader(scene)
        draw_texture_2d(self._texture, place[:2], place[2], place[3])
        engine.unbind_display_space_shader()
        gpu.state.blend_set("NONE")

    def _upload(self, gpu, exposure):
        values = self._pixels[: 4 * self._size[0] * self._size[1]]
        if exposure != 1.0:  # a copy: the exposure may change
            values = (values.reshape(-1, 4) * np.float32((exposure, exposure, exposure, 1))).reshape(-1)
        values = np.clip(values, -_HALF_MAX, _HALF_MAX)
        buffer = gpu.types.Buffer("FLOAT", values.size, values)
        self._texture = gpu.types.GPUTexture(self._size, format="RGBA16F", data=buffer)
        self._exposure = exposure
