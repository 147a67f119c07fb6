"""What drives a window of Blender: texts and icons in pictures, pointer, clock, sheet of steps."""

from __future__ import annotations

import subprocess
import sys
import time

import numpy as np
import pytest
from conftest import ROOT
from support import contact_sheet, on_screen, pointer, session, stopwatch
from support.on_screen import Box

GAP, MARGIN = 2, 6  # columns between letters; beside a text
WORD_GAP = 4


def letter(seed):
    """9 x 7 pixels that look like no other letter."""
    shape = np.random.default_rng(seed).random((9, 7))
    return np.where(shape > 0.55, np.clip(shape * 1.4, 0, 1), 0.0)


def text(*seeds, gap=GAP):
    parts = [letter(seeds[0])]
    for seed in seeds[1:]:
        parts += [np.zeros((9, gap)), letter(seed)]
    return np.hstack(parts)


def screen(*texts, ink=0.9, paper=0.3):
    """A picture of 120 x 200 with texts at (left, bottom)."""
    picture = np.full((120, 200), paper)
    for letters, left, bottom in texts:
        place = picture[bottom : bottom + letters.shape[0], left : left + letters.shape[1]]
        place[:] = paper + (ink - paper) * letters
    return picture


WORD = text(1, 2, 3, 4)


def middle(left, bottom):
    return left + WORD.shape[1] // 2, bottom + WORD.shape[0] // 2


@pytest.mark.parametrize(("ink", "paper"), [(0.9, 0.3), (0.1, 0.8), (0.45, 0.3)])
def test_a_text_is_found_whatever_its_color(ink, paper):
    (found,) = on_screen.find(screen((WORD, 50, 31), ink=ink, paper=paper), WORD, MARGIN)
    assert found[:2] == middle(50, 31)
    assert found.contrast == pytest.approx(ink - paper, abs=0.01)


def test_shadow_and_noise_do_not_hide_it():
    picture = screen((WORD, 50, 31))
    picture[30:39, 50 : 50 + WORD.shape[1]] -= (
        0.15 * 0.6 * WORD * (picture[30:39, 50 : 50 + WORD.shape[1]] < 0.5)
    )
    picture += np.random.default_rng(5).normal(0, 0.02, picture.shape)
    (found,) = on_screen.find(picture, WORD, MARGIN)
    assert found[:2] == middle(50, 31)


def test_other_texts_are_not_it():
    others = [(text(5, 6, 7, 8), 20, 80), (text(1, 2, 9, 10), 20, 50), (text(4, 3, 2, 1), 20, 20)]
    assert on_screen.find(screen(*others), WORD, MARGIN) == []
    assert on_screen.find(np.full((120, 200), 0.3), WORD, MARGIN) == []
    assert on_screen.find(np.full((4, 4), 0.3), WORD, MARGIN) == []


def test_a_part_of_a_longer_text_is_not_it():
    longer = np.hstack([WORD, np.zeros((9, WORD_GAP)), letter(7)])
    before = np.hstack([letter(7), np.zeros((9, WORD_GAP)), WORD])
    picture = screen((longer, 20, 80), (before, 20, 50), (WORD, 20, 20))
    assert [place[:2] for place in on_screen.find(picture, WORD, MARGIN)] == [middle(20, 20)]
    assert len(on_screen.find(picture, WORD, 0)) == 3, "the control: without a margin"


def test_all_places_are_told_from_above():
    picture = screen((WORD, 20, 20), (WORD, 100, 80), (WORD, 60, 50))
    heights = [place.y for place in on_screen.find(picture, WORD, MARGIN)]
    assert heights == [bottom + 4 for bottom in (80, 50, 20)]


def test_a_box_leaves_out_the_rest():
    picture = screen((WORD, 20, 20), (WORD, 100, 80))
    (found,) = on_screen.find(picture, WORD, MARGIN, Box(90, 60, 110, 60))
    assert found[:2] == middle(100, 80)


