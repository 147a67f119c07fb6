"""Labels of objects and materials in passes."""

from typing import NamedTuple

import numpy as np

from ..native import INSTANCE_LABEL, MATERIAL_LABEL, Passes, cryptomatte_id

_NO_MATERIAL = "default_surface"  # Cycles' name for surfaces without a material
_EXPONENTS = {"LINEAR": 1.0, "QUADRATIC": 2.0, "INVERSE_QUADRATIC": 0.5}  # exponents of the mist falloff


class AskedPasses(NamedTuple):
    passes: Passes
    names: dict  # names that each of layer_passes.CRYPTOMATTES may show


def asked_passes(asked, layer, world, objects, materials):
    """AskedPasses for keys of table.PASSES, after export by an ObjectExport and a MaterialTable."""
    passes = Passes(frozenset(asked))
    passes.cryptomatte_ranks = 2 * ((layer.pass_cryptomatte_depth + 1) // 2)
    if world:
        mist = world.mist_settings
        passes.mist = mist.start, mist.depth, _EXPONENTS[mist.falloff]
    ids, of_materials = _Ids(), materials.labels()
    passes.instances = _instance_labels(objects.owners, ids)
    passes.materials = _material_labels(of_materials, ids)
    names = {
        "object": {owner.name for owner in objects.owners},
        "material": {name or _NO_MATERIAL for name, _ in of_materials.values()},
        "asset": {owner.asset for owner in objects.owners},
    }
    return AskedPasses(passes, names)


class _Ids(dict):
    """Cryptomatte ids by name."""

    def __missing__(self, name):
        self[name] = cryptomatte_id(name).value
        return self[name]


def _instance_labels(owners, ids):
    labels = {owner: (owner.index, ids[owner.name], ids[owner.asset], owner.uv_set) for owner in set(owners)}
    return np.array([labels[owner] for owner in owners], INSTANCE_LABEL)


def _material_labels(by_number, ids):
    labels = np.zeros(1 + max(by_number, default=-1), MATERIAL_LABEL)
    for number, (name, index) in by_number.items():
        labels[number] = index, ids[name or _NO_MATERIAL]
    return labels
