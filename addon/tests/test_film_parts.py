"""Files of the samples of a frame in Blender, with a job that renders nothing."""

from __future__ import annotations

import numpy as np
import pytest
from velour.core.film_parts import FilmParts

MADE = {"spp": 16, "split": 8}
PASSES = 155  # floats per pixel beside the colors: the most that a render has


class Film:
    """The film of a job: the sums of its samples."""

    size = (3, 2)

    def __init__(self, value: float):
        self.sums = np.full((2, 3, PASSES), value, np.float32)

    def read_pass(self, _name):
        return np.zeros((2, 3, 4), np.float32)

    def read_sums(self):
        return self.sums

    def sums_per_pixel(self):
        return PASSES

    def add_sums(self, sums):
        self.sums = self.sums + sums


def parts(folder, asked=None, stay=False) -> FilmParts:
    return FilmParts(folder, "frame", MADE, Film.size, asked, stay)


@pytest.fixture
def halves(tmp_path):
    for value, asked in ((1, (0, 8)), (2, (8, 16))):
        parts(tmp_path, asked).keep_all(Film(value))
    return tmp_path


def names(folder) -> list[str]:
    return sorted(path.name for path in folder.iterdir())


def test_the_sums_of_all_passes_come_back(halves):
    film, assembled = Film(0), parts(halves)
    assert assembled.gaps == []
    assembled.complete(film, None)
    np.testing.assert_array_equal(film.sums, 3)
    assembled.keep_all(film)
    assert names(halves) == ["frame.0-16.exr"]


def test_parts_that_stay_can_be_assembled_by_two_runs(halves):
    first, second = parts(halves, stay=True), parts(halves, stay=True)
    for assembled in (first, second):
        film = Film(0)
        assembled.complete(film, None)
        np.testing.assert_array_equal(film.sums, 3)
        assembled.keep_all(film)
    assert names(halves) == ["frame.0-16.exr", "frame.0-8.exr", "frame.8-16.exr"]
    assert parts(halves, stay=True).gaps == []


def test_what_another_run_writes_meanwhile_is_not_counted_twice(tmp_path):
    """The gaps are rendered as they were found, whoever else renders one of them."""
    ends = [(0, 8), (8, 16), (16, 24), (24, 32)]
    made = {"spp": 32, "split": 8}

    def opened(asked=None):
        return FilmParts(tmp_path, "frame", made, Film.size, asked)

    opened(ends[1]).keep_all(Film(10))
    assembled, film = opened(), Film(1)
    first, last = assembled.gaps
    assert (first, last) == ((0, 8), (16, 32))
    opened(ends[2]).keep_all(Film(100))
    assembled.begin(film, first)
    assembled.keep(film, first, first[1])
    film = Film(1000)
    assembled.begin(film, last)
    assembled.complete(film, last)
    np.testing.assert_array_equal(film.sums, 1011)
    assembled.keep_all(film)
    assert "frame.0-32.exr" in names(tmp_path)
