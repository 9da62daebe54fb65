"""Every domain that is installed keeps the contract: the suite of the pytest plug-in judges them all."""

import numpy as np
import pytest

from tailor.executive import domains
from tailor.schemas.errors import UsageError
from tailor.tools.contract.suite import pytest_generate_tests as parametrize_suite
from tailor.tools.contract.suite import test_contract

__all__ = ["test_contract"]


def pytest_generate_tests(metafunc):
    if metafunc.function is test_contract:
        parametrize_suite(metafunc)


def test_unknown_names_are_refused_with_those_that_there_are():
    with pytest.raises(UsageError, match="soccer"):
        domains.load("chess")
    with pytest.raises(UsageError, match="approach-dribble"):
        domains.load_scenario("soccer", "penalty", np.random.default_rng(0))
    with pytest.raises(UsageError):
        domains.scenarios("chess")
