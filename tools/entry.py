"""Entry point of the `tailor` command: loads nothing itself, so that Ctrl-C while modules load prints no traceback."""

INTERRUPTED = 130  # exit code, as a shell has it


def main() -> int:
    """Run the command of the process's arguments; see `tailor.tools.main`."""
    try:
        from tailor.tools.main import main as run

        return run()
    except KeyboardInterrupt:
        return INTERRUPTED
