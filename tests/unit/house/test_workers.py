"""The order of tests on several workers, what those compile, and what the tests of one worker share."""

import gc

import pytest

from tailor.models.runtime import load_model
from tailor.runtime.gc_freeze import gc_frozen
from tests import conftest
from tests.support.workers import early_imports
from tests.support.workers.spreading import spread


def test_tests_that_wait_lie_evenly_among_the_others_and_both_keep_their_order():
    tests = ["w1", "w2", "a", "b", "c", "d", "e", "f"]
    spread(tests, lambda test: test.startswith("w"))
    assert tests == ["w1", "a", "b", "c", "w2", "d", "e", "f"]


def test_tests_of_one_kind_stay_in_their_order():
    for waits in (True, False):
        tests = ["c", "a", "b"]
        spread(tests, lambda _, waits=waits: waits)
        assert tests == ["c", "a", "b"]


def test_what_a_test_has_unfrozen_is_frozen_again_after_it():
    teardown = conftest.pytest_runtest_teardown(item=None)
    next(teardown)
    with gc_frozen():
        pass
    assert gc.get_freeze_count() == 0
    assert list(teardown) == []
    assert gc.get_freeze_count() > 0


def test_a_model_that_is_loaded_again_has_the_same_session():
    one, other = (load_model("agilo/goToPose/duration") for _ in range(2))
    assert one is not other
    assert one.session is other.session


@pytest.fixture
def imported(monkeypatch):
    """Names that were imported; one module is faulty, another skips itself."""
    names = []

    def import_module(name):
        names.append(name)
        if name.endswith("test_b"):
            raise ImportError(name)
        if name.endswith("test_c"):
            pytest.skip("not here", allow_module_level=True)

    monkeypatch.setattr(early_imports, "import_module", import_module)
    return names


def test_a_worker_begins_with_its_share_and_goes_on_with_the_others(imported, tmp_path):
    for name in ("tests/one/test_a.py", "tests/one/test_b.py", "tests/test_c.py", "tests/test_d.py", "tests/helper.py"):
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).touch()
    early_imports.import_early(tmp_path, [tmp_path / "tests"], 1, 2)
    assert imported == ["tests.test_c", "tests.test_d", "tests.one.test_a", "tests.one.test_b"]


def test_only_what_was_chosen_is_imported(imported, tmp_path):
    for name in ("test_a.py", "test_d.py"):
        (tmp_path / name).touch()
    early_imports.import_early(tmp_path, [tmp_path / "test_d.py"], 0, 4)
    assert imported == ["test_d"]
