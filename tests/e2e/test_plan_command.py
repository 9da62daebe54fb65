"""`tailor plan` as a user meets it: forms of output, exit codes, errors, an external planner."""

import io
import itertools
import json
import math
import subprocess
import sys
from pathlib import Path
from xml.etree import ElementTree

import pytest

from tailor.executive.planning import DEFAULT, AnytimeSearch, parse_plan, validate
from tailor.tools.benchmarks.planning_scale import problem_text
from tailor.tools.main import main
from tailor.tools.plan_search import limits, sources
from tests.support.planning.planning_problems import DATA, own, printed
from tests.unit.executive.planning.pddl.test_language import LAMPS, SWITCHES

OWN = DATA / "own"
SVG = "{http://www.w3.org/2000/svg}"
DOMAIN, PROBLEM = str(OWN / "kitchen-domain.pddl"), str(OWN / "kitchen-s1.pddl")
DURATIVE = [str(OWN / "kitchen-durative-domain.pddl"), str(OWN / "kitchen-durative-s3.pddl")]


def plan(capsys, *arguments):
    code = main(["plan", *arguments])
    captured = capsys.readouterr()
    return code, captured.out, captured.err


def test_prints_the_plain_form(capsys):
    assert plan(capsys, DOMAIN, PROBLEM) == (0, printed("kitchen-s1.ground.plain"), "")


def test_links_are_the_originals_byte_for_byte(capsys):
    assert plan(capsys, DOMAIN, PROBLEM, "--links")[1] == printed("kitchen-s1.ground.links")
    lifted = plan(capsys, str(OWN / "soccer-domain.pddl"), str(OWN / "soccer-p1.pddl"), "--links", "--lifted")
    assert lifted[1] == printed("soccer-p1.lifted.links")


def test_json_says_everything(capsys):
    code, out, _ = plan(capsys, *DURATIVE, "--json", "-h", "ADDR/MAKESPAN/LIFO", "-f", "MW-Loc")
    answer = json.loads(out)
    assert code == 0
    assert answer["status"] == "solved"
    assert answer["makespan"] == pytest.approx(28, abs=0.1)
    assert {"id", "start", "action", "duration"} == set(answer["steps"][0])
    assert {"producer", "literal", "consumer"} == set(answer["links"][0])
    assert answer["generated"] > answer["visited"] > 0
    assert answer["cpu_ms"] > 0
    assert [2, 1] in answer["orderings"]


def test_dot_and_svg_draw_links_and_orderings_apart(capsys):
    soccer = [str(OWN / "soccer-typed-domain.pddl"), str(OWN / "soccer-typed-p3.pddl")]
    _, dot, _ = plan(capsys, *soccer, "--dot")
    assert dot.startswith('digraph "soccer-typed-p3"')
    assert "style=dashed" in dot
    assert 'label="(has-ball r2 b2)' in dot
    _, svg, _ = plan(capsys, *soccer, "--svg")
    picture = ElementTree.fromstring(svg)
    paths = picture.findall(f".//{SVG}path[@marker-end]")
    dashed = [path for path in paths if path.get("stroke-dasharray")]
    assert 0 < len(dashed) < len(paths)
    assert "(dribbleball r1 b1 p2 p1)" in svg


def numbers(shape, *names):
    return [float(shape.get(name)) for name in names]


def segments(path):
    """The straight pieces of a line that runs down and across."""
    x, y, *pieces = path.get("d").removeprefix("M").split()
    x, y = float(x), float(y)
    for piece in pieces:
        then = (x, float(piece[1:])) if piece[0] == "V" else (float(piece[1:]), y)
        yield (x, y), then
        x, y = then


def hits(box, a, b):
    """Whether a piece of a line runs through the inside of a box."""
    left, top, width, height = box
    inside_x = min(a[0], b[0]) < left + width and max(a[0], b[0]) > left
    return inside_x and min(a[1], b[1]) < top + height and max(a[1], b[1]) > top


