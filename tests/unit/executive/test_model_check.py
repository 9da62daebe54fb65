"""An executive whose models are incomplete does not start: it would end in the tick that needs the missing one."""

from __future__ import annotations

import dataclasses
import re

import pytest

from tailor.executive.deliberation.context import Settings
from tailor.executive.interfaces.models import Models
from tailor.executive.refinement.objective.settings import RefinementSettings
from tailor.executive.robot_models import check_models
from tailor.schemas.errors import UsageError
from tests.support.toy_domain import LineModel, line_context


def test_an_action_with_all_its_models_is_accepted():
    check_models(line_context())


@pytest.mark.parametrize(
    ("models", "settings", "needed"),
    [
        (Models({}, {}), Settings(), "slide/duration"),
        (
            Models({"slide/duration": LineModel()}, {}),
            Settings(refinement=RefinementSettings(energy_weight=0.1)),
            "slide/energy",
        ),
    ],
)
def test_a_missing_model_is_named_with_its_action(models, settings, needed):
    context = dataclasses.replace(line_context(settings), models=models)
    with pytest.raises(UsageError, match=re.escape(f"action slide needs the model {needed}")):
        check_models(context)
