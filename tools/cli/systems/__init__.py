"""Which system a command is about: its deployment file, its bus, and the flags that override them."""
