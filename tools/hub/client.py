"""The hub's own client, with its errors in one line. `HF_ENDPOINT` names another hub, `HF_TOKEN` its user's token."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

import huggingface_hub
from huggingface_hub.errors import (
    HfHubHTTPError,
    HTTPError,
    LocalEntryNotFoundError,
    RepositoryNotFoundError,
    RevisionNotFoundError,
)
from huggingface_hub.utils import disable_progress_bars

from tailor.schemas.errors import UsageError


def upload(folder: Path, repository: str, kind: str, public: bool) -> str:
    """Put a folder into a repository in one commit; a new repository is private unless `public`.

    Args:
      folder: Folder with README.md.
      repository: As `USER/NAME`.
      kind: "model" or "dataset".
      public: Whether everyone may read a new repository.

    Returns:
      Address of the commit.

    Raises:
      UsageError: The hub cannot be reached, or refuses.
    """
    with _errors(repository):
        api = huggingface_hub.HfApi(_endpoint())
        api.create_repo(repository, repo_type=kind, private=not public, exist_ok=True)
        message = f"tailor models push: {kind}"
        done = api.upload_folder(repo_id=repository, folder_path=folder, repo_type=kind, commit_message=message)
        return str(done.commit_url)


def file_sizes(repository: str, kind: str, revision: str | None) -> dict[str, int]:
    """Bytes of each file of a repository, by path.

    Raises:
      UsageError: There is no such repository or revision, or the hub cannot be reached.
    """
    with _errors(repository):
        api = huggingface_hub.HfApi(_endpoint())
        tree = api.list_repo_tree(repository, recursive=True, revision=revision, repo_type=kind)
        return {entry.path: entry.size for entry in tree if isinstance(entry, huggingface_hub.hf_api.RepoFile)}


def download(repository: str, kind: str, revision: str | None, patterns: Sequence[str], folder: Path) -> None:
    """Get the files of a repository that match patterns into an empty folder.

    Raises:
      UsageError: There is no such repository or revision, or the hub cannot be reached.
    """
    with _errors(repository):
        huggingface_hub.snapshot_download(
            repository,
            repo_type=kind,
            revision=revision,
            allow_patterns=list(patterns),
            local_dir=folder,
            endpoint=_endpoint(),
        )


def _endpoint() -> str | None:
    """`HF_ENDPOINT` as it is now, which the client reads only when it is imported; None: the client's own."""
    return os.environ.get("HF_ENDPOINT") or None


@contextmanager
def _errors(repository: str) -> Iterator[None]:
    """Errors of client and hub as one line; progress only for people."""
    huggingface_hub.logging.set_verbosity_error()
    if not sys.stderr.isatty():
        disable_progress_bars()
    try:
        yield
    except RevisionNotFoundError:
        raise UsageError(f"{repository}: has no such revision, expected a branch, a tag or a commit") from None
    except RepositoryNotFoundError:
        raise UsageError(f"{repository}: no such repository, or HF_TOKEN holds no token that may use it") from None
    except HfHubHTTPError as error:
        status = error.response.status_code
        raise UsageError(f"{repository}: the hub refuses with status {status}: {_short(error)}") from error
    except (HTTPError, LocalEntryNotFoundError) as error:
        raise UsageError(f"{repository}: the hub cannot be reached: {_short(error)}") from error
    except (OSError, ValueError, RuntimeError) as error:  # RuntimeError: another thread closed the connection
        raise UsageError(f"{repository}: {_short(error)}") from error


def _short(error: Exception) -> str:
    """First line of an error's text."""
    lines = str(error).strip().splitlines()
    return lines[0][:200] if lines else type(error).__name__
