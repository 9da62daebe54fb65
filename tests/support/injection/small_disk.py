"""A disk that is full, for files that this process and its children write."""

import resource
from contextlib import contextmanager


@contextmanager
def small_disk(limit):
    """No file grows beyond so many bytes: writing fails as on a full disk, in whatever library."""
    soft, hard = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (limit, hard))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, (soft, hard))
