"""The multilayer files of inside_render.py, read as a picture and its passes."""

from __future__ import annotations

import contextlib
import json
from collections.abc import Iterable
from pathlib import Path

import numpy as np
from velour.native import images

from support.judge import Estimate, estimate

from .passes import MIXED, NOTHING, Labels, Passes

_WHOLE = 0.999  # share of a pixel that is all of it
_CHANNELS = {  # of the files, by the name that they get here
    "picture": ("Combined.R", "Combined.G", "Combined.B", "Combined.A"),
    "shape": ("Normal.X", "Normal.Y", "Normal.Z", "Mist.Z"),
    "coordinates": ("UV.U", "UV.V"),
    "albedo": ("Albedo.R", "Albedo.G", "Albedo.B"),
}
_IDS = {"objects": "CryptoObject00", "materials": "CryptoMaterial00"}


def read_renders(paths: Iterable[Path], worlds: list[Path], layer: str) -> tuple[Estimate, Passes]:
    """The picture and its passes. `worlds`: pictures of the world; empty without one."""
    labels = {kind: _Agreement() for kind in _IDS}
    found = estimate(_values(path, layer, labels) for path in paths)
    begin, split = 0, {}
    for name, channels in _CHANNELS.items():
        split[name] = found.channels(slice(begin, begin + len(channels)))
        begin += len(channels)
    picture = split.pop("picture")
    world = estimate(images.read(path)[..., :3] for path in worlds) if worlds else None
    return picture, Passes(**split, **{kind: each.labels() for kind, each in labels.items()}, world=world)


def _values(path: Path, layer: str, labels: dict[str, _Agreement]) -> np.ndarray:
    """The channels of _CHANNELS, in their order; adds the file to `labels`."""
    header, pixels = images.header(path), images.read(path)
    places = {name: place for place, name in enumerate(header["channels"])}

    def channel(name: str) -> np.ndarray:
        place = places.get(f"{layer}.{name}")
        if place is None:
            raise ValueError(f"{path} has no channel '{layer}.{name}'; look at Blender's log beside it.")
        return pixels[..., place]

    for kind, name in _IDS.items():
        ids, shares = channel(f"{name}.r"), channel(f"{name}.g")
        names = _manifest(header["texts"], f"{layer}.{name[:-2]}")
        labels[kind].add(np.ascontiguousarray(ids).view(np.uint32), shares, names)
    return np.stack([channel(name) for names in _CHANNELS.values() for name in names], axis=2)


def _manifest(texts: dict[str, str], name: str) -> dict[int, str]:
    """Names by id, of the Cryptomatte `name`."""
    for key, text in texts.items():
        if key.startswith("cryptomatte/") and key.endswith("/name") and text == name:
            with contextlib.suppress(KeyError, ValueError):
                manifest = json.loads(texts[key.removesuffix("name") + "manifest"])
                return {int(number, 16): name for name, number in manifest.items()}
    return {}


class _Agreement:
    """Labels that all renders agree on; where they do not, pixels are mixed."""

    def __init__(self):
        self._ids, self._whole, self._none, self._names = None, None, None, {}

    def add(self, ids: np.ndarray, shares: np.ndarray, names: dict[int, str]) -> None:
        whole, none = shares >= _WHOLE, shares <= 1 - _WHOLE
        if self._ids is None:
            self._ids, self._whole, self._none = ids, whole, none
        self._whole = self._whole & whole & (ids == self._ids)
        self._none = self._none & none
        self._names |= names

    def labels(self) -> Labels:
        found, places = np.unique(self._ids[self._whole], return_inverse=True)
        numbers = np.full(self._ids.shape, MIXED, np.int32)
        numbers[self._none] = NOTHING
        numbers[self._whole] = 1 + places
        return Labels(numbers, tuple(self._names.get(int(each), f"{int(each):08x}") for each in found))
