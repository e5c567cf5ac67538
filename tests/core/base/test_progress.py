"""What is told of the work, and what is kept of its results."""

import threading
from types import SimpleNamespace

import pytest
from holomorph.core.newest import Kept
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


def test_what_was_asked_for_longest_ago_goes_first_and_the_last_one_stays():
    kept, sizes = Kept(10), {"a": 4, "b": 4, "c": 4, "large": 99}
    values = {name: SimpleNamespace(nbytes=size) for name, size in sizes.items()}
    for name in "ab":
        assert kept.keep(name, values[name]) is values[name]
    assert kept.get("a") is values["a"]
    kept.keep("c", values["c"])
    assert kept.get("b") is None and kept.values() == [values["a"], values["c"]]
    kept.keep("large", values["large"])
    assert kept.values() == [values["large"]]


def test_values_that_have_grown_are_dropped_when_they_are_counted_again():
    kept, first, second = Kept(10), SimpleNamespace(nbytes=1), SimpleNamespace(nbytes=2)
    kept.keep(1, first), kept.keep(2, second)
    first.nbytes = 9
    assert kept.values() == [first, second]
    kept.trim()
    assert kept.values() == [second]


def test_work_in_the_background_is_looked_at_and_raises_its_error():
    may_end, ident = threading.Event(), []
    future = in_background(lambda: ident.append(threading.get_ident()) or may_end.wait(SECONDS))
    assert not future.done()
    may_end.set()
    assert future.result() is True and ident != [threading.get_ident()]
    with pytest.raises(ZeroDivisionError):
        in_background(lambda: 1 // 0).result()
