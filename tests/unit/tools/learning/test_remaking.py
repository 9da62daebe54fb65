"""What to do about stale models: commands that work for the robot, the folder and the installation at hand."""

from dataclasses import replace
from pathlib import Path

import pytest

from tailor.models.runtime import ZOO
from tailor.schemas.errors import UsageError
from tailor.schemas.installed import spec_of_robot
from tailor.tools.learning import remaking, zoo_checks
from tailor.tools.learning.remaking import remaking_advice
from tailor.tools.main import main


def test_a_robot_with_a_recipe_is_made_anew_by_it() -> None:
    assert remaking_advice("powercube", None) == "`tailor make-models powercube`"


def test_models_of_another_folder_are_made_anew_there() -> None:
    assert remaking_advice("powercube", Path("out/zoo")) == "`tailor make-models powercube --zoo out/zoo`"


@pytest.mark.parametrize("zoo", [None, Path("out/zoo")])
def test_a_robot_without_a_recipe_is_gathered_and_trained(zoo, monkeypatch) -> None:
    monkeypatch.setattr(remaking, "recipe_path", lambda robot: Path("nowhere/recipe.toml"))
    into = "" if zoo is None else " --zoo out/zoo"
    assert remaking_advice("powercube", zoo) == (
        f"`tailor gather powercube` and `tailor train powercube{into}`, "
        f"or by a recipe: `tailor make-models powercube --recipe FILE{into}`"
    )


def test_a_robot_without_a_simulated_body_is_recorded(monkeypatch) -> None:
    monkeypatch.setattr(remaking, "spec_of_robot", lambda robot: replace(spec_of_robot(robot), body=""))
    assert remaking_advice("powercube", None) == (
        "`tailor gather powercube --from RECORDING` and `tailor train powercube`"
    )


def test_an_installed_package_is_not_written_into(monkeypatch) -> None:
    def refused(*_: object) -> Path:
        raise UsageError("models are not written into the installed package")

    monkeypatch.setattr(remaking, "target_zoo", refused)
    assert remaking_advice("powercube", None) == "`tailor make-models powercube --zoo DIR`"


def test_the_command_advises_once_for_each_robot(monkeypatch, capsys) -> None:
    monkeypatch.setattr(zoo_checks, "staleness", lambda card: f"{card['action']} is")
    assert main(["models", "check", "powercube/reach", "powercube/reach/energy", "--zoo", str(ZOO)]) == 1
    *_, advice = lines = capsys.readouterr().out.splitlines()
    assert advice == f"stale models of powercube are made anew by `tailor make-models powercube --zoo {ZOO}`"
    assert len(lines) == 3
