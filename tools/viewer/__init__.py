"""The page that shows a run: its events, its assembly into one file, and the server of the live page."""
