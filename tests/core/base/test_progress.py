"""What is told of the work."""

import threading

import pytest
from holomorph.core.progress import Watch, in_background, scaled

SECONDS = 60


def test_a_watch_keeps_what_it_is_told_until_it_is_cancelled():
    told = []
    watch = Watch(told.append)
    assert watch(0.25, "forms") is True and (watch.fraction, watch.stage) == (0.25, "forms")
    half = watch.part(0.5, 1.0)
    assert half(0.5, "maps") is True and watch.fraction == 0.75
    watch.cancel()
    assert half(1.0, "maps") is False and told == [0.25, 0.75, 1.0]
    assert scaled(None, 0.0, 1.0) is None


def test_work_in_the_background_is_looked_at_and_raises_its_error():
    may_end, ident = threading.Event(), []
    future = in_background(lambda: ident.append(threading.get_ident()) or may_end.wait(SECONDS))
    assert not future.done()
    may_end.set()
    assert future.result() is True and ident != [threading.get_ident()]
    with pytest.raises(ZeroDivisionError):
        in_background(lambda: 1 // 0).result()
