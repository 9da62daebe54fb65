"""A domain and a driver that do not match are refused at start-up."""

from __future__ import annotations

import dataclasses
from importlib import resources

import pytest

from tailor.executive import domains
from tailor.schemas.errors import UsageError
from tailor.schemas.installed import domain_names
from tailor.simnodes.driver_spec import shipped_driver_spec
from tailor.simnodes.guard import Limit
from tailor.tools.launch.driver_check import check_driver, driver_of


@pytest.mark.parametrize("name", domain_names())
def test_every_domain_matches_the_driver_of_its_robot(name):
    domain = domains.load(name)
    check_driver(domain, shipped_driver_spec(domain.robot))


def test_all_mismatches_are_reported_at_once():
    driver = shipped_driver_spec("agilo")
    slow = dataclasses.replace(driver, command_topic="joint_cmd", limits=(Limit(-0.5, 0.5), driver.limits[1]))
    with pytest.raises(UsageError) as caught:
        check_driver(domains.load("soccer"), slow)
    assert "publishes cmd_vel, the driver expects joint_cmd" in str(caught.value)
    assert "v ranges from -0.9 to 0.9 m/s, the driver's limits are -0.5 and 0.5" in str(caught.value)


def test_a_file_that_specifies_no_driver_is_refused(tmp_path):
    file = tmp_path / "driver.toml"
    file.write_text("[robot]\n")
    with pytest.raises(UsageError, match="expected the specification of a driver"):
        driver_of("agilo", str(file))


@pytest.mark.promise("P39")
@pytest.mark.parametrize(
    ("line", "wrong", "expected"),
    [
        ("timeout_s = 0.3", "timeout_s = 0", "timeout_s is 0, expected more than 0 and at most 1"),
        ("timeout_s = 0.3", "timeout_s = 1e9", "timeout_s is 1e\\+09, expected more than 0 and at most 1"),
        ("timeout_s = 0.3", "timeout_s = nan", "timeout_s is nan, expected a finite number"),
        ("upper = 0.9", 'upper = "0.9"', "upper is '0.9', expected a finite number"),
        ("upper = 0.9", "upper = inf", "upper is inf, expected a finite number"),
        ("upper = 0.9", "upper = -2.0", "v goes from -0.9 to -2, expected the lower limit first"),
    ],
)
def test_a_specification_that_would_disable_the_guard_is_refused(tmp_path, line, wrong, expected):
    text = resources.files("tailor.simnodes").joinpath("agilo", "driver.toml").read_text()
    assert line in text
    (tmp_path / "driver.toml").write_text(text.replace(line, wrong))
    with pytest.raises(UsageError, match=expected):
        driver_of("agilo", str(tmp_path / "driver.toml"))
