"""Evaluations that train models of their own, of a robot whose package has no recipe: one line, and nothing runs."""

import pytest

from tailor.schemas.installed import models_folder
from tailor.tools.evaluations.refinement import ablations, refinement
from tailor.tools.learning import recipe_file
from tailor.tools.main import main


@pytest.mark.parametrize(
    ("name", "flags"),
    [
        ("refinement", ["--models", "1"]),
        ("ablations", ["--model-episodes", "40"]),
        ("learning-curves", ["--quick"]),
    ],
)
def test_a_robot_without_a_recipe_is_named_with_the_file_that_is_expected(name, flags, monkeypatch, tmp_path, capsys):
    monkeypatch.setattr(recipe_file, "RECIPE", "none.toml")
    monkeypatch.setattr(ablations, "run_all", lambda *_: pytest.fail("it runs"))
    monkeypatch.setattr(refinement, "rows_of", lambda *_: pytest.fail("it runs"))
    assert main(["evaluate", name, "--domain", "soccer", "--store", str(tmp_path / "store"), *flags]) == 2
    assert capsys.readouterr().err == (
        "tailor evaluate: robot agilo has no recipe by which its models could be made anew, expected a file "
        f"{models_folder('agilo')}/agilo/none.toml with at least `episodes = NUMBER` (docs/learning.md)\n"
    )
    assert not (tmp_path / "store").exists()
