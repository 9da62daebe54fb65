"""The bodies that evaluations run on: as gathered from, or degraded, which stands in for the real robot."""

from __future__ import annotations

from functools import lru_cache

from tailor.executive import domains
from tailor.schemas.errors import UsageError
from tailor.simnodes.agilo import profiles
from tailor.simnodes.body import Body
from tailor.tools.lockstep.action_run import new_body


@lru_cache(maxsize=4)
def body_of(domain: str, profile: str) -> Body:
    """A body for a domain's robot, made once a process; resetting it makes an episode independent of the last.

    Args:
      domain: By name.
      profile: Of AGILO's, e.g. "degraded"; empty: as gathered from.

    Raises:
      UsageError: The robot has no such profile.
    """
    if not profile:
        return new_body(domains.load(domain))
    known = tuple(profiles.PROFILES) if domain == "soccer" else ()
    if profile not in known:
        raise UsageError(f"no profile '{profile}' of {domain}'s body, expected one of: {', '.join(known) or 'none'}")
    return profiles.body(profile)
