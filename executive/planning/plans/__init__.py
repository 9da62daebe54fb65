"""Finished plans: text formats, validation, completion, suffixes. Shares nothing with the search."""
