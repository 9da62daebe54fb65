"""What the truth of a soccer run counts as a contact: any ball that moved before the first approach ended."""

import pytest

from tailor.executive import domains
from tailor.schemas.messages import ActionFinished
from tailor.schemas.messages.soccer import BallTruth, SoccerGroundTruth
from tailor.tools.lockstep.task_sampler import sampler_of

SAMPLER = sampler_of(domains.load("soccer"))
ENDED_NS = 20


def approach(ended_ns):
    return ActionFinished(ended_ns, 1, "approachBall", 0, "done", "", 1.0, 1.0)


def truths(first_x, second_x):
    """Both balls at their starts, then at these places as the approach ends, then far away."""
    for stamp_ns, own, other in ((0, 1.0, 2.0), (ENDED_NS, first_x, second_x), (ENDED_NS + 1, 9.0, 9.0)):
        yield SoccerGroundTruth(stamp_ns, 0.0, 0.0, 0.0, 0.0, 0.0, own, 0.0, 0.0, 0.0)
        yield BallTruth(stamp_ns, other, 0.0, 0.0, 0.0)


@pytest.mark.parametrize(("first_x", "second_x", "moved_m"), [(1.0, 2.0, 0.0), (1.3, 2.0, 0.3), (1.0, 1.8, 0.2),
                                                              (1.1, 2.4, 0.4)])  # fmt: skip
def test_whichever_ball_was_displaced_most_counts(first_x, second_x, moved_m):
    finished, truth = [approach(ENDED_NS), approach(ENDED_NS + 1)], list(truths(first_x, second_x))
    assert SAMPLER.disturbance_m(finished, truth) == pytest.approx(moved_m)
    assert SAMPLER.contacts(finished, truth) == (moved_m > 0.05)


def test_without_an_approach_no_ball_was_disturbed():
    assert SAMPLER.disturbance_m([], list(truths(1.5, 2.5))) == 0.0
    assert SAMPLER.disturbance_m([approach(ENDED_NS)], []) == 0.0
