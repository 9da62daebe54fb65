"""The order of tests on several workers."""

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
