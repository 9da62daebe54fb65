"""Settings from tables: all mistakes at once, each with its key."""

from __future__ import annotations

import json
from dataclasses import asdict

import pytest

from tailor.executive.composition import ExecutiveConfig
from tailor.schemas.errors import UsageError
from tailor.schemas.settings import from_table
from tailor.tools.cli.systems.deployment import Deployment


def test_nested_tables_become_nested_settings():
    read = from_table(Deployment, {"executive": {"seed": 3, "refinement": {"horizon": 4, "k_std": 2}}}, "f.toml")
    assert (read.executive.seed, read.executive.refinement.horizon, read.executive.refinement.k_std) == (3, 4, 2.0)


@pytest.mark.parametrize(
    ("table", "expected"),
    [
        (
            {"bus": {"endpont": "x"}},
            "f.toml: unknown key 'bus.endpont' (expected one of: endpoint, security, remote, keys, key, profile, "
            "ros_domain)",
        ),
        ({"executive": {"seed": "x"}}, "f.toml: 'executive.seed' is 'x', expected int"),
        ({"executive": {"seed": True}}, "f.toml: 'executive.seed' is True, expected int"),
        ({"executive": {"refinement": {"horizon": 0}}}, "f.toml: refinement.horizon is 0, expected at least 1"),
        ({"executive": {"refinement": {"batch": 1}}}, "f.toml: refinement.batch is 1, expected at least 8"),
        (
            {"executive": {"refinement": {"assertion_depth": 0}}},
            "f.toml: refinement.assertion_depth is 0, expected at least 1",
        ),
        ({"executive": {"seed": -1}}, "f.toml: executive.seed is -1, expected at least 0"),
        ({"executive": {"adopt_gain_s": float("nan")}}, "f.toml: executive.adopt_gain_s is nan, expected at least 0"),
        ({"executive": {"overruns_to_hold": 0}}, "f.toml: executive.overruns_to_hold is 0, expected at least 1"),
        ({"executive": {"coast_ticks": 6}}, "f.toml: executive.coast_ticks is 6, expected at most 5"),
        (
            {"executive": {"refinement": {"batch": 10**9}}},
            "f.toml: refinement.batch is 1000000000, expected at most 1000000",
        ),
        (
            {"executive": {"refinement": {"arrival_spread": [["x"]]}}},
            "f.toml: 'executive.refinement.arrival_spread' is ['x'], expected 2 values",
        ),
        (
            {"executive": {"refinement": {"arrival_spread": [["x", -0.1]]}}},
            "f.toml: refinement.arrival_spread of x is -0.1, expected a number from 0 to 1e+06",
        ),
        (
            {"executive": {"refinement": {"arrival_spread": [["phi", 1e300]]}}},
            "f.toml: refinement.arrival_spread of phi is 1e+300, expected a number from 0 to 1e+06",
        ),
        (
            {"executive": {"refinement": {"k_std": 1e39}}},
            "f.toml: refinement.k_std is 1e+39, expected a number from 0 to 1e+06",
        ),
        (
            {"executive": {"refinement": {"assertion_depth": 1000}}},
            "f.toml: refinement.assertion_depth is 1000, expected at most 8",
        ),
        ({"executive": {"refinement": {"horizon": 1000}}}, "f.toml: refinement.horizon is 1000, expected at most 50"),
        (
            {"executive": {"refinement": {"greedy_checks": 10**9}}},
            "f.toml: refinement.greedy_checks is 1000000000, expected at most 100",
        ),
        ({"bus": 5}, "f.toml: 'bus' is 5, expected a table"),
        (
            {"executive": {"refinement": {"arrival_spread": 5}}},
            "f.toml: 'executive.refinement.arrival_spread' is 5, expected a list",
        ),
        (
            {"executive": {"adopt_gain_s": 10**400}},
            f"f.toml: 'executive.adopt_gain_s' is 1{'0' * 56}..., expected a number of at most 64 bits",
        ),
        (
            {"executive": {"seed": 10**5000}},
            "f.toml: 'executive.seed' is a value of type int that is too long to print, "
            "expected a number of at most 64 bits",
        ),
    ],
)
def test_a_mistake_is_reported_with_its_key_and_the_expected_value(table, expected):
    with pytest.raises(UsageError) as caught:
        from_table(Deployment, table, "f.toml")
    assert str(caught.value) == expected


def test_a_missing_value_is_reported_with_its_key():
    with pytest.raises(UsageError, match=r"f\.toml: 'scenario' is missing, expected str"):
        from_table(ExecutiveConfig, {"domain": "soccer"}, "f.toml")


@pytest.mark.promise("P39")
def test_all_mistakes_are_reported_at_once():
    with pytest.raises(UsageError) as caught:
        from_table(Deployment, {"colour": 1, "executive": {"seeds": 1, "coast_ticks": 1.5}}, "f.toml")
    assert all(key in str(caught.value) for key in ("'colour'", "'executive.seeds'", "'executive.coast_ticks'"))


def test_a_configuration_survives_its_way_through_json():
    config = ExecutiveConfig("soccer", "approach-dribble")
    assert from_table(ExecutiveConfig, json.loads(json.dumps(asdict(config))), "x") == config
