"""What a second executive on the bus says, or a replayed one, is not taken for the words of the one started here."""

from tailor.schemas.messages import ExecStatus, Sample
from tailor.schemas.own import example
from tailor.tools.launch.own_executive import OwnExecutive

OURS, OTHER = "aa" * 16, "bb" * 16


def status(sender):
    return Sample("exec/status", example(ExecStatus), 0, 1, sender)


def finished(sender):
    return Sample("exec/finished", object(), 0, 1, sender)


def test_the_first_that_speaks_is_ours_and_nobody_else():
    own = OwnExecutive()
    assert not own.sent(finished(OTHER), pid=7)
    assert own.sent(status(OURS), pid=7)
    assert own.sent(finished(OURS), pid=7)
    assert not own.sent(status(OTHER), pid=7)
    assert not own.sent(finished(OTHER), pid=7)


def test_one_that_was_started_again_has_another_name_and_the_others_known_so_far_are_not_it():
    own = OwnExecutive()
    assert own.sent(status(OURS), pid=7)
    assert not own.sent(status(OTHER), pid=7)
    assert not own.sent(status(OTHER), pid=8)
    assert not own.sent(status(OURS), pid=8)
    assert own.sent(status("cc" * 16), pid=8)
    assert not own.sent(finished(OTHER), pid=8)
