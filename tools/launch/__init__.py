"""Starting and checking whole systems."""
