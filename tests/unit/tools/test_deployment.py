"""Deployment files, overridden by flags, give the configuration of the executive."""

import argparse
import os
import sys
from types import SimpleNamespace

import pytest

from tailor.executive import domains
from tailor.executive.deliberation.context import PlannerCommand
from tailor.schemas.errors import UsageError
from tailor.tools.cli.systems.deployment import executive_config, read_deployment
from tailor.tools.cli.systems.system_flags import configure_system, deployment_from


def config(tmp_path, text, *flags):
    parser = argparse.ArgumentParser()
    configure_system(parser)
    file = tmp_path / "d.toml"
    file.write_text(text)
    arguments = parser.parse_args(["soccer", "--config", str(file), *flags])
    return executive_config("soccer", deployment_from(arguments))


def test_the_planner_of_the_file_reaches_the_executive(tmp_path):
    made = config(tmp_path, f'[planner]\ncommand = "{sys.executable} -v1"\nlimit_s = 3\n')
    assert made.settings.external == PlannerCommand(f"{sys.executable} -v1", 3.0)


def test_a_flag_wins_over_the_file_and_leaves_the_rest(tmp_path):
    text = '[planner]\ncommand = "no-such-vhpop"\nlimit_s = 3\n'
    assert config(tmp_path, text, "--planner", sys.executable).settings.external == PlannerCommand(sys.executable, 3.0)
    assert config(tmp_path, text, "--planner", "").settings.external.command == "", "an empty one switches it off"


def test_plans_may_be_chosen_by_the_models_whatever_the_planner(tmp_path):
    assert config(tmp_path, "").settings.plan_costs == "steps"
    assert config(tmp_path, '[planner]\ncosts = "models"\n').settings.plan_costs == "models"
    with pytest.raises(UsageError, match="costs"):
        config(tmp_path, '[planner]\ncosts = "metres"\n')


def test_the_default_is_no_external_planner(tmp_path):
    assert config(tmp_path, "").settings.external == PlannerCommand()


def test_kairos_by_name_is_an_external_planner(tmp_path, monkeypatch):
    monkeypatch.setattr("tailor.runtime.planners.named.find_spec", lambda name: object())
    external = config(tmp_path, '[planner]\nengine = "kairos"\n').settings.external
    assert (external.command, external.after_plans) == ("kairos", 0)
    with pytest.raises(UsageError, match="expected no other planner"):
        config(tmp_path, '[planner]\nengine = "kairos"\ncommand = "vhpop"\n')


@pytest.mark.parametrize("table", ["planner", "executive.planner"])
def test_the_engine_of_the_search_stands_beside_its_other_settings_or_those_of_planners(tmp_path, monkeypatch, table):
    monkeypatch.setattr("tailor.runtime.planners.named.find_spec", lambda name: object())
    monkeypatch.setattr(domains, "load", lambda name: SimpleNamespace(pddl="(:durative-action"))
    settings = config(tmp_path, f'[{table}]\nengine = "pocl"\n').settings
    assert (settings.planner.engine, settings.external.command) == ("pocl", "")


def test_of_two_engines_that_of_planners_counts(tmp_path):
    text = '[planner]\nengine = "forward"\n[executive.planner]\nengine = "pocl"\n'
    assert config(tmp_path, text).settings.planner.engine == "forward"


def test_an_external_planner_in_the_table_of_the_executive_is_refused(tmp_path):
    with pytest.raises(UsageError, match=r"d.toml: table executive.external, expected its keys in the table planner"):
        config(tmp_path, '[executive.external]\ncommand = "no-such-vhpop"\n')


def test_kairos_that_is_not_installed_is_an_error_with_the_pip_command(tmp_path, monkeypatch):
    monkeypatch.setattr("tailor.runtime.planners.named.find_spec", lambda name: None)
    with pytest.raises(UsageError, match=r"pip install 'tailor\[kairos\]'"):
        config(tmp_path, '[planner]\nengine = "kairos"\n')


@pytest.mark.parametrize(
    ("installed", "durative", "engine", "command"),
    [
        (True, True, "auto", "kairos"),
        (False, True, "auto", ""),
        (True, False, "auto", ""),
        (True, True, "pocl", ""),
    ],
)
def test_auto_asks_kairos_only_for_durations_and_only_if_installed(
    tmp_path, monkeypatch, installed, durative, engine, command
):
    monkeypatch.setattr("tailor.runtime.planners.named.find_spec", lambda name: object() if installed else None)
    if durative:
        monkeypatch.setattr(domains, "load", lambda name: SimpleNamespace(pddl="(:durative-action"))
    external = config(tmp_path, f'[planner]\nengine = "{engine}"\n').settings.external
    assert external.command == command
    assert (external.after_plans > 0) is bool(command), "short problems keep the search's plans"


def test_a_missing_planner_is_an_error(tmp_path):
    with pytest.raises(UsageError, match="there is no program 'no-such-vhpop'"):
        config(tmp_path, "", "--planner", "no-such-vhpop -g")


@pytest.mark.parametrize("limit", ["0", "-1", "inf", "nan"])
def test_a_time_limit_must_be_positive_and_finite(tmp_path, limit):
    with pytest.raises(UsageError, match="expected seconds above 0"):
        config(tmp_path, f"[planner]\nlimit_s = {limit}\n")


def test_a_pipe_is_no_deployment_file():
    """It was read once for the name of the bus and once, empty, for its session: with the default bus."""
    reader, writer = os.pipe()
    os.write(writer, b'[bus]\nendpoint = "tcp/127.0.0.1:7999"\n')
    os.close(writer)
    with pytest.raises(UsageError, match=f"/dev/fd/{reader}: a pipe, expected a deployment file"):
        read_deployment(f"/dev/fd/{reader}")
    os.close(reader)
