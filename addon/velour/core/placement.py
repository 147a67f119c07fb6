"""Placement of a tiled texture on a mesh: the map of its coordinates, and the resulting sizes.

A map [2 x 3] takes the mesh's (u, v, 1) to tile coordinates: the texture repeats at every integer.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

LARGEST_STRETCH = 2.0  # largest ratio that is not worth a warning
LEAST_SHARE = 0.01  # share of the surface; smaller spots are not noticeable
DEFAULT_TILES = 20  # along the longest side of an object
REAL_SIZE_TILES = (4, 400)  # as many in real size can be told apart, and seen as tiles at all
_LEAST_WHOLE = 10  # repeats whose rounding changes sizes by at most 5 %


def texture_map(repeats, rotation=0.0, offset=(0.0, 0.0), metric=(1.0, 1.0)) -> np.ndarray:
    """The map that puts a tile's lower left corner at `offset` (u, v) and rotates the tile there
    counter-clockwise by `rotation` (radians); `repeats` tiles fit a unit along the tile's own x and y.

    metric: lengths of u and v in that unit. (1, 1): the unit is that of u and v, so that a rotation shears
    on a mesh whose u and v differ in length.
    """
    c, s = np.cos(rotation), np.sin(rotation)
    linear = np.diag(repeats) @ ((c, s), (-s, c)) @ np.diag(metric)
    return np.column_stack((linear, -linear @ np.asarray(offset, float)))


def tiles_along(extent: float, side: float | None) -> float:
    """Number of tiles along the longest side of an object, `extent`: in real size if `side`, the length of a
    tile, is known and gives a number within REAL_SIZE_TILES."""
    low, high = REAL_SIZE_TILES
    return extent / side if side and low * side <= extent <= high * side else DEFAULT_TILES


def repeats_of(sides, density) -> tuple[float, ...]:
    """Tiles per unit of u and v, for tiles of these sides (m) where u and v have this density (1/m)."""
    return tuple(1.0 / (side * d) for side, d in zip(sides, density, strict=True))


def whole(repeats) -> tuple[float, ...]:
    """Large repeats as whole numbers, so that tiles meet where a UV map wraps around."""
    return tuple(float(round(n)) if n >= _LEAST_WHOLE else n for n in repeats)


class Surface(NamedTuple):
    """Triangles with texture coordinates, as two edges each."""

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
    """Dot products of the gradients of u and v of each triangle, in 1/m^2; all 0 without extent."""

    area: np.ndarray  # [n] m^2
    gram: np.ndarray  # [3 x n] u u, u v, v v

    @classmethod
    def of(cls, surface: Surface, to_metres: np.ndarray) -> UvMetric:
        """`to_metres` [3 x 3] takes the mesh's own space to meters."""
        a, b = surface.edges.transpose(1, 0, 2) @ np.asarray(to_metres, np.float64).T
        p, q = surface.uv_edges.astype(np.float64).transpose(1, 2, 0)
        aa, ab, bb = (np.einsum("ni,ni->n", x, y) for x, y in ((a, a), (a, b), (b, b)))
        square = aa * bb - ab * ab  # square of twice the area
        # The metric of the surface in the basis of its edges is [[aa, ab], [ab, bb]]: this is its inverse.
        gram = np.stack(
            [
                p[i] * p[j] * bb - (p[i] * q[j] + q[i] * p[j]) * ab + q[i] * q[j] * aa
                for i, j in ((0, 0), (0, 1), (1, 1))
            ]
        )
        with np.errstate(divide="ignore", invalid="ignore"):
            gram /= square
        good = (square > 0) & np.isfinite(gram).all(axis=0)
        gram[:, ~good] = 0
        return cls(np.where(good, 0.5 * np.sqrt(np.maximum(square, 0)), 0), gram)

    def placed(self, uv_map: np.ndarray) -> UvMetric:
        """The metric of the coordinates that a map produces."""
        (a, b), (c, d) = np.asarray(uv_map)[:, :2]
        uu, uv, vv = self.gram
        return UvMetric(
            self.area,
            np.stack(
                [
                    a * a * uu + 2 * a * b * uv + b * b * vv,
                    a * c * uu + (a * d + b * c) * uv + b * d * vv,
                    c * c * uu + 2 * c * d * uv + d * d * vv,
                ]
            ),
        )

    @property
    def is_flat(self) -> bool:
        """True if texture coordinates have no extent on any part of the surface."""
        return not (self._determinants() > 0).any()

    def density(self) -> tuple[float, float]:
        """Median over the surface of the lengths of the gradients of u and v, in 1/m."""
        good = self._determinants() > 0
        return tuple(
            float(quantiles(np.sqrt(square[good]), self.area[good], (0.5,))[0])
            for square in self.gram[(0, 2), :]
        )

    def scales(self) -> np.ndarray:
        """[n] Tiles (or units of u, v) per meter on each triangle: the geometric mean over directions."""
        return self._determinants() ** 0.25

    def stretches(self) -> np.ndarray:
        """[n] Ratio of the longest to the shortest direction of each triangle; infinite without extent."""
        uu, uv, vv = self.gram
        largest = 0.5 * (uu + vv) + np.hypot(0.5 * (uu - vv), uv)
        # The determinant is the product of both eigenvalues; a difference for the smaller one would cancel.
        root = np.sqrt(self._determinants())
        return np.divide(largest, root, out=np.full_like(root, np.inf), where=root > 0)

    def _determinants(self) -> np.ndarray:
        uu, uv, vv = self.gram
        return np.maximum(uu * vv - uv * uv, 0)


class Lie(NamedTuple):
    """Statistics of a placement on a surface. Quantiles are by area."""

    scale: float  # tiles per meter, median
    spread: tuple[float, float]  # 10 % and 90 % quantiles of the tiles' size over its median
    stretched: float  # share of the surface where tiles are stretched by more than LARGEST_STRETCH
    stretch: float  # 99 % quantile
    worst: int  # the most stretched triangle

    @property
    def is_stretched(self) -> bool:
        return self.stretched > LEAST_SHARE


def lie_of(tiles: UvMetric) -> Lie:
    """`tiles`: placed, in units that are square where a tile is not stretched; it must not be flat."""
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
    order = np.argsort(values)
    below = np.cumsum(weights[order])
    places = np.searchsorted(below, np.asarray(shares) * below[-1])
    return values[order][np.minimum(places, len(values) - 1)]
