"""Same behaviour as the original VHPOP: plans, counts, text; on the project's own problems, and IPC's where given."""

import pytest

from executive.planning import DEFAULT, MATCHING, FlawOrder, Settings, format_links, format_plan, parse_plan, validate
from tests.planning_problems import OWN, SHARED, load, own, printed, reference, solve

# steps, generated, visited of VHPOP 2.2.1 under `g-mwloc`
FIGURES = {
    "soccer-p1": (2, 18, 4),
    "soccer-typed-p1": (4, 40, 12),
    "soccer-typed-p2": (7, 155, 39),
    "soccer-typed-p3": (12, 328, 87),
    "soccer-durative-p3": (12, 342, 91),
    "kitchen-s1": (4, 23, 9),
    "kitchen-s2": (8, 82, 38),
    "kitchen-s3": (13, 1681, 988),
    "kitchen-reach-s1": (6, 57, 17),
    "kitchen-reach-s2": (13, 1097, 578),
    "kitchen-reach-s3": (12, 602, 232),
}
# Where 2.2.1 and 3.0 differ we take 3.0's way (achievers in grounding order); these are its figures, which count the
# start and the placeholder of the solution once more.
NEWER = {"kitchen-s3": (13, 1681, 985), "kitchen-reach-s3": (12, 596, 228)}


@pytest.mark.parametrize("name", FIGURES)
def test_generates_and_visits_as_many_plans_as_the_original(name):
    result = solve(*own(name))
    steps, generated, visited = NEWER.get(name, FIGURES[name])
    assert len(result.plan.steps) == steps
    assert abs(result.generated - generated) <= 2
    assert abs(result.visited - visited) <= 2


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
IPC = reference(SHARED, "g-mwloc") if SHARED.exists() else {}
IPC = {key: row for key, row in IPC.items() if key[0].startswith("ipc/") and int(row["plans_generated"]) < 10_000}
# Known to differ, see docs/planning.md: a tie in the original's order of achievers, and its 3.0's own reading of
# actions that delete and restore what they demand (rovers' communicate). Ours are smaller but for satellite p04.
DIFFERENT = {("ipc/blocks", "p01"), ("ipc/satellite-strips", "p04"), ("ipc/satellite-simpletime", "p04")}


@pytest.mark.skipif(not IPC, reason="../shared/pddl is absent: no competition problems to compare with")
@pytest.mark.parametrize("key", sorted(IPC), ids="-".join)
def test_ipc_counts_are_the_originals(key):
    folder, name = key
    domain, problem = load(SHARED / folder / "domain.pddl", SHARED / folder / f"{name}.pddl")
    result = solve(domain, problem)
    row = IPC[key]
    assert validate(result.plan, domain, problem) == ""
    assert len(result.plan.steps) <= int(row["steps"])
    if key in DIFFERENT or folder == "ipc/rovers-strips":
        assert result.generated <= 1.05 * int(row["plans_generated"])
    else:
        assert abs(result.generated - int(row["plans_generated"])) <= 2
        assert abs(result.visited - (int(row["plans_visited"]) - 1)) <= 2


TRIED = {key for key in reference(SHARED, "g-mwloc", "") if key[0].startswith("ipc/")} if SHARED.exists() else set()
CONFIGURATIONS = ("g-mwloc", "l-mwloc", "ipc3", "22-ipc3", "fix-ipc3", "default")


@pytest.mark.slow
@pytest.mark.skipif(not IPC, reason="../shared/pddl is absent: no competition problems to compare with")
def test_default_configuration_solves_as_many_ipc_problems_within_10_000_plans_as_any_of_the_originals():
    solved = 0
    for folder, name in sorted(TRIED):
        domain, problem = load(SHARED / folder / "domain.pddl", SHARED / folder / f"{name}.pddl")
        solved += solve(domain, problem, Settings(node_limit=10_000)).status == "solved"
    best = 0
    for config in CONFIGURATIONS:
        rows = reference(SHARED, config).items()
        best = max(best, sum(key[0].startswith("ipc/") and int(row["plans_generated"]) <= 10_000 for key, row in rows))
    assert solved >= best
