"""Draws the table of topics that ship into docs/messages.md."""

from tailor.schemas.topics import TOPICS, Topic
from tailor.schemas.typesystem import ros_type
from tests.unit.house.arrows import ROOT

PAGE = ROOT / "docs" / "messages.md"
HEAD = "| key | type | Hz | from | stale after | meaning |\n|---|---|---|---|---|---|\n"


def drawn(page: str) -> str:
    """The page with today's table."""
    before, rest = page.split(HEAD)
    return before + HEAD + "".join(map(_row, TOPICS.values())) + "\n" + rest.split("\n\n", 1)[1]


def _row(topic: Topic) -> str:
    rate = f"{topic.rate_hz:g}" if topic.rate_hz else "on change"
    stale = f"{topic.fresh_s:g} s" if topic.fresh_s else ""
    meaning = (topic.type.__doc__ or "").splitlines()[0]
    key = topic.key.format(robot="<robot>")
    return f"| `{key}` | {ros_type(topic.type)} | {rate} | {topic.source} | {stale} | {meaning} |\n"


if __name__ == "__main__":
    PAGE.write_text(drawn(PAGE.read_text()))