def test_icons_of_a_column():
    picture = np.full((120, 30), 0.2)
    tops = (100, 70, 42, 10)
    for bottom in tops:
        picture[bottom : bottom + 14, 8:22] += 0.5 * np.random.default_rng(bottom).random((14, 14)) + 0.1
    found = on_screen.icons(picture, Box(0, 0, 30, 120))
    assert [x for x, _ in found] == [15] * 4
    assert all(abs(y - bottom - 6) <= 1 for (_, y), bottom in zip(found, tops, strict=True))


def test_a_sheet_has_each_picture_above_its_caption():
    pictures = [np.full((40, 60, 3), 50 * number, np.uint8) for number in range(1, 5)]
    captions = [np.ones((10, 20))] * 3 + [np.ones((10, 400))]
    sheet = contact_sheet.sheet(pictures, captions)
    assert sheet.dtype == np.uint8
    assert sheet.shape[1] > 3 * 30
    levels = [np.unravel_index(np.argmax((sheet == 50 * n).all(-1)), sheet.shape[:2]) for n in range(1, 5)]
    assert levels[0][0] == levels[1][0] == levels[2][0] > levels[3][0], "the fourth is below"
    assert levels[0][1] < levels[1][1] < levels[2][1]
    ink = (sheet == 230).all(-1)
    assert ink.sum() == 10 * (3 * 20 + 30), "captions end with their pictures"
    both = contact_sheet.stacked([sheet, sheet[:, :50]])
    assert both.shape == (2 * sheet.shape[0], *sheet.shape[1:])
    assert (both[sheet.shape[0] :] == sheet).all(), "the first is at the top"


def test_sheets_of_tests_come_together(tmp_path):
    for number, name in enumerate(("b", "a")):
        contact_sheet.write(tmp_path / name, "sheet", np.full((10, 10, 3), number, np.uint8))
    assert {path.name for path in tmp_path.iterdir()} == {"a", "b", "sheet.png"}
    assert (tmp_path / "a/sheet.png").stat().st_size < (tmp_path / "sheet.png").stat().st_size


def test_a_click_is_marked_around_its_place():
    marked = contact_sheet.marked(np.zeros((50, 50, 3), np.uint8), 20, 30)
    rows, columns = np.nonzero(marked.any(-1))
    assert (rows.mean().round(), columns.mean().round()) == (30, 20)
    assert not marked[30, 20].any(), "the place itself stays visible"


def test_the_clock_runs_from_the_start_of_the_process():
    program = (
        "import time; time.sleep(0.5); from support.stopwatch import Stopwatch; print(Stopwatch().seconds())"
    )
    start = time.monotonic()
    printed = subprocess.run(
        [sys.executable, "-c", program], cwd=ROOT / "blend-tests", capture_output=True, text=True, check=True
    ).stdout
    assert 0.49 < float(printed) < time.monotonic() - start + 0.1
    clock = stopwatch.Stopwatch()
    clock.restart()
    assert clock.seconds() < 0.4


@pytest.fixture(scope="module")
def hand():
    if reason := pointer.why_not():
        pytest.skip(reason)
    if not session.has_screens():
        pytest.skip("Xvfb is not installed")
    screen = session.Screen("320x200")
    hand = pointer.Pointer(screen.variables["DISPLAY"])
    yield hand
    hand.close()
    screen.close()


def test_the_pointer_moves(hand):
    for place in ((10, 20), (300, 150)):
        hand.move(*place)
        assert hand.place() == place


def test_keys_are_found_by_their_names(hand):
    shifted = {"a": False, "A": True, "underscore": True, "slash": False, "F12": False}
    assert {name: hand._needs_shift(name, hand._code(name)) for name in shifted} == shifted
    hand.type("Ab_1/x.y")
    with pytest.raises(ValueError, match="'nothing'"):
        hand.key("nothing")
