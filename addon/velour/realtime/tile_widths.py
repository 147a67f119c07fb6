"""Width of a tile that covers one unit of texture coordinates, which scales the height of VOTFs."""

from __future__ import annotations

import numpy as np


class TileWidths:
    def __init__(self, positions, uvs, triangles, slots):
        """Corner positions [n x 3] and UVs [n x 2] of `triangles` [m x 3] with these material slots."""
        corner, place = positions[triangles].astype(float), uvs[triangles].astype(float)
        self._across = np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0])
        along, beside = place[:, 1] - place[:, 0], place[:, 2] - place[:, 0]
        covered = np.abs(along[:, 0] * beside[:, 1] - along[:, 1] * beside[:, 0])
        self._covered = np.where(np.isfinite(covered), covered, 0.0)
        self._across[~np.isfinite(covered)] = 0
        self._slots = np.zeros(len(triangles), int) if slots is None else slots

    def of_instances(self, matrices, slot, last_slot, stretch, aspect):
        """Tile widths in meters of instances [n x 3 x 4], as in Scene::tile_width; 0 if there is no area.

        `stretch`: scale of areas in texture coordinates. Slots beyond the last one count as the last.
        """
        chosen = np.minimum(self._slots, last_slot) == slot
        tiles = self._covered[chosen].sum() * stretch * aspect
        if not tiles > 0:
            return np.zeros(len(matrices))
        across, known = self._across[chosen], {}
        return np.array([_width(across, tiles, matrix[:, :3], known) for matrix in matrices])


def _width(across, tiles, matrix, known):
    """`known`: cache of widths, shared by matrices that differ only by a rotation."""
    metric = (matrix.astype(float).T @ matrix).astype(np.float32).tobytes()
    if metric not in known:
        x, y, z = matrix.astype(float)
        cofactors = np.stack((np.cross(y, z), np.cross(z, x), np.cross(x, y)))
        known[metric] = np.sqrt(np.linalg.norm(across @ cofactors.T, axis=1).sum() / tiles)
    return known[metric]
