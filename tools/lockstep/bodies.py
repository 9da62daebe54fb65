"""Simulated bodies by profile: the one that ships, or another one, for example in place of the real robot."""

from __future__ import annotations

from functools import lru_cache
from importlib import import_module
from importlib.util import find_spec
from typing import Any

from tailor.executive import domains
from tailor.executive.interfaces.domain import Domain
from tailor.schemas.errors import UsageError
from tailor.schemas.installed import part, spec_of
from tailor.schemas.installed.package_errors import blamed_on_package
from tailor.simnodes.body import Body
from tailor.tools.lockstep.action_run import new_body


@lru_cache(maxsize=4)
def body_of(domain: str, profile: str) -> Body:
    """A body of a domain's robot, made once a process. A reset makes a run independent of the last one.

    Args:
      domain: Name of the domain.
      profile: Name of the body's profile, e.g. "degraded"; empty: the one that ships.

    Raises:
      UsageError: The robot has no such profile.
    """
    check_profile(domain, profile)
    if not profile:
        return made_body(domains.load(domain))
    body: Body = _profiles(domain).body(profile)
    return body


def made_body(domain: Domain) -> Body:
    """As `new_body`, which is part of what models learn from and stays as it is.

    Raises:
      UsageError: The robot's package has no body, or one that cannot be made.
    """
    spec = spec_of(domain.name)
    part(spec, "body")  # its own error is not one of the constructor
    with blamed_on_package(spec, f"{spec.body}: cannot be simulated"):
        return new_body(domain)


def check_profile(domain: str, profile: str) -> None:
    """Check the name of a profile without making a body: recordings need none, and workers make their own.

    Raises:
      UsageError: The robot has no such profile.
    """
    if not profile:
        return
    profiles = _profiles(domain)
    known = tuple(profiles.PROFILES) if profiles else ()
    if profile not in known:
        raise UsageError(f"no profile '{profile}' of {domain}'s body, expected one of: {', '.join(known) or 'none'}")


def _profiles(domain: str) -> Any:
    """The module `profiles` beside that of the body: PROFILES by name, and a function `body`; None: there is none."""
    beside = spec_of(domain).body.partition(":")[0].rpartition(".")[0]
    name = f"{beside}.profiles"
    return import_module(name) if beside and find_spec(name) else None
