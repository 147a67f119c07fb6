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
_MOST = 0.5
_CHANNELS = {  # of the files, by the name that they get here
    "picture": ("Combined.R", "Combined.G", "Combined.B", "Combined.A"),
    "shape": ("Normal.X", "Normal.Y", "Normal.Z", "Mist.Z"),
    "coordinates": ("UV.U", "UV.V"),
    "albedo": ("Albedo.R", "Albedo.G", "Albedo.B"),
}
_IDS = {"objects": "CryptoObject00", "materials": "CryptoMaterial00"}


def read_renders(
    paths: Iterable[Path], worlds: list[Path], sharp: list[Path], layer: str
) -> tuple[Estimate, Passes]:
    """The picture and its passes. `worlds`: pictures of the world; `sharp`: renders without depth of field
    and motion blur; both may be empty."""
    found, labels = _split(paths, layer)
    picture, blurred = found.pop("picture"), None
    if sharp:
        blurred = found["shape"]
        found, labels = _split(sharp, layer)
        del found["picture"]
    world = estimate(images.read(path)[..., :3] for path in worlds) if worlds else None
    return picture, Passes(**found, **labels, world=world, blurred=blurred)


def _split(paths: Iterable[Path], layer: str) -> tuple[dict[str, Estimate], dict[str, Labels]]:
    """Estimates by the names of _CHANNELS, labels by those of _IDS."""
    labels = {kind: _Agreement() for kind in _IDS}
    found = estimate(_values(path, layer, labels) for path in paths)
    begin, split = 0, {}
    for name, channels in _CHANNELS.items():
        split[name] = found.channels(slice(begin, begin + len(channels)))
        begin += len(channels)
    return split, {kind: each.labels() for kind, each in labels.items()}


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
        self._ids, self._whole, self._most, self._none, self._names = None, True, True, True, {}

    def add(self, ids: np.ndarray, shares: np.ndarray, names: dict[int, str]) -> None:
        self._ids = ids if self._ids is None else self._ids
        same = ids == self._ids
        self._whole = self._whole & same & (shares >= _WHOLE)
        self._most = self._most & same & (shares >= _MOST)
        self._none = self._none & (shares <= 1 - _WHOLE)
        self._names |= names

    def labels(self) -> Labels:
        found, places = np.unique(self._ids, return_inverse=True)
        kept = np.unique(places.reshape(self._ids.shape)[self._most])
        number = np.full(len(found), MIXED, np.int32)
        number[kept] = 1 + np.arange(len(kept))
        number = number[places].reshape(self._ids.shape)
        whole, mostly = (
            np.where(self._none, NOTHING, np.where(where, number, MIXED)).astype(np.int32)
            for where in (self._whole, self._most)
        )
        names = (self._names.get(int(each), f"{int(each):08x}") for each in found[kept])
        return Labels(whole, tuple(names), mostly)
