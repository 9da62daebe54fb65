"""Recipes that their robot cannot follow are refused before anything is gathered."""

import pytest

from tailor.schemas.errors import UsageError
from tailor.tools.learning.gathering import beside_objects
from tailor.tools.learning.recipe import Recipe
from tailor.tools.learning.recipe_checks import check_recipe


@pytest.mark.parametrize(("objects", "lacks"), [(0, "`context` and `context_start`"), (3, "`sample_among_objects` or")])
def test_a_sampler_that_draws_no_objects_is_found_out_before_hours_of_other_episodes(monkeypatch, objects, lacks):
    monkeypatch.setattr(beside_objects, "sampler_of", lambda domain: object())
    with pytest.raises(UsageError, match=f"the sampler object of soccer lacks {lacks}"):
        check_recipe("agilo", Recipe(9, beside=1, objects=objects))
    check_recipe("agilo", Recipe(9))
