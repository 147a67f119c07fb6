"""Float textures from numpy arrays."""

import numpy as np

from .errors import asking_for


def texture(gpu, table):
    """Texture from [height x width x 4]."""
    height, width = table.shape[:2]
    return _texture(gpu, (width, height), table, format="RGBA32F")


def half_texture(gpu, table):
    """Half float texture from [height x width x 4]."""
    height, width = table.shape[:2]
    return _texture(gpu, (width, height), table, format="RGBA16F")


def array_texture(gpu, tables):
    """Half float array texture from [layers x height x width x 4]."""
    layers, height, width = tables.shape[:3]
    return _texture(gpu, (width, height), tables, layers=layers, format="RGBA16F")


def volume_texture(gpu, tables):
    """Half float 3D texture from [depth x height x width x 4]."""
    depth, height, width = tables.shape[:3]
    return _texture(gpu, (width, height, depth), tables, format="RGBA16F")


def _texture(gpu, size, values, **kind):
    values = np.ascontiguousarray(values, np.float32).reshape(-1)
    with asking_for(f"a texture of {' x '.join(map(str, size))} pixels"):
        return gpu.types.GPUTexture(size, data=gpu.types.Buffer("FLOAT", values.size, values), **kind)
