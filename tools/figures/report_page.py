"""A self-contained HTML page about runs: the picture inside it, and the figures as tables."""

from __future__ import annotations

import base64
import html
from collections.abc import Sequence
from pathlib import Path

STYLE = """
body { font: 15px/1.5 system-ui, sans-serif; max-width: 70rem; margin: 2rem auto; padding: 0 1rem; color: #222 }
.table { overflow-x: auto }
figure { margin: 1rem 0 } figcaption { color: #555 } img { max-width: 100% }
table { border-collapse: collapse; margin: 1rem 0 }
td, th { padding: .25rem .9rem; border-bottom: 1px solid #ddd; text-align: right }
td:first-child, th:first-child { text-align: left } caption { text-align: left; font-weight: 600; padding: .4rem 0 }
"""


def table(caption: str, head: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    """An HTML table; every cell is escaped."""
    cells = "".join(f"<th>{html.escape(name)}</th>" for name in head)
    lines = "".join("<tr>" + "".join(f"<td>{html.escape(c)}</td>" for c in row) + "</tr>" for row in rows)
    return f'<div class="table"><table><caption>{html.escape(caption)}</caption><tr>{cells}</tr>{lines}</table></div>'


def image(path: Path, description: str) -> str:
    """An embedded image with its caption."""
    data, caption = base64.b64encode(path.read_bytes()).decode(), html.escape(description)
    source = f"data:image/png;base64,{data}"
    return f'<figure><img alt="{caption}" src="{source}"><figcaption>{caption}</figcaption></figure>'


def page(title: str, body: Sequence[str]) -> str:
    """A whole page; `body` is HTML."""
    fits = '<meta name="viewport" content="width=device-width, initial-scale=1">'  # else a phone shows 980 pixels
    head = f'<meta charset="utf-8">{fits}<title>{html.escape(title)}</title><style>{STYLE}</style>'
    content = f"<h1>{html.escape(title)}</h1>{''.join(body)}"
    return f"<!doctype html><html lang=en><head>{head}</head><body>{content}</body></html>\n"