@pytest.mark.parametrize(
    "name", ["kitchen-s3", "soccer-typed-p3", "kitchen-durative-s3", "kitchen-reach-s2", "20 steps"]
)
def test_svg_holds_every_word_in_a_box_and_no_line_crosses_one(capsys, tmp_path, name):
    files = [str(OWN / f"{name[:-3]}-domain.pddl"), str(OWN / f"{name}.pddl")]
    if name == "20 steps":
        files = [DOMAIN, str(tmp_path / "cups.pddl")]
        Path(files[1]).write_text(problem_text(5))
    _, svg, _ = plan(capsys, *files, "--svg")
    picture = ElementTree.fromstring(svg)
    _, _, width, height = map(float, picture.get("viewBox").split())
    assert height > width / 2, "from top to bottom"
    boxes = [numbers(r, "x", "y", "width", "height") for r in picture.iter(f"{SVG}rect") if r.get("rx")]
    assert len(boxes) >= 4
    for left, top, w, h in boxes:
        assert 0 < left < left + w < width
        assert 0 < top < top + h < height
        assert sum(hits((left, top, w, h), (x, y), (x + u, y + v)) for x, y, u, v in boxes) == 1, "only itself"
    for word in picture.iter(f"{SVG}text"):
        (x, y, size), text = numbers(word, "x", "y", "font-size"), word.text
        assert any(u <= x and x + 0.55 * size * len(text) <= u + w and v < y < v + h for u, v, w, h in boxes), text
    lines = [list(segments(path)) for path in picture.iter(f"{SVG}path") if path.get("marker-end")]
    assert lines
    for a, b in (piece for line in lines for piece in line):
        assert 0 < max(a[0], b[0]) < width
        assert not any(hits(box, a, b) for box in boxes)
    across = [(a[1], *sorted((a[0], b[0]))) for line in lines for a, b in line if a[1] == b[1] and a[0] != b[0]]
    for n, (y, left, right) in enumerate(across):
        assert not any(y == z and left < v and u < right for z, u, v in across[:n]), "two lines on each other"


def test_options_have_vhpops_letters_and_names(capsys):
    options = ["-g", "-h", "ADDR/LIFO", "-f", "LCFR", "-l", "5000", "-f", "ZLIFO", "-l", "unlimited", "-s", "A", "-w2",
               "-a", "unit", "-t", "0.1", "-r", "-S", "3", "-v1", "-T", "1"]  # fmt: skip
    code, out, err = plan(capsys, DOMAIN, PROBLEM, *options)
    assert code == 0
    assert validate(parse_plan(out), *own("kitchen-s1")) == ""
    assert err.startswith("generated ")
    long = ["--ground-actions", "--heuristic", "UCPOP", "--flaw-order", "DSep-LIFO", "--limit", "100000",
            "--search-algorithm", "IDA", "--weight", "1", "--action-cost", "DURATION", "--tolerance", "0.01",
            "--random-open-conditions", "--seed", "1", "--verbose", "--time-limit", "1"]  # fmt: skip
    assert plan(capsys, DOMAIN, PROBLEM, *long)[0] == 0


@pytest.mark.parametrize("ranking", ["", "/", "ADDR/"])
def test_an_empty_ranking_is_none_and_not_the_default(capsys, ranking):
    code, out, err = plan(capsys, DOMAIN, PROBLEM, "-h", ranking)
    assert (code, out) == (2, "")
    assert "ranking '' is unknown; expected some of LIFO, " in err


@pytest.mark.parametrize("name", ["IDA", "ida", "IDA*", "a*"])
def test_searches_go_by_their_names_with_and_without_a_star(capsys, name):
    assert plan(capsys, DOMAIN, PROBLEM, "-s", name)[0] == 0


