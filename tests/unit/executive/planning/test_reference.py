"""Same behaviour as the original VHPOP: plans, counts, text; on the project's own problems, and IPC's where given."""

import pytest

from tailor.executive.planning import (
    DEFAULT,
    MATCHING,
    FlawOrder,
    Settings,
    format_links,
    format_plan,
    parse_plan,
    validate,
)
from tailor.executive.planning.settings import DEFAULT_RANKINGS
from tests.support.planning.planning_problems import DATA, OWN, SHARED, load, own, printed, reference, solve

# VHPOP 2.2.1 under `g-mwloc`
FIGURES = {problem: row for (_, problem), row in reference(DATA, "22-g-mwloc").items()}
# The four flaw orders in round robin of the competition of 2002; the first is MW-Loc.
IPC3 = Settings(
    DEFAULT_RANKINGS,
    (
        FlawOrder("{n,s}LR/{l}MW_add", 10_000),
        FlawOrder("{n,s}LR/{u}MW_add/{l}MW_add", 100_000),
        FlawOrder("{n,s,l}LR", 240_000),
        FlawOrder("{n,s,u}LR/{l}LR"),
    ),
    node_limit=400_000,
    engine="pocl",
)


def assert_same_counts(result, row):
    tolerance = 2 if row["durative"] == "1" else 0  # two durative kitchens take one plan less
    assert abs(result.generated - int(row["plans_generated"])) <= tolerance
    assert abs(result.visited - int(row["plans_visited"])) <= tolerance


@pytest.mark.parametrize("name", OWN)
def test_generates_and_visits_as_many_plans_as_the_original(name):
    result = solve(*own(name))
    assert len(result.plan.steps) == int(FIGURES[name]["steps"])
    assert_same_counts(result, FIGURES[name])


@pytest.mark.parametrize("key", sorted(reference(DATA, "22-ipc3")), ids="-".join)
def test_flaw_orders_take_turns_as_the_originals_do(key):
    row = reference(DATA, "22-ipc3")[key]
    result = solve(*own(key[1]), IPC3)
    assert len(result.plan.steps) == int(row["steps"])
    assert_same_counts(result, row)


@pytest.mark.parametrize("settings", [MATCHING, DEFAULT, Settings(ground=False)], ids=["matching", "default", "lifted"])
@pytest.mark.parametrize("name", OWN)
def test_every_own_problem_gets_a_sound_plan(name, settings):
    if not settings.ground and name in {"kitchen-s3", "kitchen-reach-s2", "kitchen-reach-s3", "soccer-durative-p3",
                                        "soccer-typed-p3"}:  # fmt: skip
        pytest.skip("the original needs more than 50 000 lifted plans for it as well")
    domain, problem = own(name)
    result = solve(domain, problem, settings)
    assert validate(result.plan, domain, problem) == ""


STRIPS = [name for name in OWN if "durative" not in name]


@pytest.mark.parametrize("name", STRIPS)
def test_prints_the_originals_plan_byte_for_byte(name):
    plan = solve(*own(name)).plan
    assert format_plan(plan) == printed(f"{name}.ground.plain")


@pytest.mark.parametrize("name", [name for name in STRIPS if name.startswith("kitchen")])
def test_prints_the_originals_causal_links_byte_for_byte(name):
    plan = solve(*own(name)).plan
    assert format_links(plan) == printed(f"{name}.ground.links")


def test_ground_plan_keeps_the_links_to_static_facts_that_the_original_only_prints_when_lifted():
    plan = solve(*own("soccer-p1")).plan
    expected = printed("soccer-p1.lifted.links")
    assert format_links(plan) == expected[: expected.index("bindings")]


def test_both_robots_work_when_the_makespan_ranks():
    settings = Settings(("ADDR", "MAKESPAN", "LIFO"), (FlawOrder("MW-Loc"),))
    result = solve(*own("kitchen-durative-s3"), settings)
    assert result.plan.makespan == pytest.approx(28, abs=0.1)
    assert {step.action[1] for step in result.plan.steps} == {"r1", "r2"}
    assert solve(*own("kitchen-durative-s3")).plan.makespan == pytest.approx(56, abs=0.1)


@pytest.mark.parametrize("form", ["links", "plain"])
@pytest.mark.parametrize("name", OWN)
def test_reads_what_the_original_prints(name, form):
    plan = parse_plan(printed(f"{name}.ground.{form}"))
    assert validate(plan, *own(name)) == ""


# --- IPC -----------------------------------------------------------------------------------------
IPC = {key: row for key, row in reference(SHARED, "22-ipc3").items() if key[0].startswith("ipc/")}
# within the first 1000 plans only the first flaw order is used: these are its counts
FIRST_ROUND = {key: row for key, row in IPC.items() if int(row["plans_generated"]) < 1000}
LATER_ROUNDS = {key: row for key, row in IPC.items() if key not in FIRST_ROUND}
# The cause is not known; docs/tried.md lists what it is not.
NEARLY = {("ipc/rovers-strips", "p07")}
given = pytest.mark.skipif(not IPC, reason="../shared/pddl is absent: no competition problems to compare with")


def ipc(folder, name):
    return load(SHARED / folder / "domain.pddl", SHARED / folder / f"{name}.pddl")


@given
@pytest.mark.parametrize("key", sorted(FIRST_ROUND), ids="-".join)
def test_ipc_counts_are_the_originals(key):
    domain, problem = ipc(*key)
    result = solve(domain, problem)
    assert validate(result.plan, domain, problem) == ""
    assert len(result.plan.steps) <= int(FIRST_ROUND[key]["steps"])
    assert_same_counts(result, FIRST_ROUND[key])


@given
@pytest.mark.slow
@pytest.mark.parametrize("key", sorted(LATER_ROUNDS), ids="-".join)
def test_ipc_counts_in_turns_are_the_originals(key):
    domain, problem = ipc(*key)
    result = solve(domain, problem, IPC3)
    assert validate(result.plan, domain, problem) == ""
    if key in NEARLY:
        assert result.generated == pytest.approx(int(LATER_ROUNDS[key]["plans_generated"]), rel=0.001)
        assert result.visited == pytest.approx(int(LATER_ROUNDS[key]["plans_visited"]), rel=0.005)
    else:
        assert_same_counts(result, LATER_ROUNDS[key])


TRIED = {key for key in reference(SHARED, "g-mwloc", "") if key[0].startswith("ipc/")}
CONFIGURATIONS = ("g-mwloc", "l-mwloc", "ipc3", "22-ipc3", "fix-ipc3", "default")


@given
@pytest.mark.slow
def test_default_configuration_solves_as_many_ipc_problems_within_10_000_plans_as_any_of_the_originals():
    solved = 0
    for folder, name in sorted(TRIED):
        domain, problem = ipc(folder, name)
        solved += solve(domain, problem, Settings(node_limit=10_000)).status == "solved"
    best = 0
    for config in CONFIGURATIONS:
        rows = reference(SHARED, config).items()
        best = max(best, sum(key[0].startswith("ipc/") and int(row["plans_generated"]) <= 10_000 for key, row in rows))
    assert solved >= best
