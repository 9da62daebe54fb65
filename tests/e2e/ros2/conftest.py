"""A bus of its own for each test, to which nothing but the test connects."""

import pytest

from tailor.runtime.bus.opening import open_router
from tailor.schemas import codec
from tests.support.bus_system import free_endpoint


@pytest.fixture
def endpoint():
    codec.prime()
    endpoint = free_endpoint()
    with open_router(endpoint):
        yield endpoint
