"""Text that was once misread in silence: names that are none, contradictions, junk between definitions, numbers."""

import pytest

from tailor.executive.planning import PddlError, parse_domain, parse_problem
from tailor.executive.planning.pddl.syntax.definitions import split_definitions

DOMAIN = """(define (domain d) (:types a b)
 (:predicates (p ?x - a) (r)) (:functions (total-cost))
 (:action go :parameters (?x - a) :effect (p ?x)))"""
TIMED = """(define (domain d) (:predicates (p) (r)) (:functions (total-cost) (f))
 (:durative-action go :parameters () :duration {duration} :condition () :effect {effect}))"""
PROBLEM = "(define (problem t) (:domain d)\n (:objects x - a)\n (:init (r))\n (:goal (r)))"
DASH = "; a '-' between names and their type stands alone"


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("(:types a b)", "(:types a -b)", f"1:30: expected a name, found '-b'{DASH}"),
        ("(:types a b)", "(:types a b - ?c)", "1:34: expected a type, found '?c'"),
        ("?x - a) (r)", "?x -a) (r)", f"2:21: expected a variable, found '-a'{DASH}"),
        ("(r))", "(?r))", "2:27: expected a name, found '?r'"),
        ("(r))", "(and ?x))", "2:27: 'and' cannot be the name of a predicate"),
        ("(r))", "(= ?x ?y))", "2:27: '=' cannot be the name of a predicate"),
        ("(r))", "(increase))", "2:27: 'increase' cannot be the name of a predicate"),
        ("(total-cost)", "(+ ?x)", "2:44: '+' cannot be the name of a function"),
        ("action go", "action", "3:11: expected the action's name, found ':parameters'"),
        ("domain d", "domain ?d", "1:17: expected the domain's name, found '?d'"),
        ("(r))", "(r\x1b[31m))", "2:28: a control character, U+001B"),
        ("(r))", "(r\x00))", "2:28: a control character, U+0000"),
        ("(r))", "(r) (r\u200b))", "2:32: an invisible character, U+200B"),
        ("(r))", "(r)) ; \u202e", "2:33: an invisible character, U+202E"),
        ("(:types a b)", "(:types a b) ()", "1:33: expected a part such as (:action ...), found ()"),
        ("(:types a b)", "(:types a b) ((r) r)", "1:33: expected a part such as (:action ...), found ((...) ...)"),
        (
            "(:types a b)",
            "(:types a b) (:requirements strips)",
            "1:48: expected a requirement such as :typing, found 'strips'",
        ),
    ],
)
def test_a_domain_with_names_that_are_none_is_refused(old, new, message):
    with pytest.raises(PddlError) as caught:
        parse_domain(DOMAIN.replace(old, new, 1), "d.pddl")
    assert str(caught.value) == f"d.pddl:{message}"


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("x - a", "x -a", f"2:14: expected a name, found '-a'{DASH}"),
        ("x - a", "?x - a", "2:12: expected a name, found '?x'"),
        ("(r))", "(r) (not (r)))", "3:13: (not (r)) and its opposite in the initial state"),
        ("(r))", "(not (r)) (r))", "3:19: (r) and its opposite in the initial state"),
        ("(r))", "(r) (at 0 (not (r))))", "3:13: (not (r)) and its opposite in the initial state"),
        ("(r))", "(at 1_0 (r)))", "3:13: expected a number, found '1_0'"),
        ("(r))", "(r) ())", "3:13: expected an atom such as (predicate argument), found ()"),
        ("(r))", "(= () 3))", "3:12: expected a function such as (distance a b), found ()"),
        (
            " (:goal",
            " (:metric minimize (total-time x)) (:goal",
            "4:2: the metric minimize (total-time x) is not",
        ),
    ],
)
def test_a_problem_that_can_be_read_in_two_ways_is_refused(old, new, message):
    with pytest.raises(PddlError) as caught:
        parse_problem(PROBLEM.replace(old, new, 1), parse_domain(DOMAIN), "p.pddl")
    assert str(caught.value).startswith(f"p.pddl:{message}")


@pytest.mark.parametrize("number", ["1_0", "１", "nan", "infinity", "0x10", "1e", "."])
def test_numbers_are_decimal(number):
    with pytest.raises(PddlError, match=r"d.pddl:2:61: expected a number, found "):
        parse_domain(TIMED.format(duration=f"(= ?duration {number})", effect="(at end (p))"), "d.pddl")


