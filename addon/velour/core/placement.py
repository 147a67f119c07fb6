"""How a tiled texture lies on a mesh: the map of its coordinates, and the sizes that come of it.

A map [2 x 3] takes (u, v, 1) of the mesh to tiles: the texture repeats with every whole number.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

LARGEST_STRETCH = 2.0  # that is not worth a warning
LEAST_SHARE = 0.01  # of the surface: smaller spots do not show


def texture_map(repeats, rotation=0.0, offset=(0.0, 0.0), metric=(1.0, 1.0)) -> np.ndarray:
    """A tile's lower left corner lies at `offset` (u, v) and the tile is turned there, counter-clockwise by
    `rotation` (radians); `repeats` of them fit a unit along the tile's own x and y.

    metric: how long u and v are in that unit. (1, 1): it is that of u and v themselves, so that a rotation on
    a mesh whose u and v are not equally long shears.
    """
    c, s = np.cos(rotation), np.sin(rotation)
    linear = np.diag(repeats) @ ((c, s), (-s, c)) @ np.diag(metric)
    return np.column_stack((linear, -linear @ np.asarray(offset, float)))


class Surface(NamedTuple):
    """Triangles with texture coordinates: two edges of each."""

    edges: np.ndarray  # [n x 2 x 3]
    uv_edges: np.ndarray  # [n x 2 x 2]
    centers: np.ndarray  # [n x 3]

    @classmethod
    def of(cls, positions: np.ndarray, triangles: np.ndarray, corner_uvs: np.ndarray) -> Surface:
        """positions [v x 3], triangles [n x 3], corner_uvs [n x 3 x 2]."""
        corners = positions[triangles]
        return cls(
            corners[:, 1:] - corners[:, :1], corner_uvs[:, 1:] - corner_uvs[:, :1], corners.mean(axis=1)
        )


class UvMetric(NamedTuple):
    """Of each triangle; those without extent have an area or a determinant of 0."""

    area: np.ndarray  # [n] m^2
    gram: np.ndarray  # [n x 2 x 2] products of the gradients of u and v, 1/m^2

    @classmethod
    def of(cls, surface: Surface, to_metres: np.ndarray) -> UvMetric:
        """`to_metres` [3 x 3] takes the mesh's own space to metres."""
        edges = surface.edges.astype(np.float64) @ np.asarray(to_metres, np.float64).T
        products = edges @ edges.transpose(0, 2, 1)  # the surface's own metric in the basis of the edges
        determinant = _determinants(products)
        inverse = np.empty_like(products)
        inverse[:, 0, 0], inverse[:, 1, 1] = products[:, 1, 1], products[:, 0, 0]
        inverse[:, 0, 1] = inverse[:, 1, 0] = -products[:, 0, 1]
        with np.errstate(divide="ignore", invalid="ignore"):
            inverse /= determinant[:, None, None]
            gram = surface.uv_edges.transpose(0, 2, 1).astype(np.float64) @ inverse @ surface.uv_edges
        area = 0.5 * np.sqrt(np.maximum(determinant, 0))
        area[~np.isfinite(gram).all(axis=(1, 2))] = 0
        gram[area == 0] = 0
        return cls(area, gram)

    def placed(self, uv_map: np.ndarray) -> UvMetric:
        """The same of the coordinates that a map makes."""
        linear = np.asarray(uv_map)[:, :2]
        return UvMetric(self.area, linear @ self.gram @ linear.T)

    @property
    def is_flat(self) -> bool:
        """True where texture coordinates have no extent on any part of the surface."""
        return not self._good.any()

    def density(self) -> tuple[float, float]:
        """Median over the surface of how fast u and v grow, 1/m."""
        good = self._good
        grow = np.sqrt(self.gram[good][:, (0, 1), (0, 1)])
        return tuple(float(quantiles(column, self.area[good], (0.5,))[0]) for column in grow.T)

    def scales(self) -> np.ndarray:
        """[n] of each triangle: the geometric mean over directions of tiles (or units of u, v) a metre."""
        return np.maximum(_determinants(self.gram), 0) ** 0.25

    def stretches(self) -> np.ndarray:
        """[n] of each triangle: the longest direction over the shortest; infinite without extent."""
        half = 0.5 * (self.gram[:, 0, 0] + self.gram[:, 1, 1])
        root = np.hypot(0.5 * (self.gram[:, 0, 0] - self.gram[:, 1, 1]), self.gram[:, 0, 1])
        # Largest times least is the determinant; their difference would cancel.
        with np.errstate(divide="ignore", invalid="ignore"):
            ratio = (half + root) / np.sqrt(np.maximum(_determinants(self.gram), 0))
        return np.where(self._good, ratio, np.inf)

    @property
    def _good(self) -> np.ndarray:
        return (self.area > 0) & (_determinants(self.gram) > 0)


class Lie(NamedTuple):
    """What a placement comes to on a surface. Quantiles are by area."""

    scale: float  # tiles a metre, median
    spread: tuple[float, float]  # of tiles' size over its median: 10 % are smaller, 10 % larger
    stretched: float  # share of the surface where tiles are stretched by more than LARGEST_STRETCH
    stretch: float  # that 1 % of the surface exceeds
    worst: int  # the most stretched triangle

    @property
    def is_stretched(self) -> bool:
        return self.stretched > LEAST_SHARE


def lie_of(tiles: UvMetric) -> Lie:
    """`tiles`: placed, in units that are squares where a tile is not stretched. Not of a flat one."""
    scales, stretches = tiles.scales(), tiles.stretches()
    good = scales > 0
    low, scale, high = quantiles(scales[good], tiles.area[good], (0.1, 0.5, 0.9))
    seen = tiles.area > 0
    return Lie(
        scale=float(scale),
        spread=(float(scale / high), float(scale / low)),
        stretched=float(tiles.area[stretches > LARGEST_STRETCH].sum() / tiles.area.sum()),
        stretch=float(quantiles(stretches[seen], tiles.area[seen], (0.99,))[0]),
        worst=int(np.argmax(np.where(good, stretches, 0))),
    )


def quantiles(values: np.ndarray, weights: np.ndarray, shares) -> np.ndarray:
    """Values below which the given shares of the weight lie."""
    order = np.argsort(values, kind="stable")
    below = np.cumsum(weights[order])
    places = np.searchsorted(below, np.asarray(shares) * below[-1])
    return values[order][np.minimum(places, len(values) - 1)]


def _determinants(matrices: np.ndarray) -> np.ndarray:
    return matrices[:, 0, 0] * matrices[:, 1, 1] - matrices[:, 0, 1] * matrices[:, 1, 0]
