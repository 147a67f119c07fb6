"""Builds and checks a scene in Blenders of its own."""

from __future__ import annotations

import shutil
from pathlib import Path

from . import check
from .blender import BlenderError, Installation, ending
from .case import Case, Outcome, Settings
from .scene import Scene

MOST_BYTES = 100_000  # of a reference with its error
EXIT_STATUS = 1  # of Blender where Velour refuses to render


def run(scene: Scene, blender: Installation, work: Path, pictures: int, update: bool) -> list[Outcome]:
    shutil.rmtree(work, ignore_errors=True)
    work.mkdir(parents=True)
    blend = work / f"{scene.name}.blend"
    try:
        task = {"scene": str(scene.path), "blend": str(blend)}
        meaning = blender.run("inside_build.py", task, work)["meaning"]
    except BlenderError as error:
        return [Outcome(scene.name, False, f"it cannot be built: {error}", scene.quantity)]
    if scene.refusal:
        return [_refused(scene, blender, blend)]
    if meaning not in scene.meanings:
        return [Outcome(scene.name, False, f"its MEANINGS lack {meaning!r}", scene.quantity)]
    case = Case(scene.name, blend, scene.references(meaning), work, scene.quantity)
    if update:
        return list(check.update(case, blender, Settings(), MOST_BYTES))
    return [_sharp(outcome) for outcome in check.check(case, blender, Settings(), pictures)]


def _sharp(outcome: Outcome) -> Outcome:
    """A comparison that cannot see anything proves nothing."""
    found = outcome.comparison
    if outcome.passed and found and found.sees > check.LEAST_SEEN:
        outcome.passed, outcome.sentence = False, f"sees {found.sees:.2f} % of exposure; give it more samples"
    return outcome


def _refused(scene: Scene, blender: Installation, blend: Path) -> Outcome:
    """Renders like a farm: the file on Blender's own command line."""
    log, output = blend.parent / "render.log", blend.parent / "picture_####"
    status = blender.execute(log, blend, "-E", "VELOUR", "-o", output, "-F", "OPEN_EXR", "-f", "1")
    said = [line for line in log.read_text(encoding="utf-8", errors="replace").splitlines() if line]
    sentence = next((line for line in said if all(word in line for word in scene.refusal)), None)
    written = [path.name for path in blend.parent.glob("picture_*")]
    if status == EXIT_STATUS and sentence and not written:
        return Outcome(scene.name, True, f'refused with status {status}: "{sentence}"', scene.quantity)
    words = ", ".join(map(repr, scene.refusal))
    problem = f"{ending(status, blender.seconds)}, wrote {written or 'no picture'}"
    problem += f" and said {sentence!r}" if sentence else f" and said nothing with {words}"
    problem += f"; status {EXIT_STATUS}, a sentence with these words and no picture are expected; see {log}"
    return Outcome(scene.name, False, problem, scene.quantity)
