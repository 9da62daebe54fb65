"""tailor evaluate: several evaluations in one call, what is left out, what is gone on with, and the first page."""

from __future__ import annotations

import argparse
import json
import math
import re
import sys
import types
from pathlib import Path

import pytest

from tailor.schemas.errors import UsageError
from tailor.tools.commands.measure import evaluate
from tailor.tools.evaluations import catalogue
from tailor.tools.evaluations.pages.overview import write_overview
from tailor.tools.evaluations.pages.report import Report, configure_report, publish_report, shown
from tailor.tools.evaluations.pages.stored_results import stored_result
from tailor.tools.evaluations.seeds import Seeds
from tailor.tools.launch.checks import package_check
from tailor.tools.main import main

CALLS: list[str] = []


def module(name, domains, run):
    """An evaluation that counts its calls and tells a row."""
    made = types.ModuleType(name)
    made.DOMAINS = domains

    def configure(parser):
        if name == "second":
            parser.add_argument("places", nargs="*")  # no value of another's flag goes here
        if name == "first":
            parser.add_argument("--episodes", type=int, default=1)
        configure_report(parser)

    def really_run(arguments):
        CALLS.append(name)
        assert getattr(arguments, "places", []) == []
        publish_report(Report(name, f"The {name} one", [{"scenario": name, "n": 3}], (), {}, {}), arguments)
        return run()

    made.configure, made.run = configure, really_run
    return made


def flags(folder):
    """As parsed of --json --report `folder`."""
    return argparse.Namespace(json=True, report=folder)


def refuse():
    raise UsageError("no data here")


@pytest.fixture(autouse=True)
def three(monkeypatch):
    """Evaluations "first" (soccer, 0), "second" (arm, 1) and "third" (soccer, refuses)."""
    CALLS.clear()
    made = {"first": (("soccer",), lambda: 0), "second": (("arm",), lambda: 1), "third": (("soccer",), refuse)}
    for name, (domains, run) in made.items():
        monkeypatch.setitem(sys.modules, f"stand_in.{name}", module(name, domains, run))
    for place in (catalogue, evaluate):
        monkeypatch.setattr(place, "EVALUATIONS", {name: (f"stand_in.{name}", "told") for name in made})


def test_the_worst_exit_code_is_that_of_all(capsys):
    assert main(["evaluate", "first", "second"]) == 1
    assert CALLS == ["first", "second"]


def test_the_lot_goes_on_where_one_cannot_run(capsys, tmp_path):
    assert main(["evaluate", "all", "--report", str(tmp_path)]) == 2
    assert CALLS == ["first", "second", "third"]
    assert "third: no data here" in capsys.readouterr().err


def test_one_that_cannot_run_alone_is_a_usage_error(capsys):
    assert main(["evaluate", "third"]) == 2
    assert capsys.readouterr().err == "tailor evaluate: no data here\n"


def test_a_package_at_fault_is_refused_before_anything_runs(monkeypatch, capsys):
    """A scenario file without its problem ended the evaluation in a traceback, after the runs of the others."""
    monkeypatch.setattr(package_check, "faults_of_package", lambda *_: ["scenarios/a.toml: problem is missing"])
    assert main(["evaluate", "first", "--domain", "soccer"]) == 2
    assert CALLS == []
    expected = "the package of soccer does not hold together: scenarios/a.toml: problem is missing\n"
    assert capsys.readouterr().err == f"tailor evaluate: {expected}"


def test_a_report_that_cannot_be_written_is_refused_before_anything_runs(tmp_path, capsys):
    (tmp_path / "file").touch()
    assert main(["evaluate", "all", "--report", str(tmp_path / "file")]) == 2
    assert f"--report {tmp_path}/file/index.html: File exists, expected a file" in capsys.readouterr().err
    assert CALLS == []


def test_resume_leaves_out_what_has_a_page(tmp_path, capsys):
    main(["evaluate", "first", "--report", str(tmp_path)])
    assert main(["evaluate", "first", "second", "--report", str(tmp_path), "--resume"]) == 1
    assert CALLS == ["first", "second"]


@pytest.mark.parametrize("other", ["source_sha256", "models_sha256", ""])
def test_resume_makes_pages_of_other_source_or_models_anew(other, tmp_path, capsys, monkeypatch):
    hashes = dict.fromkeys(("source_sha256", "models_sha256"), "a" * 64)
    monkeypatch.setattr(evaluate, "seeds_of", lambda *_: Seeds(1, hashes))
    main(["evaluate", "first", "--report", str(tmp_path)])
    page = tmp_path / "first.json"
    page.write_text(json.dumps({**json.loads(page.read_text()), "provenance": {**hashes, other: "b" * 64}}))
    main(["evaluate", "first", "--report", str(tmp_path), "--resume"])
    assert CALLS.count("first") == (2 if other else 1)


