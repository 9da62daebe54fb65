"""Checks a robot's task sampler before anything is drawn from it."""

from __future__ import annotations

from tailor.schemas.errors import UsageError
from tailor.schemas.installed import part, spec_of
from tailor.schemas.installed.package_errors import blamed_on_package
from tailor.schemas.parsed_files import shown

NEEDED = ("sample", "start", "belief", "arguments_now")  # without defaults
EXPECTED = "expected a class of TaskSampler (tools/lockstep/task_sampler.py)"


def check_sampler(domain: str) -> None:
    """Check that the sampler that a package names can be made, and has the methods that it needs.

    Raises:
      UsageError: It has none, or another object; the message names package and field.
    """
    spec = spec_of(domain)
    made, where = part(spec, "sampler"), f"domain {domain}: sampler = '{spec.sampler}'"
    if not callable(made):
        raise UsageError(f"{where}: is {shown(made)}, {EXPECTED}")
    with blamed_on_package(spec, f"{where}: cannot be made"):
        sampler = made()
    if missing := [name for name in NEEDED if not callable(getattr(sampler, name, None))]:
        raise UsageError(f"{where}: makes a {type(sampler).__name__} without {', '.join(missing)}, {EXPECTED}")
