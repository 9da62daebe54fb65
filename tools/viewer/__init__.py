"""The page that shows a run: what it is told (rows), how it is put together, and how it is served while a run lasts."""
