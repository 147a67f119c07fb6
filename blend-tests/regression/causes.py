"""What has changed between a render and its reference, told from their passes by tests with stated levels.

Each test asks only what the ones before leave open: shape, then texture coordinates, then albedo, then
light. So a moved object is no changed material, and a shifted UV map no changed texture.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from support.judge import BLOCK, WHOLE, Estimate, scores, z_limit

from .comparison import COLOR, has_worlds
from .passes import MIXED, NOTHING, Passes
from .regions import EXPLAINED, FEWEST, LEVEL, Factor, Sides, both, changed, covered, largest, regions

_MOST_NAMES = 3
_LEAST_FACTOR = 0.002  # of exposure beside other causes, whose indirect light may change everything a little
_DISTANCE = 3  # channel of "shape": grows with the distance


class Cause(NamedTuple):
    kind: str  # "geometry", "material", "world", "exposure", "light" or "unknown"
    sentence: str  # with the names of what has changed
    names: tuple[str, ...] = ()

    def __str__(self) -> str:
        return f"{self.kind}: {self.sentence}"


def find(ours: Estimate, reference: Estimate, passes: tuple[Passes, Passes]) -> list[Cause]:
    """The causes of a difference; never empty. `ours`, `reference`: RGB or RGBA."""
    sides = Sides((ours.channels(COLOR), reference.channels(COLOR)), *passes)
    causes = _in_passes(sides) or _in_passes(sides.by_most()) or _light(sides)
    return causes or [Cause("unknown", "the difference is too small, or too close to edges, to name")]


def _in_passes(sides: Sides) -> list[Cause]:
    """Causes that the passes tell; beside materials alone, exposure, too."""
    passes = sides.ours, sides.known
    thinned, explained = _transparency(sides)
    causes, of_shape = _geometry(sides, ~explained)
    explained |= of_shape
    materials, of_materials = _materials(sides, ~explained)
    materials += thinned
    causes += materials + _world(sides, alone=not (causes or materials))
    if not any(cause.kind == "geometry" for cause in causes):
        causes += _blur(passes)
    if materials and len(causes) == len(materials):
        causes += _exposure(sides, ~explained & ~of_materials, _LEAST_FACTOR)
    return causes


def _transparency(sides: Sides) -> tuple[list[Cause], np.ndarray]:
    """Materials that fill most of their pixels in one of the two only; and the pixels of their objects."""
    causes, explained = [], np.zeros(sides.known.objects.numbers.shape, bool)
    if sides.worst_only:  # names that fill half of a pixel do so in fewer pixels the more renders there are
        return causes, explained
    for side, other in ((sides.known, sides.ours), (sides.ours, sides.known)):
        for name in side.materials.names:
            mask = side.materials.where(name)
            mixed = np.count_nonzero(mask & (other.materials.numbers == MIXED))
            if mixed >= FEWEST and mixed > max(0.5 * np.count_nonzero(mask), _most_mixed(side, other, name)):
                causes.append(Cause("material", f"'{name}', its transparency", (name,)))
                explained |= mask
    return causes, explained


def _most_mixed(side: Passes, other: Passes, name: str) -> float:
    """Pixels full of a material on `side` that are mixed on the other by chance, if both are alike.

    A pixel is full if no ray of any render has passed. If a pixel of the material is so with a mean chance
    p in the renders of `side`, one that is so there is so on the other, which has r times as many, with a
    mean chance of at least p^r [Jensen], however the material's opacity varies from place to place.
    """
    labels = side.materials
    count = np.count_nonzero(labels.where(name))
    mostly = max(count, np.count_nonzero(labels.mostly == 1 + labels.names.index(name)))
    chance, times = (count + 1) / (mostly + 2), max(1.0, other.shape.seeds / side.shape.seeds)
    stays = chance**times
    variance = stays * (1 - stays) / count + (times * stays / chance) ** 2 * chance * (1 - chance) / mostly
    return count * (1 - stays + z_limit(2 * len(labels.names), LEVEL) * np.sqrt(variance))


def _geometry(sides: Sides, usable: np.ndarray) -> tuple[list[Cause], np.ndarray]:
    """The causes, and the pixels [height x width] that show them."""
    causes, stays = [], sides.stays("objects") & usable
    moved = changed(sides, "objects", "shape", stays)
    explained = covered(sides, "objects", moved)
    clear = (sides.ours.objects.numbers != MIXED) & (sides.known.objects.numbers != MIXED)
    relabeled = ~stays & clear & usable
    names = moved or _in_front(sides, relabeled)
    if not names and usable.all():
        names = _on_edges(sides)
    if names:
        explained |= relabeled
    shifted = changed(sides, "objects", "coordinates", stays & ~explained)
    if _are_all_visible(sides, {*names, *shifted}) and names:  # a plane stays in place along itself
        causes.append(Cause("geometry", "all visible objects, or the camera", (*names, *shifted)))
        return causes, explained | covered(sides, "objects", shifted)
    if names:
        sentence = f"shape or place of {_listed('object', names)}"
        causes.append(Cause("geometry", sentence, tuple(names)))
    if shifted:
        causes.append(Cause("geometry", f"UV map of {_listed('object', shifted)}", tuple(shifted)))
        explained |= covered(sides, "objects", shifted)
    return causes, explained


def _are_all_visible(sides: Sides, names: set[str]) -> bool:
    """Whether these are all of the two or more objects that the reference shows."""
    seen = {name for name in sides.known.objects.names if sides.known.objects.where(name).any()}
    return len(seen) > 1 and seen <= names


def _in_front(sides: Sides, relabeled: np.ndarray) -> list[str]:
    """The nearer one of the two objects that a pixel shows: it has come or gone."""
    ours, known = (side.shape.mean[..., _DISTANCE] for side in (sides.ours, sides.known))
    names = [
        name
        for labels, nearer in ((sides.known.objects, known <= ours), (sides.ours.objects, ours < known))
        for name in labels.names
        if (relabeled & nearer & labels.where(name)).any()
    ]
    return list(dict.fromkeys(names))


def _on_edges(sides: Sides) -> list[str]:
    """The nearest object in each block whose edges alone have changed."""
    found = scores(sides.ours.shape, sides.known.shape)
    distance = np.where(sides.known.objects.numbers > NOTHING, sides.known.shape.mean[..., _DISTANCE], np.inf)
    names = []
    for row, column in np.argwhere((found.z > z_limit(found.z.size, LEVEL)).any(axis=2)):
        block = slice(BLOCK * row, BLOCK * (row + 1)), slice(BLOCK * column, BLOCK * (column + 1))
        nearest = np.unravel_index(np.argmin(distance[block]), distance[block].shape)
        number = sides.known.objects.numbers[block][nearest]
        names += [sides.known.objects.names[number - 1]] if number > NOTHING else []
    return list(dict.fromkeys(names))


def _materials(sides: Sides, usable: np.ndarray) -> tuple[list[Cause], np.ndarray]:
    stays = sides.stays("materials") & sides.stays("objects") & usable
    names = changed(sides, "materials", "albedo", stays)
    causes = [Cause("material", f"'{name}', {_albedo(sides, name, stays)}", (name,)) for name in names]
    exchanged = (
        usable & sides.stays("objects") & ~sides.stays("materials")
        & (sides.ours.materials.numbers != MIXED) & (sides.known.materials.numbers != MIXED)
    )  # fmt: skip
    if np.count_nonzero(exchanged) >= FEWEST:
        others = _materials_in(sides, exchanged)
        causes.append(Cause("material", f"{_listed('material', others)} exchanged", tuple(others)))
    return causes, covered(sides, "materials", names) | exchanged


def _albedo(sides: Sides, name: str, stays: np.ndarray) -> str:
    """How the albedo of a material differs."""
    mask = stays & sides.known.materials.where(name)
    found, whole = both((sides.ours.albedo, sides.known.albedo), mask)
    factor = Factor.of([found])
    if factor.differs and factor.explains:
        return f"albedo times {factor}"
    mean = whole.first.sum() / max(whole.second.sum(), 1e-30)
    return f"its texture or model: albedo differs by place, times {mean:.4f} on average"


def _world(sides: Sides, alone: bool) -> list[Cause]:
    """`alone`: no other cause is known, so a common factor of the picture is due to the world or exposure."""
    passes = sides.ours, sides.known
    ours, known = (side.world for side in passes)
    if (ours is None) != (known is None):
        return [Cause("world", "only one of both has a world")]
    if not has_worlds(passes):
        return []
    blocks, whole = (scores(ours, known, block) for block in (BLOCK, WHOLE))
    if max(blocks.z.max(), whole.z.max()) <= z_limit(blocks.z.size + whole.z.size, LEVEL):
        return []
    factor = Factor.of([blocks])
    if not (factor.differs and factor.explains):
        return [Cause("world", "its directions or colors (turned, or another picture)")]
    sentence = f"its light times {factor}"
    common = _common_factor(sides, _everywhere(sides)) if alone else None
    if common is None:
        return [Cause("world", sentence)]
    if common.agrees(factor):
        return [Cause("world", f"{sentence}, and all light of the scene with it")]
    exposure = f"all colors times {common}, unlike the world (or the world is a part of the light)"
    return [Cause("world", sentence), Cause("exposure", exposure)]


def _blur(passes: tuple[Passes, Passes]) -> list[Cause]:
    """Blur that differs where sharp shapes agree."""
    ours, known = (side.blurred for side in passes)
    if ours is None and known is None:
        return []
    if ours is None or known is None:
        return [Cause("geometry", "only one of both has depth of field or motion blur")]
    blocks, whole = (scores(ours, known, block) for block in (BLOCK, WHOLE))
    if max(blocks.z.max(), whole.z.max()) <= z_limit(blocks.z.size + whole.z.size, LEVEL):
        return []
    return [Cause("geometry", "depth of field or motion blur (focus, aperture, shutter or movement)")]


def _light(sides: Sides) -> list[Cause]:
    """The picture alone differs: by a common factor, on one material, on the background, or anywhere."""
    found = _exposure(sides, _everywhere(sides))
    if found:
        return found
    tested = {name: both(sides.picture, mask) for name, mask in regions(sides).items()}
    count = sum(each.z.size for pair in tested.values() for each in pair)
    differ = [name for name, pair in tested.items() if largest(pair) > z_limit(count, LEVEL)]
    doubtful = [name for name, pair in tested.items() if largest(pair) > z_limit(count, EXPLAINED)]
    if not differ:
        return []
    if differ == doubtful == [""]:
        return [Cause("world", "the background")]
    if len(differ) == 1 and doubtful == differ and len(tested) > 1:
        sentence = f"'{differ[0]}', with the same albedo (or light that reaches it alone)"
        return [Cause("material", sentence, (differ[0],))]
    surfaces = [f"'{name}'" if name else "the background" for name in differ]
    return [Cause("light", f"lamps, shadows or indirect light, on {_shortened(surfaces)}")]


def _exposure(sides: Sides, mask: np.ndarray, least: float = 0.0) -> list[Cause]:
    """`least`: difference of the factor from 1."""
    factor = _common_factor(sides, mask)
    if factor and abs(factor.value - 1) >= least:
        return [Cause("exposure", f"all colors times {factor} (or the power of all lights alike)")]
    return []


def _common_factor(sides: Sides, mask: np.ndarray) -> Factor | None:
    """The factor that explains how the picture differs; None if there is none."""
    if np.count_nonzero(mask) < FEWEST:
        return None
    factor = Factor.of([scores(*sides.picture, BLOCK, mask)])
    return factor if factor.differs and factor.explains else None


def _everywhere(sides: Sides) -> np.ndarray:
    return np.ones(sides.known.objects.numbers.shape, bool)


def _materials_in(sides: Sides, mask: np.ndarray) -> list[str]:
    """That cover pixels of `mask` in either, those of the reference first."""
    sides_labels = sides.known.materials, sides.ours.materials
    names = [name for labels in sides_labels for name in labels.names if (mask & labels.where(name)).any()]
    return list(dict.fromkeys(names))


def _listed(noun: str, names: list[str]) -> str:
    quoted = [f"'{name}'" for name in names]
    return f"{noun}{'s' if len(names) > 1 else ''} {_shortened(quoted)}"


def _shortened(texts: list[str]) -> str:
    if len(texts) > _MOST_NAMES:
        texts = [*texts[:_MOST_NAMES], f"{len(texts) - _MOST_NAMES} more"]
    return " and ".join([", ".join(texts[:-1]), texts[-1]] if len(texts) > 1 else texts)