def test_a_pipe_is_read_once_even_when_another_program_plans(tmp_path):
    echo = tmp_path / "echo.py"
    echo.write_text("import sys; [open(f).read()[0] for f in sys.argv[1:]]; print('0:(approachball pos1 pos2)')")
    command = [sys.executable, "-P", "-m", "tailor.tools.main", "plan", str(OWN / "soccer-domain.pddl"), "-"]
    text = (OWN / "soccer-p1.pddl").read_text()
    for options in ([], ["--planner", f"{sys.executable} {echo}"]):
        done = subprocess.run([*command, *options], input=text, capture_output=True, text=True, cwd=DATA.parents[2])
        assert "IndexError" not in done.stderr
        expected = "unsound" if options else "1:(approachball pos1 pos2)"  # half a plan: the child received both texts
        assert expected in done.stdout + done.stderr


def test_verbose_stands_before_the_files_as_well(capsys):
    for option in ("-v", "-v2", "--verbose", "--verbose=1"):
        code, _, err = plan(capsys, option, DOMAIN, PROBLEM)
        assert (code, err[:10]) == (0, "generated ")


@pytest.mark.parametrize("minutes", ["-1", "nan", "soon"])
def test_a_time_limit_is_a_number_of_minutes(capsys, minutes):
    code, _, err = plan(capsys, DOMAIN, PROBLEM, "-T", minutes)
    assert (code, err) == (
        2,
        f"tailor plan: --time-limit: expected a number of minutes of at least 0, found '{minutes}'\n",
    )


def test_lifted_planning_speaks_what_ground_planning_does(capsys, tmp_path):
    replaced = {
        "unlock": "(or (on a) (on b))",
        "finish": "(forall (?r - room) (open ?r))",
        "effect": "(forall (?l - blue) (when (on ?l) (done)))",
        "goal": "(and (done) (exists (?l - red) (not (on ?l))))",
    }
    files = {"domain": SWITCHES, "problem": LAMPS}
    for name, text in files.items():
        whole = text
        for mark, formula in replaced.items():
            whole = whole.replace(f"{{{mark}}}", formula)
        (tmp_path / name).write_text(whole)
    for form in ("--ground-actions", "--lifted"):
        code, out, _ = plan(capsys, *(str(tmp_path / name) for name in files), form, "--json")
        assert code == 0
        assert sorted(step["action"][0] for step in json.loads(out)["steps"]) == ["finish", "press", "unlock", "unlock"]


# --- no plan -------------------------------------------------------------------------------------
@pytest.fixture
def hopeless(tmp_path):
    path = tmp_path / "hopeless.pddl"
    path.write_text("(define (problem hopeless) (:domain kitchen) (:objects c - cup t - place) (:goal (holding c)))")
    return str(path)


def test_unsolvable_and_limit_are_distinguished(capsys, hopeless):
    code, out, err = plan(capsys, DOMAIN, hopeless)
    assert (code, out) == (1, "")
    assert err == "hopeless: no plan exists: the goal cannot be reached, not even without delete effects\n"
    code, out, err = plan(capsys, DOMAIN, str(OWN / "kitchen-s3.pddl"), "--engine", "pocl", "-l", "100")
    assert (code, out) == (1, "")
    assert err == "kitchen-s3: no plan found: 100 plans generated\n"
    assert json.loads(plan(capsys, DOMAIN, hopeless, "--json")[1])["status"] == "unsolvable"
    assert json.loads(plan(capsys, DOMAIN, str(OWN / "kitchen-s3.pddl"), "-T", "0", "--json")[1])["status"] == "limit"


COSTS = """(define (domain d) (:predicates (r)) (:functions (total-cost) (f ?x))
  (:action act :parameters (?x) :effect (and (r) (increase (total-cost) (f ?x)))))
(define (problem x) (:domain d) (:objects a) (:init (= (f a) {})) (:goal (r)) (:metric minimize (total-cost)))"""


def test_a_negative_cost_is_bad_input(capsys, tmp_path):
    path = tmp_path / "both.pddl"
    path.write_text(COSTS.format(-1))
    reason = "the cost -1 of (act a) is not supported: it is below 0"
    assert plan(capsys, str(path)) == (2, "", f"x: no plan found: {reason}\n")
    code, out, _ = plan(capsys, str(path), "--json")
    assert (code, json.loads(out)["status"], json.loads(out)["reason"]) == (2, "unsupported", reason)


