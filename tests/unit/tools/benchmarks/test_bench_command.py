"""`tailor bench` fails if a benchmark has measured nothing, and still runs the others."""

from __future__ import annotations

import json
import shutil
import sys
import types

import pytest
from rich.console import Console
from rich.table import Table

from tailor.executive.interfaces.models import Models
from tailor.models.runtime import load_robot
from tailor.runtime.recordings.recording import open_recording
from tailor.tools.benchmarks import command_answer, planning, recording, ticks
from tailor.tools.benchmarks.no_measurement import NoMeasurement
from tailor.tools.benchmarks.refinement import certificates, refine
from tailor.tools.benchmarks.refinement.cases import cases
from tailor.tools.commands.measure import bench
from tailor.tools.main import main

GOLDEN = "tests/data/golden/soccer-approach.mcap"


@pytest.fixture
def stand_ins(monkeypatch):
    """Benchmarks "empty", which measures nothing, and "full"."""

    def nothing(console, quick):
        raise NoMeasurement("no problems here")

    runs = {"empty": nothing, "full": lambda console, quick: console.print("a table")}
    monkeypatch.setattr(bench, "BENCHMARKS", dict.fromkeys(runs, "for this test"))
    for name, run in runs.items():
        module = types.ModuleType(name)
        module.run = run
        monkeypatch.setitem(sys.modules, f"tailor.tools.benchmarks.{name}", module)


@pytest.mark.promise("P55")
def test_benchmark_that_measured_nothing_fails_after_the_others_have_run(stand_ins, capsys):
    assert main(["bench"]) == 1
    printed = capsys.readouterr()
    assert printed.err == "tailor bench empty: nothing measured: no problems here\n"
    assert "a table" in printed.out


def test_benchmarks_that_measured_something_succeed(stand_ins, capsys):
    assert main(["bench", "full"]) == 0
    assert capsys.readouterr().err == ""


def test_unknown_benchmark_is_a_usage_error(capsys):
    assert main(["bench", "speed"]) == 2
    assert "no benchmark speed, expected some of: ticks" in capsys.readouterr().err


@pytest.mark.parametrize(
    "words",
    [
        *(("ticks", flag, "7") for flag in ("--minutes", "--seed", "--only")),
        *(("ticks", flag) for flag in ("--scale", "--json")),
        ("ticks", "--every", "15"),
        ("cluster", "models", "--output", "nowhere.json"),
        ("soak", "--quick"),
    ],
    ids=" ".join,
)
def test_options_that_no_benchmark_of_the_call_uses_are_refused(words, capsys):
    assert main(["bench", *words]) == 2
    (line,) = capsys.readouterr().err.splitlines()
    (option,) = (word for word in words if word.startswith("--"))
    assert f"{option}: not used by " in line


def test_options_that_one_benchmark_of_the_call_uses_are_accepted(stand_ins, monkeypatch, capsys):
    monkeypatch.setitem(bench.USED_BY, "minutes", ("full",))
    monkeypatch.setitem(bench.USED_BY, "quick", ("full",))
    assert main(["bench", "full", "--quick", "--minutes", "7"]) == 0
    assert main(["bench", "--quick"]) == 1, "the other one measures nothing"


