"""One environment for all tests of packages: each robot has names of its own."""

import pytest

from tests.support.robots.fresh_environment import Environment, built, copied_source


@pytest.fixture(scope="session")
def environment(tmp_path_factory):
    source = copied_source(tmp_path_factory.mktemp("source"))
    wheel = built("build_wheel", source, tmp_path_factory.mktemp("wheel"))
    return Environment.made(tmp_path_factory.mktemp("environment"), wheel)