def test_resume_makes_a_page_of_other_flags_anew(tmp_path, capsys):
    """Two starts for a try, or a seed for debugging, passed for the evaluation that was asked for."""
    first = ["evaluate", "first", "--report", str(tmp_path)]
    main([*first, "--episodes", "2", "--seed", "5"])
    main([*first, "--episodes", "2", "--resume"])
    main([*first, "--resume"])
    main([*first, "--resume", "--jobs", "1", "--json", "--store", str(tmp_path / "other")])  # changes no figure
    assert CALLS == ["first"] * 3


def test_what_is_skipped_has_the_exit_code_that_it_had(tmp_path, capsys):
    words = ["evaluate", "first", "second", "--report", str(tmp_path)]
    assert main(words) == 1
    assert main([*words, "--resume"]) == 1
    assert CALLS == ["first", "second"]


def test_an_evaluation_that_cannot_run_any_more_is_not_skipped_for_its_former_page(tmp_path, capsys, monkeypatch):
    words = ["evaluate", "all", "--report", str(tmp_path), "--domain", "arm"]
    assert main(words) == 1
    monkeypatch.setattr(sys.modules["stand_in.second"], "run", lambda _: CALLS.append("second") or refuse())
    assert main(words) == main([*words, "--resume"]) == 2
    assert CALLS == ["second"] * 3


def test_a_page_that_was_broken_off_is_made_again(tmp_path, capsys):
    main(["evaluate", "first", "--report", str(tmp_path)])
    (tmp_path / "first.json").unlink()
    main(["evaluate", "first", "--report", str(tmp_path), "--resume"])
    assert CALLS == ["first", "first"]


def test_help_of_the_lot_names_all_of_it(capsys):
    assert main(["evaluate", "all", "--help"]) == 0
    printed = capsys.readouterr().out
    assert printed.startswith("usage: tailor evaluate all")
    assert "Run first, second, third." in printed


def test_the_lot_takes_flags_that_some_evaluation_knows(capsys):
    assert main(["evaluate", "all", "--episodes", "2", "--jobs=1"]) == 2  # the third's refusal
    assert CALLS == ["first", "second", "third"]


@pytest.mark.parametrize("words", [["all", "--bogus"], ["first", "second", "--episodes", "2"]])
def test_a_flag_that_is_not_known_is_told_before_anything_runs(words, capsys):
    assert main(["evaluate", *words]) == 2
    assert CALLS == []
    assert words[-2 if "--episodes" in words else -1] in capsys.readouterr().err


def test_of_the_lot_only_those_of_the_domain_run(capsys):
    assert main(["evaluate", "all", "--domain", "arm"]) == 1
    assert CALLS == ["second"]


def test_results_that_miss_the_criterion_are_told_so(capsys):
    """Exit code 1 came without a word, below a table that shows a gain."""
    assert main(["evaluate", "second"]) == 1
    assert capsys.readouterr().err == (
        "tailor evaluate second: the results miss its criterion, so the exit code is 1\n"
    )
    assert main(["evaluate", "first"]) == 0
    assert capsys.readouterr().err == ""


def test_a_lot_of_which_none_has_the_domain_does_not_pass_for_a_success(capsys):
    assert main(["evaluate", "all", "--domain", "courier"]) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert "--domain courier: none of the paper's evaluations has it, expected refinement, models, " in line
    assert CALLS == []


def test_an_evaluation_of_another_domain_is_a_usage_error(capsys):
    assert main(["evaluate", "first", "--domain", "arm"]) == 2
    assert "first has: soccer" in capsys.readouterr().err


def test_resuming_without_a_folder_of_pages_would_run_everything_again(capsys):
    assert main(["evaluate", "first", "--resume"]) == 2
    assert "expected --report DIR with it" in capsys.readouterr().err
    assert CALLS == []


def test_the_overview_links_what_there_is_and_names_what_is_missing(tmp_path, capsys):
    main(["evaluate", "first", "--report", str(tmp_path)])
    text = write_overview(tmp_path, ["first", "second"]).read_text()
    assert '<a href="first.html">The first one</a>' in text
    assert "Not run: second." in text


def test_the_overview_shows_the_first_rows_and_the_last(tmp_path):
    rows = [{"scenario": f"row-{k}"} for k in range(10)]
    publish_report(Report("first", "The first one", rows, (), {}, {}), flags(tmp_path))
    text = write_overview(tmp_path, ["first"]).read_text()
    assert [k for k in range(10) if f"row-{k}" in text] == [0, 1, 2, 3, 4, 9]
    assert text.index("row-4") < text.index("4 rows are on its page") < text.index("row-9")
    publish_report(Report("first", "The first one", rows[:6], (), {}, {}), flags(tmp_path))
    assert "rows are on its page" not in write_overview(tmp_path, ["first"]).read_text()