@pytest.mark.parametrize(
    ("words", "expected"),
    [
        (("soak", "ticks", "--json"), "--json: of soak alone, found soak, ticks"),
        (("soak", "growth", "--output", "x.json"), "--output x.json: of one benchmark, found soak, growth"),
        (("growth", "--output", "x.png"), "--output x.png: expected a name that ends in .json"),
        (("soak", "--output", "run.mcap"), "--output run.mcap: expected a name that ends in .json"),
        (("soak", "--output", "run.mcap/x.json"), "--output run.mcap/x.json: "),
    ],
)
def test_results_that_could_not_be_written_are_refused_before_the_work(words, expected, monkeypatch, tmp_path, capsys):
    """A soak of hours ended without its results, a recording was overwritten, and tables stood in the JSON."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "run.mcap").write_bytes(b"of the user")
    monkeypatch.setattr(bench, "_run_one", lambda *_: pytest.fail("it ran"))
    assert main(["bench", *words]) == 2
    assert f"tailor bench: {expected}" in capsys.readouterr().err
    assert (tmp_path / "run.mcap").read_bytes() == b"of the user"
    assert [path.name for path in tmp_path.iterdir()] == ["run.mcap"]


def test_planning_without_problems_has_measured_nothing(monkeypatch, tmp_path):
    monkeypatch.setattr(planning, "DATA", tmp_path)
    with pytest.raises(NoMeasurement, match="no problems in"):
        planning.run(Console(), True)


@pytest.mark.promise("P55")
def test_ticks_of_a_recording_without_ticks_have_measured_nothing(monkeypatch):
    class Empty:
        def decoded(self):
            return iter(())

    monkeypatch.setattr(ticks, "open_recording", lambda path: Empty())
    with pytest.raises(NoMeasurement, match="0 tick reports and 0 commands"):
        ticks._row("nowhere.mcap")


def test_ticks_of_a_run_without_commands_have_measured_nothing(monkeypatch):
    messages = [pair for pair in open_recording(GOLDEN).decoded() if type(pair[1]).__name__ != "VelocityCommand"]

    class Silent:
        def decoded(self):
            return iter(messages)

    monkeypatch.setattr(ticks, "open_recording", lambda path: Silent())
    with pytest.raises(NoMeasurement, match="0 commands"):
        ticks._row("nowhere.mcap")


def test_a_tick_whose_percepts_were_not_recorded_has_no_delay(monkeypatch):
    """It had one since the first moment of the clock, 50 years in a live run."""
    messages = list(open_recording(GOLDEN).decoded())
    tick = next(m for _, m in messages if type(m).__name__ == "TickReport" and m.tick == 20)
    lost = set(zip(tick.input_keys, tick.input_sequences, strict=True))

    class Lossy:
        def decoded(self):
            return iter([pair for pair in messages if (pair[0].key, pair[0].sequence) not in lost])

    monkeypatch.setattr(ticks, "open_recording", lambda path: Lossy())
    largest_ms = float(ticks._row("somewhere.mcap")[-1].split(" / ")[-1])
    assert largest_ms < 1000


@pytest.mark.promise("P55")
def test_a_system_that_hardly_ran_has_measured_nothing():
    whole = len([m for _, m in open_recording(GOLDEN).decoded() if type(m).__name__ == "TickReport"])
    assert ticks._row(GOLDEN, whole)[0] == str(whole)
    with pytest.raises(NoMeasurement, match=f"{whole} tick reports .* expected at least {whole + 1} ticks"):
        ticks._row(GOLDEN, whole + 1)


class Ended:
    """A process that has ended; what it printed."""

    def __init__(self, stdout, stderr="", returncode=0):
        self.stdout, self.stderr, self.returncode = stdout, stderr, returncode


@pytest.mark.promise("P55")
def test_a_replay_of_nothing_has_measured_nothing(monkeypatch):
    late = {"p50_ms": 0.0, "p99_ms": 0.0, "max_ms": 0.0}
    printed = json.dumps({"messages": 0, "bytes": 0, "lateness": late})
    monkeypatch.setattr(command_answer.subprocess, "run", lambda *_, **__: Ended(printed))
    with pytest.raises(NoMeasurement, match="the replay at rate 4 has published no message"):
        recording._replay(None, None, "tcp/127.0.0.1:1", "nowhere.mcap", 4)


@pytest.fixture
def recorded(monkeypatch, tmp_path):
    """The recording of a soccer run that the benchmark would make."""

    class Recorded:
        def __init__(self, *arguments):
            shutil.copy(GOLDEN, tmp_path / "run.mcap")

        def wait(self, timeout_s):
            return 0

        def stop(self):
            return 0

    monkeypatch.setattr(recording, "Child", Recorded)
    return tmp_path / "run.mcap"


@pytest.mark.promise("P55")
def test_a_verification_of_no_tick_has_measured_nothing(monkeypatch, recorded):
    monkeypatch.setattr(command_answer.subprocess, "run", lambda *_, **__: Ended('[{"ticks": 0, "took_s": 0.1}]'))
    with pytest.raises(NoMeasurement, match="verify has compared no tick"):
        recording._soccer(Table(), recorded)


def test_a_verification_that_is_refused_has_measured_nothing_and_names_the_reason(monkeypatch, recorded):
    refused = Ended("", "tailor verify: run.mcap: no provenance\n", 2)
    monkeypatch.setattr(command_answer.subprocess, "run", lambda *_, **__: refused)
    with pytest.raises(NoMeasurement, match="verify has ended with code 2: tailor verify: run"):
        recording._soccer(Table(), recorded)


def test_a_command_that_does_not_end_has_measured_nothing(monkeypatch):
    monkeypatch.setattr(command_answer, "LIMIT_S", 0.1)
    with pytest.raises(NoMeasurement, match="sleep has not ended after 0 s"):
        command_answer.answer("sleep", [sys.executable, "-c", "import time; time.sleep(60)"])


def test_run_that_was_not_recorded_is_no_measurement(monkeypatch, tmp_path):
    class Nothing:
        def __init__(self, *arguments):
            pass

        def wait(self, timeout_s):
            return 2

        def stop(self):
            return 2

    monkeypatch.setattr(recording, "Child", Nothing)
    with pytest.raises(NoMeasurement, match="no soccer run was recorded"):
        recording._soccer(None, tmp_path / "missing.mcap")


def test_proofs_with_the_models_that_ship_are_measured():
    models = Models(*load_robot("agilo"))
    (row,) = certificates.rows(models, {"2 free": cases(models, 1)["2 free"]})
    assert (row["case"], row["n"], row["share_within_1_pct"]) == ("2 free", 1, 1.0)


def test_solvers_without_a_valid_choice_have_measured_nothing(monkeypatch):
    def never(objective, starts, seed, limit_ms):
        return [(0.0, float("inf"))]

    monkeypatch.setattr(refine, "runners", lambda: [("chain", never)])
    monkeypatch.setattr(refine, "ours", lambda name: never)
    task = types.SimpleNamespace(name="waypoints", starts=(), objective=lambda models: None)
    with pytest.raises(NoMeasurement, match="no solver has found a valid choice for waypoints"):
        refine._race(task, None, 0)
