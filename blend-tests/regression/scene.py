"""A scene of blend-tests/scenes: what its file says."""

from __future__ import annotations

import importlib.util
from dataclasses import dataclass
from pathlib import Path

SCENES = Path(__file__).resolve().parent.parent / "scenes"


@dataclass(frozen=True)
class Scene:
    """QUANTITY: what is tested. FRAMES: that are rendered. REFUSAL: words of the sentence that is expected in
    place of a picture. `build(folder)`, in Blender, makes the scene; `folder` is where the .blend lies.
    `meaning()`, in Blender, says which of MEANINGS this Blender gives the scene: each has its own references.
    """

    path: Path
    quantity: str
    frames: tuple[int, ...]
    refusal: tuple[str, ...]
    meanings: tuple[str, ...]  # the first is that of the oldest Blender, and unnamed

    @property
    def name(self) -> str:
        return self.path.stem

    def references(self, meaning: str = "") -> dict[int, Path]:
        """By frame."""
        if self.refusal:
            return {}
        folder, end = self.path.parent / "references", f".{meaning}.exr" if meaning else ".exr"
        if len(self.frames) == 1:
            return {self.frames[0]: folder / f"{self.name}{end}"}
        return {frame: folder / f"{self.name}_{frame:04d}{end}" for frame in self.frames}


def names(folder: Path = SCENES) -> list[str]:
    return sorted(path.stem for path in folder.glob("*.py"))


def load(name: str, folder: Path = SCENES) -> Scene:
    """Without Blender: scenes import it where they build."""
    path = folder / f"{name}.py"
    spec = importlib.util.spec_from_file_location(f"scene_{name}", path)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    frames, refusal = getattr(module, "FRAMES", (1,)), getattr(module, "REFUSAL", ())
    return Scene(path, module.QUANTITY, frames, refusal, getattr(module, "MEANINGS", ("",)))
