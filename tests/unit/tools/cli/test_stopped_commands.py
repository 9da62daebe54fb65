"""Commands that run whole systems one after another, stopped in the midst of the first."""

import os
import signal
from argparse import Namespace
from collections.abc import Iterator

import pytest

from tailor.tools.commands.measure import evaluate
from tailor.tools.commands.run import demo, letters, up
from tailor.tools.main import main
from tests.support.injection.signals import heeded_signals


@pytest.fixture(autouse=True)
def handlers() -> Iterator[None]:
    with heeded_signals():
        yield


@pytest.mark.parametrize(
    ("words", "module"),
    [
        (("demo", "--json", "--output", "out"), demo),
        (("letters", "--json", "--output", "out"), letters),
        (("up", "soccer", "--once"), up),
    ],
    ids=["demo", "letters", "up"],
)
@pytest.mark.parametrize(
    ("number", "code"), [(signal.SIGINT, 130), (signal.SIGTERM, 143), (signal.SIGHUP, 129)], ids=str
)
def test_the_exit_code_names_the_signal_as_a_shell_does(monkeypatch, tmp_path, words, module, number, code):
    """SIGTERM ended these with 130, as Ctrl-C, or with 1, as a goal that has failed, and all others with 143."""
    runs = []

    def stopped(config, shown, stop):
        runs.append(config)
        os.kill(os.getpid(), number)
        return ""

    monkeypatch.setattr(module, "run_system", stopped)
    monkeypatch.chdir(tmp_path)
    assert main(words) == code
    assert len(runs) == 1, "the next run does not start"


@pytest.mark.parametrize("code", [129, 130, 143])
def test_an_evaluation_that_a_signal_ended_ends_all(monkeypatch, code):
    ran = []
    monkeypatch.setattr(evaluate, "_run_one", lambda name, *rest: ran.append(name) or code)
    chosen = [(name, None, Namespace(report=None)) for name in ("live", "letters")]
    assert evaluate._run_all(chosen, resume=False, everything=True) == code
    assert ran == ["live"]
