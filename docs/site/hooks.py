"""Hooks of mkdocs: pages that are generated from the code, and those that lie in the root of the repository."""

from __future__ import annotations

import re
import sys
from pathlib import Path
from typing import Any

from mkdocs.structure.files import File, Files

sys.path.insert(0, str(Path(__file__).parent))
from commands_page import commands_page
from configuration_page import configuration_page

ROOT = Path(__file__).parents[2]
OF_ROOT = ("CONTRIBUTING.md", "SAFETY.md", "CHANGELOG.md")
INTO_SOURCE = re.compile(
    r"\[([^\]]+)\]\((?!https?:|#|mailto:)((?:\.\./)*(?:examples|tests|tools|executive|ros2|README)[^)]*)\)"
)
FETCHED = re.compile(r'<script src="https://[^"]*"></script>')
DIAGRAM = re.compile(r"```mermaid\n.*?```\n", re.DOTALL)  # GitHub draws it; the site would have to fetch a script
UP = re.compile(r"\]\((?:\.\./)+(CONTRIBUTING|SAFETY|CHANGELOG)\.md")


def on_files(files: Files, config: Any) -> Files:
    """Add the generated pages and those of the root."""
    pages = {"reference/commands.md": commands_page(), "reference/configuration.md": configuration_page()}
    pages |= {name: (ROOT / name).read_text(encoding="utf-8") for name in OF_ROOT}
    for path, text in pages.items():
        files.append(File.generated(config, path, content=text))
    return files


def on_page_markdown(markdown: str, page: Any, **_: Any) -> str:
    """Links between the root and docs/ fit the site; those into the source become plain text."""
    if page.file.src_uri in OF_ROOT:
        markdown = markdown.replace("](docs/", "](")
    markdown = DIAGRAM.sub("", markdown)
    depth = "../" * page.file.src_uri.count("/")
    return UP.sub(rf"]({depth}\1.md", INTO_SOURCE.sub(r"\1", markdown))


def on_post_page(output: str, **_: Any) -> str:
    """Without the one script that the theme would fetch: it serves a search in pages opened from a folder."""
    return FETCHED.sub("", output)


def on_post_template(output_content: str, **_: Any) -> str:
    """The same for the page of errors."""
    return FETCHED.sub("", output_content)
