"""Golden recordings: made anew, compared with the old ones."""
