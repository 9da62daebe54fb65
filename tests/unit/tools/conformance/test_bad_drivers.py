"""Each clause of a driver's contract catches the driver that breaks it, and no other clause does."""

import pytest

from tailor.executive import domains
from tailor.simnodes.guard import Limit
from tailor.tools.conformance.bench import Bench
from tailor.tools.conformance.refusal_clauses import beyond
from tailor.tools.conformance.suite import clauses, verdicts
from tests.support.stand_ins.bad_drivers import BAD, SPEC, good

DOMAIN = domains.load("soccer")


def judged(link):
    return list(verdicts(Bench(link, DOMAIN, SPEC, fraction=0.2)))


def test_there_is_a_bad_driver_for_each_clause():
    assert list(BAD) == [clause.name for clause in clauses()]


def test_a_good_driver_keeps_to_every_clause():
    assert [(each.clause, each.faults, each.skipped) for each in judged(good()) if each.faults or each.skipped] == []


@pytest.mark.parametrize("clause", BAD)
def test_a_bad_driver_is_caught_by_its_clause_alone(clause):
    link = good()
    BAD[clause](link)
    found = {each.clause: each.faults for each in judged(link) if each.faults}
    assert list(found) == [clause], found


@pytest.mark.parametrize(("lower", "upper"), [(-1.0, 2.0), (0.0, 0.12), (-2.0, 0.0), (-2.0, -1.0)])
def test_what_is_beyond_a_limit_is_so_by_a_little_whatever_its_sign(lower, upper):
    """1.01 times -1 is within -2 to -1: a driver that took it was said to be lax."""
    assert upper < beyond(Limit(lower, upper, 0.5 * (lower + upper))) < upper + 0.1
