"""Feature spaces come from the packages of robots; a package at fault hinders no other."""

import pytest

from tailor.models.features import spaces
from tailor.models.features.features import FeatureSpace
from tailor.models.features.planar import POSE, projective, relative
from tailor.schemas.errors import UsageError
from tailor.schemas.packages.spec import DomainSpec

MINE = (FeatureSpace("mine", POSE, POSE, lambda rows, ops: rows),)
DOUBLE = (FeatureSpace("projective", POSE, POSE, lambda rows, ops: rows),)
AGAIN = (projective, relative)
NO_TUPLE = 7


@pytest.fixture
def declared(monkeypatch):
    """Declares a second package beside that of the planar spaces."""

    def declare(features):
        first = DomainSpec("aaa", "aaa", "m:f", features="tailor.models.features.planar:SPACES")
        specs = {"aaa": first, "courier": DomainSpec("courier", "pedelec", "m:f", features=features)}
        monkeypatch.setattr(spaces, "domain_names", lambda: tuple(specs))
        monkeypatch.setattr(spaces, "spec_of", specs.__getitem__)
        spaces._read.cache_clear()

    yield declare
    monkeypatch.undo()
    spaces._read.cache_clear()


def test_the_spaces_that_ship_are_those_of_table_7():
    shipped = {"direct", "relative", "projective", "projective-turn", "joints", "joints-relative"}
    assert shipped <= set(spaces.feature_spaces())


def test_a_package_adds_its_own(declared):
    declared(f"{__name__}:MINE")
    assert spaces.feature_space("mine") is MINE[0]
    assert spaces.feature_space("projective") is projective


def test_a_package_may_name_the_space_of_another(declared):
    declared(f"{__name__}:AGAIN")
    assert spaces.feature_space("relative") is relative


@pytest.mark.parametrize(
    ("features", "fault"),
    [
        (f"{__name__}:DOUBLE", "'projective' is the name of another feature space"),
        (f"{__name__}:NO_TUPLE", "is 7, expected a tuple of FeatureSpaces"),
        (f"{__name__}:MISSING", "has no attribute 'MISSING'"),
    ],
)
def test_a_fault_names_the_field_and_hinders_no_other(declared, features, fault):
    declared(features)
    assert spaces.feature_space("projective") is projective
    with pytest.raises(UsageError) as refused:
        spaces.feature_space("mine")
    text = str(refused.value)
    assert text.startswith("no feature space 'mine' (expected one of: direct, ")
    assert f"domain courier: features = '{features}'" in text
    assert fault in text
