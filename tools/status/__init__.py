"""State of a running system, as any subscriber of the bus sees it: collected, judged, drawn."""