@pytest.mark.parametrize(
    ("duration", "effect", "message"),
    [
        ("(= ?d 3)", "()", "2:51: expected ?duration, found '?d'"),
        ("(?duration 3)", "()", "2:48: expected (= ?duration ...), (<= ?duration ...) or (>= ?duration ...), "
         "found (?duration ...)"),
        ("(= ?duration (p))", "()", "2:61: expected a number or a function, found (p ...)"),
        ("()", "(p)", "2:73: expected (at start ...), (over all ...) or (at end ...), found (p ...)"),
    ],
)  # fmt: skip
def test_what_stands_in_place_of_a_duration_or_a_moment_is_named(duration, effect, message):
    with pytest.raises(PddlError) as caught:
        parse_domain(TIMED.format(duration=duration, effect=effect), "d.pddl")
    assert str(caught.value) == f"d.pddl:{message}"


@pytest.mark.parametrize("number", ["3", "3.", ".3", "+3", "3e0", "3.0E-1"])
def test_numbers_have_all_forms_of_decimals(number):
    domain = parse_domain(TIMED.format(duration=f"(= ?duration {number})", effect="(at end (p))"))
    assert domain.actions[0].duration[0].value.value == float(number)


# --- costs -----------------------------------------------------------------------------------------
@pytest.mark.parametrize(
    "effect",
    [
        "(and (at start (p)) (at end (increase (total-cost) 2)))",
        "(and (at start (p)) (and (at end (increase (total-cost) 2))))",
        "(at end (and (p) (increase (total-cost) 2)))",
        "(and (at end (and (increase (total-cost) 2))) (at end (p)))",
    ],
)
def test_a_cost_may_stand_in_any_conjunction(effect):
    action = parse_domain(TIMED.format(duration="(= ?duration 1)", effect=effect)).actions[0]
    assert (action.cost.value, len(action.effects)) == (2, 1)


@pytest.mark.parametrize(
    ("effect", "message"),
    [
        (
            "(when (at start (r)) (at end (increase (total-cost) 2)))",
            "a numeric effect (increase ...) under",
        ),
        ("(at middle (increase (total-cost) 2))", "expected (at start ...), (over all ...) or (at end ...)"),
        ("(over all (increase (total-cost) 2))", "an effect over all is not supported"),
        ("(at end (increase (total-cost) (+ " + "1 " * 101 + ")))", "the action's cost has more than 100 numbers"),
        ("(and (at end (increase (total-cost) 1)) (at end (and (increase (total-cost) 1))))", "increased twice"),
    ],
)
def test_a_cost_elsewhere_is_refused_by_name(effect, message):
    with pytest.raises(PddlError) as caught:
        parse_domain(TIMED.format(duration="(= ?duration 1)", effect=effect), "d.pddl")
    assert message in str(caught.value)


# --- domain and problem in one text ----------------------------------------------------------------
@pytest.mark.parametrize(
    ("text", "message"),
    [
        (f"{DOMAIN} junk\n{PROBLEM}", "both:3:52: expected '(', found 'junk'"),
        (f"{DOMAIN})\n{PROBLEM}", "both:3:51: this parenthesis was never opened"),
        (f"{DOMAIN[:-1]}\n{PROBLEM}", "both:1:1: this parenthesis is never closed"),
        (f"{DOMAIN}\n(domain d)\n{PROBLEM}", "both:4:1: expected (define (domain ...) ...) or (define (problem ...)"),
        (f"\r{DOMAIN}\r\x0c{DOMAIN}".replace("\n", "\r"), "both:5:2: a second domain"),
    ],
)
def test_nothing_but_both_definitions_stands_in_one_text(text, message):
    with pytest.raises(PddlError) as caught:
        split_definitions(text, "both")
    assert str(caught.value).startswith(message)


def test_comments_may_stand_anywhere_in_a_text_with_both():
    text = (
        f"; (\n{DOMAIN.replace('define', 'define ; (one', 1).replace(' (domain', chr(10) + ' (domain', 1)};\n{PROBLEM}"
    )
    domain, problem = split_definitions(text, "both")
    assert parse_problem(problem, parse_domain(domain)).name == "t"
