"""The library's tables of a material as textures, and what its shader is told of them."""

from __future__ import annotations

import numpy as np

from .shaders import btf_shader, lobes_shader
from .textures import array_texture, texture, volume_texture

MOST_TERMS = 512  # of a BTF: a pixel looks at all of them
_WORKING = 17  # pixel of the first row of terms


class LobeTables:
    """Of a BRDF."""

    shader = staticmethod(lobes_shader)

    def __init__(self, gpu, job, to_working):
        table, report = job.result_table(), job.report()
        table[:, 1::2, :3] = table[:, 1::2, :3] @ to_working.T
        self._rows = texture(gpu, table)
        side = report["side"] if report["isotropic"] else -report["side"]
        self._layout = report["lobes"], side, int(report["blends"])

    def layout(self, _narrow):
        return self._layout

    def bind(self, shader):
        shader.uniform_sampler("lobe_rows", self._rows)


class BtfTables:
    """Of a BTF of SRBFs."""

    shader = staticmethod(btf_shader)

    def __init__(self, gpu, job, to_working):
        table, report = job.result_table(), job.report()
        self._terms = texture(gpu, _terms(report, to_working))
        self._maps = array_texture(gpu, table.reshape(report["layers"], -1, *table.shape[1:]))
        self._layout = len(report["terms"]), int(report["root"])

    def layout(self, narrow):
        """`narrow`: how many lobes of the world stand behind the lamps."""
        return *self._layout, narrow

    def bind(self, shader):
        shader.uniform_sampler("btf_terms", self._terms)
        shader.uniform_sampler("btf_maps", self._maps)


class ShellTables:
    """Of an outline, beside those of its material."""

    def __init__(self, gpu, job, _to_working):
        table, report = job.result_table(), job.report()
        terms = [report[name] for name in ("bottom", "top", "reference", "aspect")]
        self._terms = texture(gpu, np.array(terms, np.float32).reshape(1, 1, 4))
        self._maps = volume_texture(gpu, table.reshape(report["layers"], -1, *table.shape[1:]))

    def bind(self, shader):
        shader.uniform_sampler("shell_terms", self._terms)
        shader.uniform_sampler("shell_maps", self._maps)


def _terms(report, to_working):
    """[2 x width x 4], as btf.frag.glsl reads it."""
    terms, levels = report["terms"], report["levels"]
    pixels = np.zeros((2, max(4 * len(terms), _WORKING + 3), 4), np.float32)
    pixels[0, 0] = len(levels), report["bottom"], report["top"], report["aspect"]
    pixels[0, 1 : 1 + len(levels), :3] = levels
    pixels[0, _WORKING : _WORKING + 3, :3] = to_working.T
    for i, term in enumerate(terms):
        lengths = sum(np.linalg.norm(term[name]) for name in ("light", "view", "half")) + abs(term["phase"])
        pixels[1, 4 * i : 4 * i + 4] = (
            (*term["light"], term["phase"]),
            (*term["view"], float(term["in_tile"])),
            (*term["half"], lengths),
            (*term["color"], 0.0),
        )
    return pixels
