"""Draws the table of rooms into docs/architecture.md: `python -m tests.unit.house.draw_map`."""

from pathlib import Path

from tests.unit.house.arrows import ROOMS, ROOT

ARCHITECTURE = ROOT / "docs" / "architecture.md"
BEGIN = "<!-- map: drawn from tests/unit/house/rooms.toml by `python -m tests.unit.house.draw_map` -->"
END = "<!-- end of map -->"
INTRODUCTION = """\
A room imports only rooms above it in its table. `root` stands for the modules that lie in the folder itself.
Each import is judged by the innermost folder that contains both modules.
The executive imports one module of `models`, `models/runtime.py`. Its `shell.py` alone also imports `runtime`.
`tests/unit/house/test_arrows.py` enforces these tables."""


def drawing() -> str:
    """Mermaid graph of the top-level folders, without arrows that a longer path implies."""
    rows = ROOMS["."]
    lines = ["```mermaid", "flowchart BT"]
    for room, row in rows.items():
        implied = {deeper for other in row["imports"] for deeper in rows[other]["imports"]}
        lines += [f"  {room} --> {other}" for other in row["imports"] if other not in implied]
    return "\n".join([*lines, "```"])


def table(folder: str) -> str:
    """Markdown table of one folder's rooms."""
    title = "Top level" if folder == "." else f"`{folder}/`"
    head = [f"**{title}**", "", "| room | holds | may import |", "|---|---|---|"]
    rows = [f"| `{room}` | {row['holds']} | {', '.join(row['imports'])} |" for room, row in ROOMS[folder].items()]
    return "\n".join([*head, *rows])


def with_map(page: str) -> str:
    """The page with the map between its markers drawn anew."""
    before, _, rest = page.partition(BEGIN)
    after = rest.partition(END)[2]
    return "\n".join(
        [f"{before}{BEGIN}", "", INTRODUCTION, "", drawing(), "", "\n\n".join(map(table, ROOMS)), "", f"{END}{after}"]
    )


def main(page: Path = ARCHITECTURE) -> None:
    """Rewrite the page."""
    page.write_text(with_map(page.read_text()))


if __name__ == "__main__":
    main()
