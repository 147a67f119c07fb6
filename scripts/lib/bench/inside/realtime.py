"""In a window of Blender: a net of its BTF in real time and by the ray tracer, and the error."""

import numpy as np
from support import realtime, viewport
from window_realtime_outline import _plane_of_its_btf


def steps(folder, _task):
    realtime.sky(folder)
    _plane_of_its_btf(folder, "NET")
    viewport.show_real_time()
    yield from viewport.real_time_finished(patience=600)
    drawn = realtime.pixels()
    traced = realtime.traced(realtime.equirectangular(realtime.mixture()), samples=2048)
    np.save(folder / "net.npy", np.stack((traced.mean, drawn)))
    return {"relative_l2": float(realtime.error(drawn, traced))}
