"""Messages of a second or replayed executive on the bus are distinguished from those of the own one."""

from tailor.schemas.messages import ExecStatus, Sample
from tailor.schemas.own import example
from tailor.tools.launch.own_executive import OwnExecutive

OURS, OTHER = "aa" * 16, "bb" * 16


def status(sender):
    return Sample("exec/status", example(ExecStatus), 0, 1, sender)


def finished(sender):
    return Sample("exec/finished", object(), 0, 1, sender)


def test_the_first_new_sender_is_the_own_executive():
    own = OwnExecutive()
    assert not own.sent(finished(OTHER), pid=7)
    assert own.sent(status(OURS), pid=7)
    assert own.sent(finished(OURS), pid=7)
    assert not own.sent(status(OTHER), pid=7)
    assert not own.sent(finished(OTHER), pid=7)


def test_a_restarted_executive_has_a_new_sender_and_is_none_of_the_earlier_ones():
    own = OwnExecutive()
    assert own.sent(status(OURS), pid=7)
    assert not own.sent(status(OTHER), pid=7)
    assert not own.sent(status(OTHER), pid=8)
    assert not own.sent(status(OURS), pid=8)
    assert own.sent(status("cc" * 16), pid=8)
    assert not own.sent(finished(OTHER), pid=8)
