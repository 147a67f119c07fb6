"""Threads that read stay out of Python while the main thread asks them to."""

import itertools
import threading
import time

import pytest
from velour.core import reading_gate
from velour.core.read_job import ReadJob, check


@pytest.fixture
def counted():
    """A reading that goes on and on, and how far it has come."""
    steps = []

    def read():
        for number in itertools.count():
            check()
            steps.append(number)
            time.sleep(1e-4)

    job = ReadJob(read).start()
    yield steps
    job.cancel()


def _moves(steps):
    before = len(steps)
    time.sleep(0.05)
    return len(steps) > before


def test_readings_stop_while_it_is_closed(counted):
    assert _moves(counted)
    with reading_gate.closed():
        assert not _moves(counted)
        with reading_gate.closed():
            assert not _moves(counted)
        assert not _moves(counted)
    assert _moves(counted)


def test_readings_begin_once_it_is_open():
    job = ReadJob(lambda: "read")
    with reading_gate.closed():
        job.start()
        time.sleep(0.05)
        assert job.poll().running
    assert job.wait(timeout=60)
    assert job.result() == "read"


def test_who_waits_for_a_reading_lets_it_go_on(counted):
    job = ReadJob(lambda: [check() for _ in range(10)] and "read")
    with reading_gate.closed():
        assert job.start().wait(timeout=60)
        assert not _moves(counted)
    assert job.result() == "read"


def test_one_that_never_pauses_is_waited_for_a_second():
    go_on = threading.Event()
    job = ReadJob(lambda: go_on.wait(20)).start()
    begun = time.monotonic()
    with reading_gate.closed():
        assert 0.9 < time.monotonic() - begun < 5
    go_on.set()
    assert job.wait(timeout=60)


def test_cancelled_readings_end(counted):
    with reading_gate.closed():
        pass
    job = ReadJob(lambda: [check() for _ in iter(int, 1)]).start()
    with reading_gate.closed():
        job.cancel()
    job._thread.join(10)
    assert not job._thread.is_alive()
