"""``python3 -m app``: the command line."""

from app.cli import run_from_shell

if __name__ == "__main__":
    run_from_shell()
