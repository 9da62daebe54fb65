"""The order of tests on several workers, and what the tests of one worker share."""

import gc

from tailor.models.runtime import load_model
from tailor.runtime.gc_freeze import gc_frozen
from tests import conftest
from tests.support.spreading import spread


def test_tests_that_wait_lie_evenly_among_the_others_and_both_keep_their_order():
    tests = ["w1", "w2", "a", "b", "c", "d", "e", "f"]
    spread(tests, lambda test: test.startswith("w"))
    assert tests == ["w1", "a", "b", "c", "w2", "d", "e", "f"]


def test_tests_of_one_kind_stay_in_their_order():
    for waits in (True, False):
        tests = ["c", "a", "b"]
        spread(tests, lambda _, waits=waits: waits)
        assert tests == ["c", "a", "b"]


def test_what_a_test_has_unfrozen_is_frozen_again_after_it():
    teardown = conftest.pytest_runtest_teardown(item=None)
    next(teardown)
    with gc_frozen():
        pass
    assert gc.get_freeze_count() == 0
    assert list(teardown) == []
    assert gc.get_freeze_count() > 0


def test_a_model_that_is_loaded_again_has_the_same_session():
    one, other = (load_model("agilo/goToPose/duration") for _ in range(2))
    assert one is not other
    assert one.session is other.session
