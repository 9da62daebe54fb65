"""A limited table of the newest values."""

from tailor.runtime.newest import Newest


def test_the_key_that_was_silent_for_longest_is_dropped():
    newest = Newest(2)
    assert [newest.renew(key, n) for n, key in enumerate("abac")] == [None, None, 0, None]
    assert list(newest.items()) == [("a", 2), ("c", 3)]
