"""Goals of any form are grounded in portions as in one go."""

from hypothesis import given
from hypothesis import strategies as st

from tailor.executive.planning.ground.goal_grounding import PORTION_PARTS, ground_in_portions
from tailor.executive.planning.ground.ground_formula import (
    FactTable,
    GroundingLimit,
    StaticWorld,
    TooMuchToGround,
    ground,
)
from tailor.executive.planning.pddl.language import And, Atom, Domain, Equal, Not, Or, Quantified, Typed
from tailor.executive.planning.plans.portions import completed_work

THINGS = tuple(f"thing{n}" for n in range(5))
VARIABLES = ("?a", "?b")
WORLD = StaticWorld(
    Domain("d", {}, {}, (), {}, {}, ()),
    {"object": THINGS},
    frozenset({"fixed"}),
    frozenset({("fixed", "thing1", "thing2")}),
    {},
    False,
)


def quantified(every, names, part):
    return Quantified(every, tuple(Typed(name, ("object",)) for name in names), part)


terms = st.sampled_from((*THINGS[:3], *VARIABLES))
leaves = st.builds(
    lambda name, one, other: Equal(one, other) if name == "=" else Atom(name, (one, other)),
    st.sampled_from(("fluent", "other", "fixed", "=")),
    terms,
    terms,
)
formulas = st.recursive(
    leaves,
    lambda inner: st.one_of(
        st.builds(Not, inner),
        st.builds(lambda parts: And(tuple(parts)), st.lists(inner, max_size=4)),
        st.builds(lambda parts: Or(tuple(parts)), st.lists(inner, max_size=4)),
        st.builds(
            lambda every, name, part: quantified(every, (name,), part), st.booleans(), st.sampled_from(VARIABLES), inner
        ),
    ),
    max_leaves=12,
)


@given(formulas, st.integers(10, 200))
def test_portions_yield_the_condition_the_facts_and_the_limit_of_one_go(formula, steps):
    closed = quantified(True, VARIABLES, formula)
    whole, parts = FactTable((), GroundingLimit(steps)), FactTable((), GroundingLimit(steps))
    try:
        expected = ground(closed, {}, WORLD, whole)
    except TooMuchToGround as limit:
        expected = str(limit)
    try:
        condition = completed_work(ground_in_portions(closed, WORLD, parts))
    except TooMuchToGround as limit:
        condition = str(limit)
    assert condition == expected
    assert list(parts) == list(whole)


def test_no_portion_of_a_goal_over_many_objects_takes_many_steps():
    """Such a goal took 0.4 s of one tick; each step is a few microseconds."""
    names = tuple(f"?v{n}" for n in range(6))
    goal = quantified(True, names, Or((Atom("fluent", (names[0], names[1])), Not(Atom("other", (names[5], names[2]))))))
    steps = [0]

    class Counted(FactTable):
        __slots__ = ()

    facts = Counted((), GroundingLimit(10**6, 10**6))
    spend = facts.spend

    def counting():
        steps[-1] += 1
        spend()

    facts.spend = counting
    for _ in ground_in_portions(goal, WORLD, facts):
        steps.append(0)
    assert sum(steps) > 4 * 5**6
    assert max(steps) <= 2 * PORTION_PARTS
