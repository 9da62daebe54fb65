"""Draws what derives from the tables of topics and services: roles into docs/security.md, topics into messages.md."""

from tailor.runtime.bus.rights.access import may_publish
from tailor.schemas.services import ROLES, SERVICES, Role
from tailor.schemas.topics import TOPICS, Topic
from tailor.schemas.typesystem import ros_type
from tests.unit.house.arrows import ROOT

HEADS = {  # by page
    "security.md": "| role | publishes | calls | serves |\n|---|---|---|---|\n",
    "messages.md": "| key | type | from | meaning |\n|---|---|---|---|\n",
}


def text_of(page: str) -> str:
    """The page as it is."""
    return (ROOT / "docs" / page).read_text()


def drawn(page: str) -> str:
    """The page with today's table."""
    head = HEADS[page]
    rows = map(_role, ROLES) if page == "security.md" else map(_topic, TOPICS.values())
    before, rest = text_of(page).split(head)
    return before + head + "".join(rows) + "\n" + rest.split("\n\n", 1)[1]


def _role(role: Role) -> str:
    published = [topic.key.format(robot="*") for topic in TOPICS.values() if role in may_publish(topic)]
    called = [service.pattern for service in SERVICES.values() if role in service.callers]
    served = [service.pattern for service in SERVICES.values() if role == service.server]
    cells = (", ".join(f"`{key}`" for key in sorted(keys)) for keys in (published, called, served))
    return f"| {role} | {' | '.join(cells)} |\n"


def _topic(topic: Topic) -> str:
    rate = f"{topic.rate_hz:g} Hz" if topic.rate_hz else "on change"
    stale = f", stale after {topic.fresh_s:g} s" if topic.fresh_s else ""
    kind = ros_type(topic.type).replace("/msg/", "/")
    meaning = (topic.type.__doc__ or "").splitlines()[0]
    return f"| `{topic.key.format(robot='<robot>')}` | `{kind}` | {topic.source}, {rate}{stale} | {meaning} |\n"


if __name__ == "__main__":
    for each in HEADS:
        (ROOT / "docs" / each).write_text(drawn(each))
