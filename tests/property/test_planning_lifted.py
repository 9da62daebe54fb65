"""Lifted against ground planning on small random problems of the whole language: one verdict, and every plan sound."""

from itertools import product

from hypothesis import HealthCheck, assume, given, settings
from hypothesis import strategies as st

from tailor.executive.planning import Settings, validate
from tailor.executive.planning.semantics.action_effects import apply_action
from tailor.executive.planning.semantics.state import Objects, conditions_at, holds
from tests.support.planning.planning_problems import read, solve

NAMES = ["?x", "?y", "a", "b"]
ATOMS = [*(f"({p} {name})" for p in "pq" for name in NAMES), *(f"(s {n} {m})" for n in NAMES for m in NAMES), "(r)"]
FACTS = [atom for atom in ATOMS if "?" not in atom]
STATIC = ["(fixed ?x)", "(fixed ?y)", "(not (fixed ?x))", "(= ?x ?y)", "(not (= ?x ?y))"]


def signed(atoms):
    return st.sampled_from([*atoms, *(f"(not {atom})" for atom in atoms)])


LITERAL = signed(ATOMS)


def joined(word, parts, **sizes):
    return st.lists(parts, **sizes).map(lambda some: f"({word} {' '.join(some)})")


def formulas(literal):
    """Conjunctions, and now and then a disjunction, an implication or a quantifier over one of the variables."""
    plain = joined("and", st.one_of(literal, literal, st.sampled_from(STATIC)), max_size=2)
    return st.one_of(
        plain,
        plain,
        joined("or", plain, min_size=1, max_size=2),
        st.builds("(imply {} {})".format, literal, plain),
        st.builds("({} (?y - (either odd even)) {})".format, st.sampled_from(["forall", "exists"]), plain),
        st.builds("(not (exists (?x) {}))".format, plain),
    )


def timed(moments, formula):
    return st.builds("({} {})".format, st.sampled_from(moments), formula)


EVERY = ["at start", "over all", "at end"]
DURATIONS = [
    "(= ?duration 2)",
    "(= ?duration (length ?x))",
    "(and (>= ?duration (length ?y)) (<= ?duration (* 2 (length ?x))))",
]
EFFECT = timed(EVERY[::2], LITERAL)
EFFECTS = joined(
    "and",
    st.one_of(
        EFFECT,
        EFFECT,
        st.builds("(when {} (at end {}))".format, timed(EVERY[::2], formulas(LITERAL)), LITERAL),
        st.builds("(forall (?y) (when (at start {}) (at start {})))".format, LITERAL, LITERAL),
        st.builds(
            "(when (and {} {}) (at end {}))".format, timed(EVERY[:1], LITERAL), timed(EVERY[2:], LITERAL), LITERAL
        ),
    ),
    min_size=1,
    max_size=3,
)
DURATIVE = st.builds(
    ":parameters (?x ?y) :duration {} :condition {} :effect {}".format,
    st.sampled_from(DURATIONS),
    joined("and", timed(EVERY, formulas(LITERAL)), max_size=2),
    EFFECTS,
)
INSTANT = st.builds(
    ":parameters (?x - even ?y) :precondition {} :effect {}".format,
    formulas(LITERAL),
    joined(
        "and",
        st.one_of(LITERAL, LITERAL, st.builds("(when {} {})".format, formulas(LITERAL), LITERAL),
                  st.builds("(forall (?y) (when {} {}))".format, LITERAL, LITERAL)),
        min_size=1,
        max_size=3,
    ),
)  # fmt: skip
OF_X = signed([atom for atom in ATOMS if "?y" not in atom])
GOAL = st.one_of(
    signed(FACTS),
    signed(FACTS),
    st.builds("(exists (?x) (and {} {}))".format, OF_X, OF_X),
    st.builds("(forall (?x - even) (or {} {}))".format, OF_X, OF_X),
)
WINDOW = st.builds("(at {} {})".format, st.sampled_from(["1", "4", "9.5"]), signed(FACTS))


