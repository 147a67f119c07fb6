"""Worlds of a scene that is drawn in real time."""

from __future__ import annotations

from velour.native import Instruction, Output, Program, light_map_job
from velour.realtime import RealtimeScene


def test_each_world_of_nodes_asks_for_a_light_map():
    directions = Instruction("source", ("position", 0, "none"), (), 0)
    with Program.new(3, [], [directions], [Output(0, "color")]) as program, RealtimeScene() as scene:
        keys = [scene.world_key]
        for _edit in range(2):
            scene.set_world_program(program, 0, 16, 8)
            keys.append(scene.world_key)
        assert len(set(keys)) == 3
        with light_map_job(scene) as job:
            assert job.run()["lobes"] > 1
