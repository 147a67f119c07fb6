"""numpy arrays as textures of floats."""

import numpy as np


def texture(gpu, table):
    """Of [height x width x 4]."""
    height, width = table.shape[:2]
    return gpu.types.GPUTexture((width, height), format="RGBA32F", data=_buffer(gpu, table))


def half_texture(gpu, table):
    """The same in half floats."""
    height, width = table.shape[:2]
    return gpu.types.GPUTexture((width, height), format="RGBA16F", data=_buffer(gpu, table))


def array_texture(gpu, tables):
    """Of [layers x height x width x 4]."""
    layers, height, width = tables.shape[:3]
    data = _buffer(gpu, tables)
    return gpu.types.GPUTexture((width, height), layers=layers, format="RGBA16F", data=data)


def volume_texture(gpu, tables):
    """Of [depth x height x width x 4]."""
    depth, height, width = tables.shape[:3]
    return gpu.types.GPUTexture((width, height, depth), format="RGBA16F", data=_buffer(gpu, tables))


def _buffer(gpu, values):
    values = np.ascontiguousarray(values, np.float32).reshape(-1)
    return gpu.types.Buffer("FLOAT", values.size, values)
