"""A picture that grows: what it ends as, and that starting it over and over takes no memory."""

from __future__ import annotations

import numpy as np
import pytest
from velour.native import ProgressiveJob, Scene, VelourError, render_job

_OPTIONS = {"width": 160, "height": 120, "spp": 8, "split": 4, "bounces": 1, "threads": 1}


@pytest.fixture
def scene():
    with Scene() as made:
        gray = made.add_principled_material(base_color=(0.5, 0.5, 0.5), roughness=1.0)
        corners = np.array([(-1, -1, 0), (1, -1, 0), (0, 1, 0)], np.float32)
        made.add_instance(made.add_mesh(corners, np.array([(0, 1, 2)], np.uint32))[0], np.eye(3, 4), [gray])
        made.set_world_color((1, 1, 1))
        made.look_at((0, 0.1, 4), (0, 0, 0), 0.8, 4 / 3)
        made.commit()
        yield made


def _pixels(job):
    out = np.empty((job.size[1], job.size[0], 4), np.float32)
    picture = job.read(out)
    assert (picture.width, picture.height) == job.size
    return out


def test_ends_as_a_render_of_the_same_options(scene):
    with ProgressiveJob.of(scene, **_OPTIONS) as job, render_job(scene, **_OPTIONS) as whole:
        job.start().wait()
        whole.run()
        assert job.picture().samples == _OPTIONS["spp"]
        assert np.array_equal(_pixels(job), whole.read_pass("Combined"))


def test_a_thousand_restarts_take_no_memory(scene):
    with ProgressiveJob.of(scene, **_OPTIONS) as job:
        sizes = []
        for i in range(1000):
            scene.look_at((0.001 * i, 0.1, 4), (0, 0, 0), 0.8, 4 / 3)
            scene.commit()
            job.restart()
            job.start()
            if i % 50 == 0:
                job.wait()
                sizes.append(job.poll().bytes_in_use)
            job.stop()
        assert max(sizes[-5:]) < max(sizes[:5]) + 4 * 2**20, sizes


def test_says_what_is_wrong(scene):
    with ProgressiveJob.of(scene, **_OPTIONS) as job:
        job.start().wait()
        with pytest.raises(VelourError, match="room for only 4"):
            job.read(np.empty(4, np.float32))
        with pytest.raises(VelourError, match="contiguous float32"):
            job.read(np.empty(4))