@pytest.mark.parametrize(
    ("row", "titles"),
    [
        ({"setting": "no spread", "n": 3}, ["setting"]),
        ({"gathered": "random", "episodes": 100}, ["gathered"]),
        ({"joule_worth_s": 3.0, "n": 3}, ["joule worth, s"]),
        ({"action": "reach", "noise_floor_s": 0.02, "over_floor": 3.1}, ["noise floor, s", "over floor"]),
        (
            {"failure_accuracy_pct": 98.5, "constant_accuracy_pct": 99.3, "missed_failures_pct": 0.5},
            ["failure accuracy, %", "constant accuracy, %", "missed failures, %"],
        ),
        (
            {
                "scenario": "one",
                "total_pct": 14.6,
                "failed": 1,
                "contacts_pct_greedy": 0.1,
                "contacts_pct_refined": 0.5,
            },
            ["total, %", "failed", "contacts greedy, %", "contacts refined, %"],
        ),
        ({"scenario": "drive", "baseline_success_pct": 99.0}, ["baseline success, %"]),
    ],
)
def test_the_overview_tells_what_a_row_is_of_and_what_a_gain_costs(row, titles, tmp_path):
    publish_report(Report("first", "The first one", [row], (), {}, {}), flags(tmp_path))
    text = write_overview(tmp_path, ["first"]).read_text()
    assert [title for title in titles if f">{title}<" not in text] == []


def test_pages_fit_a_phone_and_state_the_zone_of_their_times(tmp_path):
    publish_report(Report("first", "The first one", [{"scenario": "one"}], (), {}, {}), flags(tmp_path))
    text = write_overview(tmp_path, ["first"]).read_text()
    assert '<meta name="viewport" content="width=device-width' in text
    assert re.search(r"first, \d{4}-\d\d-\d\d \d\d:\d\d UTC", text)


def test_a_page_that_was_interrupted_does_not_pass_for_the_one_before(tmp_path, monkeypatch):
    made = Report("first", "The first one", [{"n": 3}], (), {}, {})
    publish_report(made, flags(tmp_path))
    assert stored_result(tmp_path, "first")

    def interrupted(*_, **__):
        raise KeyboardInterrupt

    for name in ("write_text", "replace"):
        with monkeypatch.context() as patched:
            patched.setattr(Path, name, interrupted)
            with pytest.raises(KeyboardInterrupt):
                publish_report(made, flags(tmp_path))
        assert not stored_result(tmp_path, "first")
    publish_report(made, flags(tmp_path))
    assert stored_result(tmp_path, "first")


@pytest.mark.parametrize("content", [b"", b"{", b"[]", b"\xff", b"[" * 100_000, b'{"title": 1, "rows": []}'])
@pytest.mark.parametrize("file", ["first.json", ".first.finished.json"])
def test_an_evaluation_whose_stored_result_is_damaged_is_run_again(file, content, tmp_path, capsys):
    """Each ended with a traceback, a page of another evaluation after all had been run."""
    resumed = ["evaluate", "first", "--report", str(tmp_path), "--resume"]
    assert main(resumed) == main(resumed) == 0
    assert CALLS == ["first"]
    (tmp_path / file).write_bytes(content)
    assert main(["evaluate", "second", "--report", str(tmp_path)]) == 1
    assert main(resumed) == 0
    assert CALLS == ["first", "second", "first"]
    assert "Traceback" not in capsys.readouterr().err


def test_json_of_a_report_has_its_rows(tmp_path, capsys):
    main(["evaluate", "first", "--json", "--report", str(tmp_path)])
    said = json.loads(capsys.readouterr().out)
    assert said["rows"] == [{"scenario": "first", "n": 3}]
    assert json.loads((tmp_path / "first.json").read_text()) == said


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (math.nan, "–"),
        ((math.nan, math.nan), "–"),
        ((1.0, math.nan), "1.00 .. –"),
        ((-math.inf, math.inf), "–"),
        ((0.5, 2.0), "0.50 .. 2.00"),
        ((), ""),
    ],
)
def test_what_is_no_number_is_a_dash_in_a_table(value, text):
    assert shown(value) == text


def test_what_is_no_number_is_null_in_json(capsys):
    publish_report(
        Report("first", "One", [{"p": float("nan"), "ci95": (float("inf"), 1.0), "n": 2, "sure": True}], (), {}, {}),
        flags(None),
    )
    said = json.loads(capsys.readouterr().out, parse_constant=pytest.fail)
    assert said["rows"] == [{"p": None, "ci95": [None, 1.0], "n": 2, "sure": True}]
