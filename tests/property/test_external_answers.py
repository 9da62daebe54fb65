"""Whatever an external planner prints is a sound plan or a reason; it never raises anything else."""

import random
import re

import pytest

from tailor.executive.planning import PlanTextError, completed, format_links, parse_plan, validate
from tests.support.planning.planning_problems import DATA, own

NUMBERS = ("0", "-1", "9" * 20, "9" * 400, "9" * 5000, "1e999", "inf", "nan", "123456789012", "0.000001")
LETTERS = "()<>:-> \n;[]not0\0"
ANSWERS = [(path.read_text(), own(path.name.split(".")[0])) for path in sorted((DATA / "vhpop-output").glob("*.txt"))]


def mutated(text, rng):
    """The text with a number, a word, a line or a letter changed, or its end cut off."""
    lines = text.split("\n")
    words = list(re.finditer(r"[a-z0-9-]+", text)) or [re.search("$", text)]
    one, other = rng.choice(words), rng.choice(words)
    at = rng.randrange(len(text) + 1)
    match rng.randrange(6):
        case 0:
            numbers = list(re.finditer(r"-?\d+", text)) or [one]
            chosen = rng.choice(numbers)
            return text[: chosen.start()] + rng.choice(NUMBERS) + text[chosen.end() :]
        case 1:
            return text[: one.start()] + other.group() + text[one.end() :]
        case 2:
            lines.insert(rng.randrange(len(lines) + 1), rng.choice(lines))
        case 3:
            del lines[rng.randrange(len(lines))]
        case 4:
            return text[:at] + rng.choice(LETTERS) + text[at + 1 :]
        case 5:
            return text[:at]
    return "\n".join(lines)


def test_3000_mutated_answers_are_sound_plans_or_reasons():
    rng = random.Random(7)
    found = {"plan": 0, "unsound": 0, "text": 0}
    for _ in range(3000):
        text, problem = rng.choice(ANSWERS)
        for _ in range(rng.randrange(1, 4)):
            text = mutated(text, rng)
        try:
            plan = completed(parse_plan(text), *problem)
        except PlanTextError:
            found["text"] += 1
            continue
        found["unsound" if isinstance(plan, str) else "plan"] += 1
        if not isinstance(plan, str):
            assert validate(plan, *problem) == ""
            if plan.durative == bool(plan.bounds):  # a durative plan that was linked anew has no times
                assert validate(parse_plan(format_links(plan)), *problem) == ""
    assert min(found.values()) > 100, found


@pytest.mark.parametrize("number", ["9" * 400, "9" * 5000, "1" * 13])
def test_numbers_beyond_any_plan_are_refused(number):
    for text in (
        f"{number}:(a b)",
        f"1:(a b)[{number}]",
        f"Step {number} : (a b)\nGoal :\n",
        f"Step 1 : (a b)\nGoal :\norderings =\n 0 {number} {number}\n -{number} 0 1\n -1 -1 0\n",
        f"Goal :\ntolerance = {number}\n",
    ):
        with pytest.raises(PlanTextError, match="digits"):
            parse_plan(text)
