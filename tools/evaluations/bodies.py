"""Bodies of evaluations: the one that training used, or a degraded one in place of the real robot."""

from __future__ import annotations

from functools import lru_cache

from tailor.executive import domains
from tailor.schemas.errors import UsageError
from tailor.simnodes.agilo import profiles
from tailor.simnodes.body import Body
from tailor.tools.lockstep.action_run import new_body


@lru_cache(maxsize=4)
def body_of(domain: str, profile: str) -> Body:
    """A body of a domain's robot, made once a process. A reset makes a run independent of the last one.

    Args:
      domain: Name of the domain.
      profile: Name of the body's profile, e.g. "degraded"; empty: the one that training used.

    Raises:
      UsageError: The robot has no such profile.
    """
    if not profile:
        return new_body(domains.load(domain))
    known = tuple(profiles.PROFILES) if domain == "soccer" else ()
    if profile not in known:
        raise UsageError(f"no profile '{profile}' of {domain}'s body, expected one of: {', '.join(known) or 'none'}")
    return profiles.body(profile)
