"""The profiles of a robot are found beside its body."""

import pytest

from tailor.schemas.errors import UsageError
from tailor.simnodes.agilo.body import AgiloBody
from tailor.tools.lockstep.bodies import body_of


def test_a_profile_is_found_beside_the_body():
    assert isinstance(body_of("soccer", "degraded"), AgiloBody)
    assert body_of("kitchen", "real").robot == "b21"


@pytest.mark.parametrize(("domain", "known"), [("kitchen", "paper, real"), ("arm", "none")])
def test_an_unknown_profile_is_refused_with_those_that_there_are(domain, known):
    with pytest.raises(UsageError, match=f"no profile 'x' of {domain}'s body, expected one of: {known}"):
        body_of(domain, "x")
