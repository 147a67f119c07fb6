"""A scene of blend-tests/scenes: what its file says."""

from __future__ import annotations

import importlib.util
from dataclasses import dataclass
from pathlib import Path

SCENES = Path(__file__).resolve().parent.parent / "scenes"


@dataclass(frozen=True)
class Scene:
    """QUANTITY: what is tested. FRAMES: that are rendered. REFUSAL: words of the sentence that is expected in
    place of a picture. `build(folder)`, in Blender, makes the scene; `folder` is where the .blend lies."""

    path: Path
    quantity: str
    frames: tuple[int, ...]
    refusal: tuple[str, ...]

    @property
    def name(self) -> str:
        return self.path.stem

    @property
    def references(self) -> dict[int, Path]:
        """By frame."""
        if self.refusal:
            return {}
        folder = self.path.parent / "references"
        if len(self.frames) == 1:
            return {self.frames[0]: folder / f"{self.name}.exr"}
        return {frame: folder / f"{self.name}_{frame:04d}.exr" for frame in self.frames}


def names(folder: Path = SCENES) -> list[str]:
    return sorted(path.stem for path in folder.glob("*.py"))


def load(name: str, folder: Path = SCENES) -> Scene:
    """Without Blender: scenes import it where they build."""
    path = folder / f"{name}.py"
    spec = importlib.util.spec_from_file_location(f"scene_{name}", path)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return Scene(path, module.QUANTITY, getattr(module, "FRAMES", (1,)), getattr(module, "REFUSAL", ()))
