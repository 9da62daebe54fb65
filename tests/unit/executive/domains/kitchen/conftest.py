"""The kitchen's domain, and a body of its robot that all tests of a file share."""

import pytest

from tailor.executive import domains
from tailor.tools.lockstep import action_run


@pytest.fixture(scope="module")
def kitchen():
    return domains.load("kitchen")


@pytest.fixture(scope="module")
def body(kitchen):
    pytest.importorskip("pybullet")
    return action_run.new_body(kitchen)
