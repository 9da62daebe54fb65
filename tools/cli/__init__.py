"""What all commands share: endpoints, deployment files, number checks, terminal output."""
