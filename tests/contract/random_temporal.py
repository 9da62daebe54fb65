"""Random problems with durations, conditional and quantified effects, timed literals and costs, by seed."""

import random

DOMAIN = """(define (domain d) (:requirements :adl :durative-actions :duration-inequalities :timed-initial-literals)
 (:predicates (p ?o) (q ?o) (r) (s) (stat ?o)) (:functions (len ?o) (speed) {cost})
 {actions})"""
PROBLEM = """(define (problem x) (:domain d) (:objects a b)
 (:init {cost} (stat a) (= (len a) 1.5) (= (len b) 2.25) (= (speed) 0.7) {facts}) (:goal (and {goal})) {metric})"""
FACTS = ["(p a)", "(p b)", "(q a)", "(q b)", "(r)", "(s)"]
OF_Z = ["(p ?z)", "(q ?z)"]
TICKS_S = (0.001, 0.01, 0.01, 0.25, 0.5, 1.0)
FIXED = ("1", "2.5", "0.1", "3.14159", "7", "(/ 10 3)", "0.333")
OF_X = ("(len ?x)", "(* 2 (len ?x))", "(/ (len ?x) (speed))", "(+ 0.1 (len ?x))")


def random_task(seed, costs=False):
    """Texts of a domain and a problem, and a tick in seconds."""
    rng = random.Random(seed)
    actions = " ".join(_action(rng, n, costs) for n in range(rng.randint(1, 4)))
    initial = rng.sample(FACTS, rng.randint(0, 3))
    for fact in rng.sample(FACTS, rng.choice([0, 0, 0, 1, 2])):
        initial.append(f"(at {rng.choice(['0.5', '1', '2.25', '3.333', '5'])} {_signed(rng, fact)})")
    goal = " ".join(_signed(rng, fact) for fact in rng.sample(FACTS, rng.randint(1, 3)))
    metrics = ["", "(:metric minimize (total-time))", "(:metric minimize (total-cost))" if costs else ""]
    start = "(= (total-cost) 0)" if costs else ""
    problem = PROBLEM.format(cost=start, facts=" ".join(initial), goal=goal, metric=rng.choice(metrics))
    return [DOMAIN.format(cost="(total-cost)" if costs else "", actions=actions), problem], rng.choice(TICKS_S)


def _signed(rng, fact):
    return fact if rng.random() < 0.7 else f"(not {fact})"


def _action(rng, number, costs):
    count = rng.choice([0, 1, 1, 2])
    facts = ["(r)", "(s)", *["(p ?x)", "(q ?x)", "(p ?y)", "(q ?y)"][: 2 * count]]
    head = f"a{number} :parameters ({' '.join(['?x', '?y'][:count])})"
    if rng.random() < 0.15:
        condition, effects = (" ".join(_signed(rng, rng.choice(facts)) for _ in range(n)) for n in (1, 2))
        return f"(:action {head} :precondition (and {condition}) :effect (and {effects}))"
    conditions = [_condition(rng, facts) for _ in range(rng.randint(0, 3))]
    conditions += ["(at start (stat ?x))"] * (count > 0 and rng.random() < 0.4)
    conditions += ["(at start (not (= ?x ?y)))"] * (count > 1 and rng.random() < 0.4)
    effects = [_effect(rng, facts) for _ in range(rng.randint(1, 4))]
    effects += ["(at end (increase (total-cost) 2.5))"] * (costs and rng.random() < 0.8)
    timing = f":duration {_duration(rng, count)} :condition (and {' '.join(conditions)})"
    return f"(:durative-action {head} {timing} :effect (and {' '.join(effects)}))"


def _condition(rng, facts):
    literal = _signed(rng, rng.choice(facts))
    kinds = {
        "or": f"(or {literal} {_signed(rng, rng.choice(facts))})",
        "forall": f"(forall (?z) {_signed(rng, rng.choice(facts + OF_Z))})",
        "exists": f"(exists (?z) (and {literal} {_signed(rng, rng.choice(OF_Z))}))",
        "": literal,
    }
    return (
        f"({rng.choice(['at start', 'over all', 'at end'])} {rng.choice([*kinds.values(), literal, literal, literal])})"
    )


def _effect(rng, facts):
    when, literal, kind = rng.choice(["at start", "at end"]), _signed(rng, rng.choice(facts)), rng.random()
    if kind < 0.15:
        given = "at start" if when == "at start" else rng.choice(["at start", "at end"])
        return f"(when ({given} {_signed(rng, rng.choice(facts))}) ({when} {literal}))"
    if kind < 0.25:
        return f"(forall (?z) ({when} {_signed(rng, rng.choice(OF_Z))}))"
    return f"({when} {literal})"


def _duration(rng, count):
    kind = rng.random()
    if kind < 0.6:
        return f"(= ?duration {rng.choice(OF_X if count and kind < 0.3 else FIXED)})"
    if kind < 0.8:
        return f"(and (>= ?duration {rng.choice(['0.5', '1', '2'])}) (<= ?duration {rng.choice(['2', '6', '2.7'])}))"
    return rng.choice(["(>= ?duration 1)", "(>= ?duration 0.25)", "(<= ?duration 1)", "(<= ?duration 4.5)"])
