"""A second opinion: the independent validator of kairos-planner accepts our plans and refuses what ours refuses."""

import dataclasses

import pytest

from executive.planning import DEFAULT, MATCHING, Settings, format_plan, validate
from tests.planning_problems import DATA, OWN, SHARED, read, solve
from tests.unit.test_planning_language import IRON, TIMED, WORKSHOP

kairos = pytest.importorskip("kairos", reason="kairos-planner is not installed: no second opinion")

TEXTS = {
    name: [(DATA / "own" / f"{stem}.pddl").read_text() for stem in (f"{name.rsplit('-', 1)[0]}-domain", name)]
    for name in OWN
}
TEXTS |= {"window": [WORKSHOP, TIMED], "workshop": [WORKSHOP, IRON.replace("{more}", "")]}
for path in sorted((SHARED / "ipc" / "satellite-simpletime").glob("p0[1-4].pddl")):
    TEXTS[f"satellite-{path.stem}"] = [(path.parent / "domain.pddl").read_text(), path.read_text()]


def accepted(texts, plan):
    """Whether kairos finds the plan sound."""
    domain = kairos.parse_domain(texts[0])
    lines = (line for line in format_plan(plan).splitlines() if not line.startswith(";"))
    text = "\n".join(line.replace(":(", ": (").replace(")[", ") [") for line in lines)
    return kairos.validate(kairos.parse_problem(texts[1], domain), kairos.parse_plan(text)).valid


@pytest.mark.parametrize("settings", [MATCHING, DEFAULT, Settings(ground=False, node_limit=400)])
@pytest.mark.parametrize("name", TEXTS)
def test_our_plans_are_sound_in_anothers_eyes(name, settings):
    result = solve(*read(*TEXTS[name]), settings)
    if result.plan is None:
        assert not settings.ground  # too much, or too rich, for lifted planning
    else:
        assert accepted(TEXTS[name], result.plan)


@pytest.mark.parametrize("name", [name for name in TEXTS if "durative" in name])
def test_both_refuse_the_same_plans(name):
    domain, problem = read(*TEXTS[name])
    plan = dataclasses.replace(solve(domain, problem).plan, links=())
    for number, step in enumerate(plan.steps):
        for start in (step.start - 3, step.start - 0.5, step.start + 0.005, step.start + 2):
            if start > 0:
                moved = dataclasses.replace(step, start=start)
                steps = sorted([*plan.steps[:number], moved, *plan.steps[number + 1 :]], key=lambda s: s.start)
                other = dataclasses.replace(plan, steps=tuple(steps))
                assert (validate(other, domain, problem) == "") == accepted(TEXTS[name], other), format_plan(other)
