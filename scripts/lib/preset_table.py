"""The materials of the preset library, read from presets.toml."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

import tomllib


@dataclass(frozen=True)
class Surface:
    """Arguments of velour.native.microsurface_job."""

    roughness: float
    metal: str = "copper"
    anisotropy: float = 1.0
    base_albedo: tuple[float, float, float] = (0.0, 0.0, 0.0)
    base_share: float = 0.0
    ior: float = 0.0
    flake_roughness: float = 0.2


@dataclass(frozen=True)
class Weave:
    """A tile of velour.native.Tile and the surfaces of its yarns, one per material slot."""

    kind: str
    yarns: tuple[Surface, ...]
    shape: dict = field(default_factory=dict)  # further arguments of Tile.create
    repeats: int = 24  # tiles around the preview's ball, and per unit of texture coordinates


@dataclass(frozen=True, eq=False)
class Preset:
    name: str
    catalog: str
    made_of: Surface | Weave
    description: str
    tags: tuple[str, ...]

    @property
    def file_name(self) -> str:
        return self.name.lower().replace(" ", "_")

    @property
    def repeats(self) -> int:
        """Tiles per unit of texture coordinates; 0: not a texture."""
        return self.made_of.repeats if isinstance(self.made_of, Weave) else 0


def _surface(values: dict) -> Surface:
    return Surface(**{name: tuple(v) if isinstance(v, list) else v for name, v in values.items()})


def _preset(
    name: str, catalog: str, description: str, tags: list, surface: dict | None = None, **weave
) -> Preset:
    if surface:
        made_of = _surface(surface)
    else:
        made_of = Weave(**weave | {"yarns": tuple(map(_surface, weave["yarns"]))})
    return Preset(name, catalog, made_of, description, tuple(tags))


_READ = tomllib.loads(Path(__file__).with_name("presets.toml").read_text(encoding="utf-8"))
CATALOGS = _READ["catalogs"]
PRESETS = tuple(_preset(**values) for values in _READ["preset"])
