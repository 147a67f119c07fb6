"""The picture of a rendered viewport, on its way to the screen. Nothing headless comes here."""

import gpu
import numpy as np
from gpu_extras.presets import draw_texture_2d


class ViewportPicture:
    """Scene-linear, premultiplied; Blender applies the view transform to what is drawn."""

    def __init__(self):
        self._pixels = np.empty(0, np.float32)
        self._texture = None

    def read(self, job, exposure):
        """Takes the job's picture, where there is one; it as Picture."""
        count = 4 * job.size[0] * job.size[1]
        if self._pixels.size != count:
            self._pixels = np.empty(count, np.float32)
        picture = job.read(self._pixels)
        if picture.width == 0:
            return picture
        values = self._pixels[: 4 * picture.width * picture.height]
        if exposure != 1.0:
            values.reshape(-1, 4)[:, :3] *= exposure
        np.clip(values, -_HALF_MAX, _HALF_MAX, out=values)
        buffer = gpu.types.Buffer("FLOAT", values.size, values)
        self._texture = gpu.types.GPUTexture((picture.width, picture.height), format="RGBA16F", data=buffer)
        return picture

    def draw(self, engine, scene, place):
        if self._texture is None:
            return
        gpu.state.blend_set("ALPHA_PREMULT")
        engine.bind_display_space_shader(scene)
        draw_texture_2d(self._texture, place[:2], place[2], place[3])
        engine.unbind_display_space_shader()
        gpu.state.blend_set("NONE")


_HALF_MAX = 65504.0
