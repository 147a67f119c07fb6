"""What a check works on, and what comes of it."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from .causes import Cause
from .comparison import Comparison

CHECK_SEEDS, REFERENCE_SEEDS = 4, 16
FIRST_REFERENCE_SEED = 1_000_000  # added to the file's: no check shares a seed with a reference


@dataclass(frozen=True)
class Settings:
    """Settings of all renders of a run."""

    seeds: int | None = None  # None: CHECK_SEEDS, or REFERENCE_SEEDS of a reference
    samples: int | None = None  # None: as the file says
    scripts: bool = False  # whether those inside of .blend files run
    passes: bool = False  # whether what differs is told from passes

    def seed_list(self, update: bool) -> list[int]:
        first = FIRST_REFERENCE_SEED if update else 1
        return list(range(first, first + (self.seeds or (REFERENCE_SEEDS if update else CHECK_SEEDS))))


@dataclass(frozen=True)
class Case:
    """A .blend and the pictures that it is to look like."""

    name: str
    blend: Path
    references: dict[int | None, Path]  # by frame; None: the one that the file was saved at
    work: Path  # folder of renders and logs
    quantity: str = ""  # what is tested


@dataclass
class Outcome:
    """Result of one picture, or of a file that made none."""

    name: str
    passed: bool
    sentence: str
    quantity: str = ""
    comparison: Comparison | None = None
    ours: np.ndarray | None = None  # [height x width x channels], linear, row 0 at the bottom
    reference: np.ndarray | None = None
    figures: list[str] = field(default_factory=list)  # HTML of both, once they are files of a page
    notes: list[str] = field(default_factory=list)
    causes: list[Cause] = field(default_factory=list)  # of a difference, where the reference has passes
    seconds: float = 0.0
    to_approve: bool = False  # a new reference that differs from the one until now

    @property
    def word(self) -> str:
        return "to approve" if self.to_approve else "ok" if self.passed else "FAILED"

    @property
    def line(self) -> str:
        return f"{self.word}: {self.name}: {self.sentence}"
