"""The outline of a closed structure in real time beside that of the ray tracer."""

from pathlib import Path

from support import outlines, realtime, scenes, window

_DATA = Path(__file__).parent / "scenes/data"

LONG = "many pictures in real time, drawn without a graphics card"
SCREEN = "1400x720"


def start(folder):
    """Called by the harness once the window is there."""
    window.run(folder, (stones_of_a_btf,), viewport=True)


def stones_of_a_btf(folder):
    """A closed structure: no light beyond an outline is folded back."""
    realtime.sky(folder)
    outlines.ball_in("GRAVEL", scenes.measured_material((_DATA / "weave.velour").read_bytes(), "Weave"))
    drawn, traced, overlap = yield from outlines.compared(folder, "stones")
    error = realtime.error(drawn, traced)
    print(f"relative L2: {error:.4f}", flush=True)
    assert overlap > 0.98, overlap
    assert error < 0.03, error