def tasks(word, action, windows):
    return st.tuples(
        st.lists(action, min_size=1, max_size=3).map(
            lambda actions: (
                "(define (domain d) (:types odd even) (:constants a - odd b - even)"
                " (:predicates (p ?o) (q ?o) (s ?o ?u) (r) (fixed ?o)) (:functions (length ?o))"
                + " ".join(f"({word} a{n} {action})" for n, action in enumerate(actions))
                + ")"
            )
        ),
        st.builds(
            "(define (problem x) (:domain d) (:init (fixed a) (= (length a) 3) (= (length b) 5) {} {})"
            " (:goal {}))".format,
            st.lists(st.sampled_from(FACTS), max_size=4).map(" ".join),
            st.lists(WINDOW, max_size=windows, unique_by=lambda window: window.split()[1]).map(" ".join),
            joined("and", GOAL, min_size=1, max_size=2),
        ),
    )


def agree(domain, problem):
    """Both find sound plans; neither proves unsolvable what the other solves. The results by mode, ground first."""
    found = {}
    for ground in (True, False):
        result = solve(domain, problem, Settings(node_limit=100, ground=ground))
        found[ground] = result
        if result.plan is not None:
            assert validate(result.plan, domain, problem) == "", f"{'ground' if ground else 'lifted'} {problem}"
    statuses = {result.status for result in found.values()}
    assert statuses != {"solved", "unsolvable"}, f"{statuses} {problem}"
    return found


SMALL = settings(max_examples=60, deadline=None, derandomize=True, suppress_health_check=list(HealthCheck))


@SMALL
@given(tasks(":action", INSTANT, windows=0))
def test_lifted_and_ground_agree_on_instant_actions(texts):
    agree(*read(*texts))


@SMALL
@given(tasks(":durative-action", DURATIVE, windows=2))
def test_lifted_and_ground_agree_on_durative_actions_and_timed_literals(texts):
    agree(*read(*texts))


# --- goals that actions reach by undoing what others need -------------------------------------------
def moves(domain, problem, state):
    """The names of the actions that change a state, and the states that they lead to."""
    objects = Objects(problem)
    for action in domain.actions:
        for names in product(*(objects.of(p) for p in action.parameters)):
            binding = dict(zip((p.name for p in action.parameters), names, strict=True))
            if holds(conditions_at(action.conditions, "start"), binding, state, objects):
                after = apply_action(domain, problem, state, (action.name, *names))
                if after != state:
                    yield after


def strolled(domain, problem, rng):
    """The problem with some of what four random actions change as its goal."""
    state = first = frozenset(problem.initial)
    for _ in range(4):
        ways = sorted(moves(domain, problem, state), key=sorted)
        state = rng.choice(ways) if ways else state
    changed = [f"({' '.join(fact)})" for fact in sorted(state - first)]
    changed += [f"(not ({' '.join(fact)}))" for fact in sorted(first - state)]
    assume(len(changed) > 1)
    return problem.with_goal(f"(and {' '.join(rng.sample(changed, min(3, len(changed))))})")


PLAIN = st.builds(
    ":parameters (?x ?y) :precondition {} :effect {}".format,
    joined("and", LITERAL, max_size=2),
    joined("and", LITERAL, min_size=1, max_size=3),
)


def test_lifted_and_ground_agree_where_actions_undo_what_others_need():
    steps = []

    @SMALL
    @given(tasks(":action", PLAIN, windows=0), st.randoms(use_true_random=False))
    def check(texts, rng):
        domain, problem = read(*texts)
        found = agree(domain, strolled(domain, problem, rng))
        assert {result.status for result in found.values()} <= {"solved", "limit"}
        steps.append(len(found[False].plan.steps) if found[False].plan else 0)

    check()
    assert sum(count > 1 for count in steps) > 10  # a single action is threatened by no other
