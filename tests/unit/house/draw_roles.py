"""Draws the table of roles into docs/security.md, from the tables of topics and services."""

from pathlib import Path

from tailor.runtime.bus.rights.access import may_publish
from tailor.schemas.services import ROLES, SERVICES, Role
from tailor.schemas.topics import TOPICS

PAGE = Path(__file__).resolve().parents[3] / "docs" / "security.md"
HEAD = "| role | publishes | calls | serves |\n|---|---|---|---|\n"


def table() -> str:
    """The rows of the table."""
    return "".join(_row(role) for role in ROLES)


def drawn(page: str) -> str:
    """The page with today's table."""
    before, rest = page.split(HEAD)
    return before + HEAD + table() + "\n" + rest.split("\n\n", 1)[1]


def _row(role: Role) -> str:
    published = [topic.key.format(robot="*") for topic in TOPICS.values() if role in may_publish(topic)]
    called = [service.pattern for service in SERVICES.values() if role in service.callers]
    served = [service.pattern for service in SERVICES.values() if role == service.server]
    cells = (", ".join(f"`{key}`" for key in sorted(keys)) for keys in (published, called, served))
    return f"| {role} | {' | '.join(cells)} |\n"


if __name__ == "__main__":
    PAGE.write_text(drawn(PAGE.read_text()))