def test_costs_of_an_anytime_search_have_all_their_digits(capsys, tmp_path):
    path = tmp_path / "both.pddl"
    path.write_text(COSTS.format("1234567.25"))
    assert plan(capsys, str(path), "--anytime")[2].startswith("cost 1234567.25, 1 steps")


def test_pddl_outside_the_language_is_reported_with_its_place(capsys, tmp_path):
    path = tmp_path / "goal.pddl"
    path.write_text("(define (problem p) (:domain kitchen)\n (:goal (preference tidy (hand-empty))))")
    code, out, err = plan(capsys, DOMAIN, str(path), "--json")
    assert (code, json.loads(out)["status"]) == (2, "unsupported")
    assert json.loads(out)["reason"] == f"{path}:2:9: a preference is not supported"
    assert json.loads(out)["reason"] in err


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ([DOMAIN, "nowhere.pddl"], "nowhere.pddl: cannot be read: No such file or directory"),
        ([DOMAIN, DOMAIN], "kitchen-domain.pddl:2:9: expected (problem name), found (domain ...)"),
        ([PROBLEM, DOMAIN], "kitchen-s1.pddl:1:9: expected (domain name), found (problem ...)"),
        ([DOMAIN, DURATIVE[1]], "expected"),
        ([DOMAIN, PROBLEM, "-f", "FOO"], "flaw order 'FOO': expected a name"),
        ([DOMAIN, PROBLEM, "-h", "FOO"], "ranking 'FOO' is unknown"),
        ([DOMAIN, PROBLEM, "-l", "9" * 5000], "--limit: expected a number of plans of at least 1"),
        ([DOMAIN, PROBLEM, "--memory-limit", "9" * 5000], "--memory-limit: expected a whole number of MB"),
        ([DOMAIN, PROBLEM, "-l", "0"], "--limit: expected a number of plans of at least 1"),
        ([DOMAIN, PROBLEM, "-w", "-1"], "expected a weight in [0, 1e+100], found -1.0"),
        ([DOMAIN, PROBLEM, "-w", "inf"], "expected a weight in [0, 1e+100], found inf"),
        ([DOMAIN, PROBLEM, "-S", "-1"], "expected a seed of at least 0"),
        ([DOMAIN, PROBLEM, "-t", "1e-9"], "expected a tolerance in [1e-6, 1000] s"),
        ([DOMAIN, "/dev/zero"], "/dev/zero: more than the 1000000 bytes"),
        ([DOMAIN, PROBLEM, "-t", "soon"], "--tolerance: expected a tick in seconds, found 'soon'"),
        ([DOMAIN, PROBLEM, "--planner", " "], "--planner: expected a command, found ''"),
        (
            [DOMAIN, PROBLEM, "--planner", "cat", "--anytime"],
            "planner does not use --anytime: leave it out",
        ),
        ([DOMAIN, PROBLEM, "--planner", "cat", "-l", "9", "-t", "1"], "planner does not use -l, -t: leave them out"),
        ([DOMAIN, PROBLEM, "--engine", "kairos", "--lifted"], "--engine kairos does not use --lifted: leave it out"),
        ([DOMAIN, PROBLEM, "--engine", "forward", "-h", "ADD"], "--engine forward does not use -h: leave it out"),
        ([DOMAIN, PROBLEM, "--planner", "no-such-planner"], "planner command 'no-such-planner': cannot be started"),
    ],
)
def test_bad_input_is_one_line_and_exit_code_2(capsys, arguments, message):
    code, out, err = plan(capsys, *arguments)
    assert (code, out) == (2, "")
    assert err.startswith("tailor plan: ")
    assert err.count("\n") == 1
    if message != "expected":
        assert message in err


@pytest.mark.promise("P40")
def test_a_huge_file_is_rejected_before_it_is_read(capsys, tmp_path):
    path = tmp_path / "huge.pddl"
    with path.open("wb") as huge:
        huge.truncate(10_000_000)
    code, _, err = plan(capsys, str(path), PROBLEM)
    assert code == 2
    assert "more than" in err


