"""The bound by exclusive facts: no plan lasts shorter than the bound of a partial plan that it was made of."""

from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from tailor.executive.interfaces.budget import CheckBudget
from tailor.executive.planning import AnytimeSearch, Settings, validate
from tailor.executive.planning.best_first import BestFirst
from tailor.executive.planning.bounds.exclusive_facts import exclusive_facts
from tailor.executive.planning.bounds.occupation import Occupation
from tailor.executive.planning.ground.ground_task import make_task
from tailor.executive.planning.ground.grounding import ground_actions, static_world
from tailor.executive.planning.ground_space import GroundSpace
from tailor.executive.planning.plans.portions import completed_work
from tailor.executive.planning.structures.random_source import RandomSource
from tests.support.planning.planning_problems import read

LITERALS = st.sampled_from(["(at ?r ?x)", "(at ?r ?y)", "(free ?r)", "(seen ?x)", "(seen ?y)"])
WHEN = st.sampled_from(["at start", "at end"])
CONDITION = st.builds("({} {})".format, st.sampled_from(["at start", "over all", "at end"]), LITERALS)
EFFECT = st.one_of(
    st.builds("({} {})".format, WHEN, LITERALS),
    st.builds("({} (not {}))".format, WHEN, LITERALS),
    st.builds("(when (at start {}) ({} {}))".format, LITERALS, WHEN, LITERALS),
)
GO = "(at start (at ?r ?x))", "(at start (not (at ?r ?x))) (at end (at ?r ?y))"
WORK = "(at start (free ?r)) (over all (at ?r ?x))", "(at start (not (free ?r))) (at end (free ?r)) (at end (seen ?x))"
SWAP = "(over all (at ?r ?x))", "(at end (not (at ?r ?x))) (at end (at ?r ?y)) (at end (seen ?y))"
ACTION = st.builds(
    lambda base, condition, effect, least, more: (
        f":parameters (?r ?x ?y) :duration (and (>= ?duration {least}) (<= ?duration {least + more}))"
        f" :condition (and {base[0]} {' '.join(condition)}) :effect (and {base[1]} {' '.join(effect)})"
    ),
    st.sampled_from([GO, GO, WORK, WORK, SWAP, ("", "")]),
    st.lists(CONDITION, max_size=1),
    st.one_of(st.just([]), st.lists(EFFECT, max_size=2)),
    st.integers(1, 6),
    st.integers(0, 2),
)
FACTS = [f"(at {r} {x})" for r in "ab" for x in "hk"] + ["(free a)", "(free b)", "(seen h)"]
GOALS = st.sampled_from(["(at a k)", "(seen h)", "(seen k)", "(at b k)", "(free a)"])
TASK = st.builds(
    lambda actions, initial, goal: (
        "(define (domain d) (:requirements :durative-actions :duration-inequalities :conditional-effects)"
        " (:predicates (at ?r ?x) (free ?r) (seen ?x))"
        + " ".join(f"(:durative-action a{n} {text})" for n, text in enumerate(actions)) + ")",
        f"(define (problem x) (:domain d) (:objects a b h k) (:init (at a h) (free a) {' '.join(initial)})"
        f" (:goal (and {' '.join(goal)})))",
    ),
    st.lists(ACTION, min_size=1, max_size=3),
    st.lists(st.sampled_from(FACTS), max_size=2, unique=True),
    st.lists(GOALS, min_size=1, max_size=3, unique=True),
)  # fmt: skip
RELAXED = settings(max_examples=60, deadline=None, derandomize=True, suppress_health_check=list(HealthCheck))


class Ancestry(GroundSpace):
    """A plan space that knows of what each partial plan was made."""

    def __init__(self, *arguments):
        super().__init__(*arguments)
        self.made_of = {}
        self.completed = []

    def refine(self, plan, order):
        children = super().refine(plan, order)
        self.made_of.update((id(child), (child, plan)) for child in children)
        return children

    def line_of(self, plan):
        """The plan, and those that it was made of."""
        line = [plan]
        while id(line[-1]) in self.made_of:
            line.append(self.made_of[id(line[-1])][1])
        return line

    def extract(self, plan):
        self.completed.append((plan, super().extract(plan)))
        return self.completed[-1][1]


def test_no_plan_is_shorter_than_the_bound_of_what_it_was_made_of():
    ratios = []

    @RELAXED
    @given(TASK)
    def check(texts):
        domain, problem = read(*texts)
        *_, grounded = ground_actions(problem, static_world(problem), 0.01, 100_000)
        task = completed_work(make_task(problem, grounded))
        occupation = Occupation(task, completed_work(exclusive_facts(task)))
        options = Settings(node_limit=300)
        space = Ancestry(task, grounded.world, options, RandomSource(0))
        engine = BestFirst(space, options)
        engine.goes_on = True
        for result in engine.run():
            if result is not None and result.plan is None:
                break
        for complete, plan in space.completed:
            assert validate(plan, domain, problem) == ""
            makespan = task.grid.units(plan.makespan)
            for part in space.line_of(complete):
                bound = occupation.bound(part)
                assert bound <= makespan
                ratios.append(bound / max(makespan, 1))

    check()
    assert sum(ratio > 0.9 for ratio in ratios) > 1000, len(ratios)  # the bound is often nearly reached


def test_the_bound_changes_no_proven_makespan(monkeypatch):
    proven = []

    def outcome(texts):
        domain, problem = read(*texts)
        search = AnytimeSearch(domain, problem, Settings(engine="pocl", node_limit=2000))
        while not search.ended:
            search.advance(CheckBudget(10**6))
        if search.best.plan is not None:
            assert validate(search.best.plan, domain, problem) == ""
        return search.value, search.ended

    @RELAXED
    @given(TASK)
    def check(texts):
        value, ended = outcome(texts)
        with monkeypatch.context() as without:
            without.setattr(Occupation, "bound", lambda self, plan: 0)
            without.setattr(Occupation, "applies", False)
            other, other_ended = outcome(texts)
        if ended == other_ended == "proven":
            proven.append(value)
            assert value == other
        elif ended == "proven":
            assert value <= other
        elif other_ended == "proven":
            assert other <= value

    check()
    assert len(set(proven)) > 3
