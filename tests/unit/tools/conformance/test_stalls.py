"""A machine that stalls is not taken for a driver that breaks a clause, nor for a robot that moves otherwise."""

from dataclasses import replace

import numpy as np
import pytest

from tailor.executive import domains
from tailor.simnodes.world import World
from tailor.tools.conformance.bench import Bench, NotPossible
from tailor.tools.conformance.clause import TRIES, Clause, Verdict, judged
from tailor.tools.conformance.fit import TRIES as STEPS
from tailor.tools.conformance.fit import differences, responses
from tailor.tools.conformance.simulated_link import SimulatedLink
from tests.support.stand_ins.bad_drivers import SPEC
from tests.support.stand_ins.body import FakeBody
from tests.unit.tools.conformance.test_fit import Ramped

DOMAIN = domains.load("soccer")


class StallingLink(SimulatedLink):
    """Stalls of given lengths at random times: of the process that checks, or of the whole machine."""

    def __init__(self, stall_s, mean_pause_s, whole_machine, seed=0):
        super().__init__(World(Ramped(), {}, seed), SPEC)
        self.rng, self.stall_ns, self.mean_pause_s = np.random.default_rng(seed), round(stall_s * 1e9), mean_pause_s
        self.whole_machine = whole_machine

    def wait(self, seconds):
        until_ns, heard = self._now_ns + round(seconds * 1e9), []
        while self._now_ns < until_ns:
            if self.rng.random() < 0.01 / self.mean_pause_s:
                self.stall()
            heard += super().wait(0.01)
        return heard

    def stall(self):
        until_ns = self._now_ns + self.stall_ns
        if self.whole_machine:
            self._now_ns = until_ns
        while self._now_ns < until_ns:
            self.node.run_period()
        self._heard = [replace(each, at_s=until_ns * 1e-9) for each in self._heard]


def responses_over(link):
    return responses(Bench(link, DOMAIN, SPEC, fraction=0.2), 0.3)


@pytest.mark.parametrize("seed", range(3))
def test_messages_that_wait_do_not_change_a_step_response(seed):
    found = responses_over(StallingLink(0.12, mean_pause_s=0.4, whole_machine=False, seed=seed))
    assert list(differences(found, responses_over(SimulatedLink(World(Ramped(), {}, 9), SPEC)))) == []


@pytest.mark.parametrize("seed", range(3))
def test_a_step_with_missing_measurements_is_repeated(seed):
    found = responses_over(StallingLink(0.2, mean_pause_s=2.0, whole_machine=True, seed=seed))
    assert list(differences(found, responses_over(SimulatedLink(World(Ramped(), {}, 9), SPEC)))) == []


def test_steps_that_all_miss_measurements_are_no_misfit():
    with pytest.raises(NotPossible, match=f"measurements of v are missing in each of {STEPS} steps"):
        responses_over(StallingLink(0.1, mean_pause_s=0.05, whole_machine=True))


def judged_with(stalls_s, faults):
    """Verdict and number of tries of a clause, by how long each try stalls and by what it finds."""
    link, tries = SimulatedLink(World(FakeBody(), {}, 0), SPEC), []

    def check(_):
        tries.append(0)
        yield from faults[len(tries) - 1]

    link.stalled_s = lambda: stalls_s[len(tries) - 1] if tries else 9.9
    [verdict] = judged(Bench(link, DOMAIN, SPEC, fraction=0.2), [Clause("stops", "It stops.", check)])
    return verdict, len(tries)


def test_a_clause_that_a_measured_stall_broke_is_tried_again():
    verdict, tries = judged_with([0.4, 0.0], [["still armed"], []])
    assert (verdict.faults, verdict.skipped, tries) == ((), "", 2)


def test_without_a_measured_stall_the_first_verdict_counts():
    verdict, tries = judged_with([0.09], [["still armed"]])
    assert (verdict.faults, verdict.skipped, tries) == (("still armed",), "", 1)


def test_a_clause_that_is_kept_in_spite_of_a_stall_is_kept():
    assert judged_with([0.4], [[]]) == (Verdict("stops", "It stops."), 1)


def test_a_clause_that_always_stalls_is_not_tried():
    verdict, tries = judged_with([0.4] * TRIES, [["still armed"]] * TRIES)
    assert tries == TRIES
    assert verdict.skipped.startswith("this process stalled for 0.40 s meanwhile")
