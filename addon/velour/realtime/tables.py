"""The library's tables of a material as textures, and their parameters for its shader."""

from __future__ import annotations

import numpy as np

from .shaders import btf_shader, lobes_shader, picture_shader
from .textures import array_texture, texture, volume_texture

MOST_TERMS = 512  # maximum for a BTF, since each pixel evaluates all of them
_WORKING = 17  # pixel in the first row of terms where the matrix to the working space starts


class LobeTables:
    """Tables of a BRDF."""

    shader = staticmethod(lobes_shader)
    is_shell = False

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


class PrincipledTables(LobeTables):
    """Tables of a Principled material, whose colors are already in the working space."""

    def __init__(self, gpu, job, _to_working):
        super().__init__(gpu, job, np.eye(3, dtype=np.float32))


class BlackTables(PrincipledTables):
    """Tables of a material with a base color texture, for the color black."""

    shader = staticmethod(picture_shader)


class WhiteTables:
    """Table for the color white; other colors are linear interpolations between black and white."""

    is_shell = False

    def __init__(self, picture, gpu, job, _to_working):
        self._gpu, self._picture = gpu, picture
        self._rows = texture(gpu, job.result_table())

    def bind(self, shader):
        shader.uniform_sampler("white_rows", self._rows)
        self._picture.bind(self._gpu, shader)


class BtfTables:
    """Tables of a BTF of SRBFs: the side above, and the one below if there is one."""

    shader = staticmethod(btf_shader)
    is_shell = False

    def __init__(self, gpu, job, to_working):
        table, report = job.result_table(), job.report()
        layers = sum(side["layers"] for side in report["sides"])
        self._terms = texture(gpu, _terms(report, to_working))
        self._maps = array_texture(gpu, table.reshape(layers, -1, *table.shape[1:]))
        self._layout = len(report["sides"]), int(report["root"])

    def layout(self, narrow):
        """`narrow`: number of environment lobes that follow the lights."""
        return *self._layout, narrow

    def bind(self, shader):
        shader.uniform_sampler("btf_terms", self._terms)
        shader.uniform_sampler("btf_maps", self._maps)


class ShellTables:
    """Tables of a VOTF, in addition to those of its material."""

    is_shell = True

    def __init__(self, gpu, job, _to_working):
        table, report = job.result_table(), job.report()
        terms = [report[name] for name in ("bottom", "top", "reference", "aspect", "reach", "open")]
        self._terms = texture(gpu, np.array((*terms, 0, 0), np.float32).reshape(1, 2, 4))
        self._maps = volume_texture(gpu, table.reshape(report["layers"], -1, *table.shape[1:]))

    def bind(self, shader):
        shader.uniform_sampler("shell_terms", self._terms)
        shader.uniform_sampler("shell_maps", self._maps)


def _terms(report, to_working):
    """[rows x width x 4], as read by btf.frag.glsl."""
    sides, levels = report["sides"], report["levels"]
    most = max(len(side["terms"]) for side in sides)
    pixels = np.zeros((1 + 2 * len(sides), max(4 * most, _WORKING + 3), 4), np.float32)
    pixels[0, 0, :2] = len(levels), report["aspect"]
    pixels[0, 1 : 1 + len(levels), :3] = levels
    pixels[0, _WORKING : _WORKING + 3, :3] = to_working.T
    layer = 0
    for i, side in enumerate(sides):
        pixels[1 + 2 * i, 0] = len(side["terms"]), layer, side["bottom"], side["top"]
        layer += side["layers"]
        for k, term in enumerate(side["terms"]):
            pixels[2 + 2 * i, 4 * k : 4 * k + 4] = _term_pixels(term)
    return pixels


def _term_pixels(term):
    lengths = sum(np.linalg.norm(term[name]) for name in ("light", "view", "half")) + abs(term["phase"])
    return (
        (*term["light"], term["phase"]),
        (*term["view"], float(term["in_tile"])),
        (*term["half"], lengths),
        (*term["color"], 0.0),
    )
