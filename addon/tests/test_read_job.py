"""Jobs that Python runs on a thread."""

import threading
import time

import pytest
from velour.core.read_job import ReadJob
from velour.native import Status, VelourError


def test_result_from_another_thread():
    job = ReadJob(threading.get_ident).start()
    assert job.wait()
    assert job.result() != threading.get_ident()
    assert (job.poll().state, job.poll().fraction) == ("done", 1.0)


def test_waits_no_longer_than_asked():
    go_on, seen = threading.Event(), []
    job = ReadJob(lambda: go_on.wait(10)).start()
    assert not job.wait(timeout=0.0)
    assert job.poll().running
    assert not job.wait(seen.append, timeout=0.25)
    assert len(seen) >= 2
    go_on.set()
    assert job.wait()
    assert job.result() is True


def test_error_belongs_to_who_waits_and_the_job_can_be_started_again():
    outcomes = [OSError("gone"), "there"]

    def read():
        outcome = outcomes.pop(0)
        if isinstance(outcome, Exception):
            raise outcome
        return outcome

    job = ReadJob(read).start()
    with pytest.raises(OSError, match="gone"):
        job.wait()
    assert job.poll().state == "failed"
    assert job.start().wait()
    assert job.result() == "there"


def test_cancel_does_not_wait_for_what_is_read():
    go_on = threading.Event()
    job = ReadJob(lambda: go_on.wait(10)).start()
    job.cancel()
    begun = time.monotonic()
    with pytest.raises(VelourError) as cancelled:
        job.wait()
    assert cancelled.value.status == Status.CANCELLED
    assert time.monotonic() - begun < 1.0
    go_on.set()
