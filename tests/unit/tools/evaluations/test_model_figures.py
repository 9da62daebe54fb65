"""tailor evaluate models: rows of random arguments, and of the executive's own choices."""

import json

import numpy as np
import pytest

from tailor.tools.evaluations.models import floors
from tailor.tools.figures import learned_reports
from tailor.tools.main import main


def test_models_are_judged_on_random_arguments_and_on_the_executives_choices(tmp_path, capsys, monkeypatch):
    panels = []
    monkeypatch.setattr(learned_reports, "scatter", lambda path, predicted, observed: panels.extend(predicted) or path)
    words = ["evaluate", "models", "--domain", "arm", "--episodes", "6", "--on-policy", "letter-I", "--runs", "2"]
    (tmp_path / "models.png").write_bytes(b"")
    assert main([*words, "--jobs", "1", "--json", "--store", str(tmp_path), "--report", str(tmp_path)]) == 0
    random, chosen = json.loads(capsys.readouterr().out)["rows"]
    assert panels == ["reach", "reach, letter-I"]
    assert (random["chosen_in"], random["episodes"]) == ("", 6)
    assert (chosen["chosen_in"], chosen["action"]) == ("letter-I", "reach")
    assert chosen["episodes"] >= 2
    assert len(chosen["coverage_thirds_pct"]) == 3
    assert "noise_floor_s" in random


@pytest.mark.parametrize("name", ["table1", "table2"])
def test_the_papers_tables_are_of_random_arguments_alone(name, capsys):
    assert main(["evaluate", name, "--on-policy", "waypoints"]) == 2
    assert "--on-policy" in capsys.readouterr().err


def test_an_unknown_scenario_is_a_usage_error(capsys):
    assert main(["evaluate", "models", "--domain", "arm", "--on-policy", "chess"]) == 2
    assert "--on-policy chess: no such scenario of arm, expected some of letter-A" in capsys.readouterr().err


def test_tasks_without_noise_leave_a_ratio_to_the_floor():
    off_s, floor_s = np.full(4, 0.1), np.array([0.0, 0.0, 0.0, 0.1])  # a third of the draws have no noise at all
    ratio, (low, high) = floors._ratio(off_s, floor_s, np.random.default_rng(1))
    assert ratio == pytest.approx(4.0)
    assert 1.0 <= low <= high < np.inf
