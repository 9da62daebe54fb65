"""Ranges in manifests: those of the samples, rounded outwards so that they cover what the action declares."""

from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import pytest

from tailor.executive import domains
from tailor.tools.learning.gathering import data_set_spec
from tailor.tools.learning.gathering.data_set_spec import DataSetSpec
from tailor.tools.learning.gathering.manifests import argument_ranges

REACH = DataSetSpec("arm", "reach", 0, 0, Path())


@dataclass(frozen=True)
class OneArgument:
    """A domain with one action and one argument."""

    actions: dict


def ranged(lower: float, upper: float, monkeypatch, share: float = 1.0) -> tuple[float, float]:
    """The range of an argument that declares one and of whose range a share is drawn."""
    reach = domains.load("arm").actions["reach"]
    parameter = replace(reach.parameters[0], unit="mm", lower=lower, upper=upper)
    domain = OneArgument({"reach": replace(reach, parameters=(parameter,))})
    middle, half = (lower + upper) / 2, (upper - lower) / 2 * share
    monkeypatch.setattr(data_set_spec.action_run, "sample_arguments",
                        lambda _domain, _action, rng: rng.uniform(middle - half, middle + half, 1))  # fmt: skip
    (entry,) = argument_ranges(domain, REACH)
    return entry["lower"], entry["upper"]


@pytest.mark.parametrize(
    ("lower", "upper"),
    [(0.0, 500.0), (-180.0, 180.0), (-1500.0, 2500.0), (-np.pi, np.pi), (0.0, 500.01), (0.0, 30.0), (0.002, 0.02)],
)
def test_a_range_covers_what_the_action_declares_and_little_more_in_any_unit(lower, upper, monkeypatch) -> None:
    low, high = ranged(lower, upper, monkeypatch)
    assert low <= lower
    assert high >= upper
    assert high - low <= 1.35 * (upper - lower)


def test_a_range_of_which_only_a_part_is_drawn_is_not_stretched(monkeypatch) -> None:
    low, high = ranged(0.0, 500.0, monkeypatch, share=0.5)
    assert (low, high) == (125.0, 375.0)


def test_an_argument_that_is_always_the_same_has_a_range_without_width(monkeypatch) -> None:
    assert ranged(0.0, 0.0, monkeypatch) == (0.0, 0.0)


@pytest.mark.parametrize(
    ("domain", "action", "beside", "expected"),
    [
        ("soccer", "goToPose", False, {"phi": (-3.15, 3.15)}),
        ("soccer", "goToPose", True, {"obstacle_r": (0.1, 0.3)}),
        ("arm", "reach", False, {"a": (-1.3, 1.3)}),
        ("kitchen", "goToPose", True, {"box_r": (0.0, 0.3), "box_x": (-5.0, 4.65)}),
        ("kitchen", "goToPose", False, {"v": (0.0, 0.6)}),
    ],
)
def test_the_ranges_of_the_models_that_ship_stay(domain, action, beside, expected) -> None:
    spec = DataSetSpec(domain, action, 0, 0, Path(), beside=beside)
    found = {each["name"]: (each["lower"], each["upper"]) for each in argument_ranges(domains.load(domain), spec)}
    assert {name: found[name] for name in expected} == expected