# --- an external planner -------------------------------------------------------------------------
@pytest.mark.parametrize("form", ["links", "plain"])
def test_an_external_planners_plan_is_parsed_linked_and_validated(capsys, tmp_path, form):
    program = tmp_path / "vhpop.py"
    program.write_text(f"print({printed(f'kitchen-s1.ground.{form}')!r})")
    code, out, _ = plan(capsys, DOMAIN, PROBLEM, "--planner", f"{sys.executable} {program}", "--json")
    assert code == 0
    assert {"producer": 0, "literal": "(hand-empty)", "consumer": 2} in json.loads(out)["links"]


def test_an_external_planners_unsound_plan_is_rejected(capsys, tmp_path):
    program = tmp_path / "vhpop.py"
    program.write_text(f"print({printed('kitchen-s1.ground.links').replace('table2', 'dock')!r})")
    code, out, err = plan(capsys, DOMAIN, PROBLEM, "--planner", f"{sys.executable} {program}")
    assert (code, out) == (1, "")
    assert "unsound" in err


@pytest.mark.parametrize("output", ["", ";idle"])
def test_an_external_planner_may_find_that_nothing_is_to_be_done(capsys, tmp_path, output):
    idle = tmp_path / "idle.pddl"
    idle.write_text("(define (problem idle) (:domain kitchen) (:init (hand-empty)) (:goal (hand-empty)))")
    assert plan(capsys, DOMAIN, str(idle), "--planner", f"sh -c 'echo \"{output}\"'")[:2] == (0, ";idle\n")
    assert plan(capsys, DOMAIN, PROBLEM, "--planner", "true")[0] == 1


def test_help_teaches():
    printed = subprocess.run(
        [sys.executable, "-c", "from tailor.tools.main import main; main()", "plan", "--help"],
        capture_output=True,
        text=True,
    ).stdout
    for word in ("DOMAIN", "--links", "MW-Loc", "ADDR", "Exit codes", "Figure 10"):
        assert word in printed


def test_a_graph_is_sound_whatever_characters_names_have(capsys, tmp_path):
    domain, problem = tmp_path / "d.pddl", tmp_path / "p.pddl"
    domain.write_text('(define (domain d) (:predicates (p ?x)) (:action a"b\\\\ :parameters (?x) :effect (p ?x)))')
    problem.write_text('(define (problem "q) (:domain d) (:objects o"1) (:init) (:goal (p o"1)))')
    code, dot, _ = plan(capsys, str(domain), str(problem), "--dot")
    assert code == 0
    for line in dot.splitlines():
        assert line.replace("\\\\", "").replace('\\"', "").count('"') % 2 == 0, line


# --- habits of VHPOP's users ---------------------------------------------------------------------
@pytest.mark.parametrize("order", [(DOMAIN, PROBLEM), (PROBLEM, DOMAIN)])
def test_one_file_or_standard_input_may_hold_both(capsys, tmp_path, monkeypatch, order):
    expected = plan(capsys, DOMAIN, PROBLEM)[1]
    both = tmp_path / "both.pddl"
    both.write_text("; a comment with (a parenthesis\n" + "\n".join(Path(name).read_text() for name in order))
    assert plan(capsys, str(both)) == (0, expected, "")
    for files in ([], ["-"]):
        monkeypatch.setattr(sys, "stdin", io.TextIOWrapper(io.BytesIO(both.read_bytes())))
        assert plan(capsys, *files) == (0, expected, "")


@pytest.mark.parametrize(
    ("content", "place"),
    [
        (b"(define\r (domain \xff", "2:10: the byte 0xff"),
        (b"\xef\xbb\xbf;\xc3\xb6 \xe9", "1:4: the byte 0xe9"),
        (b"\x89PNG", "1:1: the byte 0x89"),
    ],
)
def test_the_first_byte_that_is_no_text_is_named_with_its_place(capsys, tmp_path, content, place):
    path = tmp_path / "binary.pddl"
    path.write_bytes(content)
    assert plan(capsys, str(path), PROBLEM) == (2, "", f"tailor plan: {path}:{place} is not UTF-8\n")


