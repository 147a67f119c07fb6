"""Render targets."""

from .errors import asking_for
from .shaders import average_shader


class Targets:
    """Render targets of one size: the latest image, and the average of all images."""

    def __init__(self, gpu, size):
        self.size = size
        with asking_for(f"images of {size[0]} x {size[1]} pixels"):
            self.drawn = gpu.types.GPUOffScreen(*size, format="RGBA16F")
            self._means = [gpu.types.GPUOffScreen(*size, format="RGBA32F") for _ in range(2)]

    def free(self):
        for target in (self.drawn, *self._means):
            target.free()

    def average(self, gpu, share):
        """Blends the latest image into the average with weight `share`; 1 replaces the average."""
        shader = average_shader()
        before, after = self._means
        with after.bind():
            gpu.state.blend_set("NONE")
            shader.bind()
            shader.uniform_sampler("average", _texture(before if share < 1 else self.drawn))
            shader.uniform_sampler("latest", _texture(self.drawn))
            shader.uniform_float("share", share)
            full_screen(shader).draw(shader)
        self._means = [after, before]

    def mean(self):
        return _texture(self._means[0])


def full_screen(shader):
    from gpu_extras.batch import batch_for_shader

    corners = ((-1, -1), (1, -1), (1, 1), (-1, 1))
    return batch_for_shader(shader, "TRIS", {"position": corners}, indices=((0, 1, 2), (0, 2, 3)))


def _texture(target):
    texture = getattr(target, "texture_color", None)
    return texture if texture is not None else target.color_texture