def test_closed_standard_input_is_one_line(capsys, monkeypatch):
    monkeypatch.setattr(sys, "stdin", None)
    assert plan(capsys) == (2, "", "tailor plan: -: cannot be read: standard input is closed\n")


def test_standard_input_is_read_for_one_file_only(capsys):
    code, _, err = plan(capsys, "-", "-")
    assert (code, "standard input is named twice" in err) == (2, True)


def test_errors_of_a_text_with_both_name_its_lines(capsys, tmp_path):
    both = tmp_path / "both.pddl"
    text = Path(DOMAIN).read_text() + "\n" + Path(PROBLEM).read_text()
    both.write_text(text.replace("(:goal", "(:gaol"))
    line = next(n for n, line in enumerate(text.splitlines(), 1) if "(:goal" in line)
    code, _, err = plan(capsys, str(both))
    assert code == 2
    assert f"both.pddl:{line}:" in err
    both.write_text(Path(DOMAIN).read_text())
    assert "found no (define (problem" in plan(capsys, str(both))[2]
    both.write_text(text + Path(PROBLEM).read_text())
    assert "a second problem" in plan(capsys, str(both))[2]


OLD_OPTIONS = ("-d", "-d1", "-v12", "-t unlimited", "-T unlimited", "-l unlimited")


@pytest.mark.parametrize("options", OLD_OPTIONS)
def test_options_of_older_versions_are_accepted(capsys, options):
    expected = plan(capsys, DOMAIN, PROBLEM)[1]
    assert plan(capsys, *options.split(), DOMAIN, PROBLEM)[:2] == (0, expected)


def test_the_version_is_printed(capsys):
    with pytest.raises(SystemExit) as end:
        plan(capsys, "-V")
    assert end.value.code == 0
    assert capsys.readouterr().out.startswith("tailor ")


def test_anytime_reports_each_improvement(capsys):
    code, out, err = plan(capsys, *DURATIVE, "--anytime", "-f", "MW-Loc", "-l", "2000")
    assert code == 0
    values = [float(line.split()[1].rstrip(",")) for line in err.splitlines() if line.startswith("makespan ")]
    assert values == [56.08, 28.04]
    assert "best plan found" in err
    assert out == plan(capsys, *DURATIVE, "-h", "ADDR/MAKESPAN/LIFO", "-f", "MW-Loc")[1] or "24.04" in out


def test_an_anytime_search_that_ends_by_its_limit_says_that_none_better_was_found(capsys):
    class AfterThePlan(limits.Limits):
        def spent(self):
            self.reached = "1 s" if search.best is not None and search.best.plan is not None else ""
            return bool(self.reached)

    domain, problem = own("kitchen-durative-s3")
    search = AnytimeSearch(domain, problem, DEFAULT)
    assert sources.anytime(search, AfterThePlan(math.inf, 512)).plan is not None
    assert capsys.readouterr().err.endswith("\nbest plan found: none better within 1 s\n")


def test_memory_is_limited(capsys, monkeypatch):
    assert 5 < limits.memory_mb() < 50_000
    values = itertools.count(100.0, 0.5)  # MB at the start and at each look
    monkeypatch.setattr(limits, "memory_mb", lambda: next(values))
    code, _, err = plan(capsys, DOMAIN, str(OWN / "kitchen-s3.pddl"), "--engine", "pocl", "--memory-limit", "1")
    assert code == 1
    assert "no plan within 1 MB of memory" in err
    assert plan(capsys, DOMAIN, PROBLEM, "--memory-limit", "none")[0] == 2


def test_a_long_name_is_cut_in_the_line_without_a_plan(capsys, tmp_path):
    (tmp_path / "both.pddl").write_text(
        f"(define (domain d) (:predicates (p))) (define (problem {'x' * 9000}) (:domain d) (:init) (:goal (p)))"
    )
    code, _, err = plan(capsys, str(tmp_path / "both.pddl"))
    assert code == 1
    assert "xxx..." in err
    assert len(err) < 300
