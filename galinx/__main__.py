"""``python3 -m galinx``: the command line."""

from galinx.app.cli import run_from_shell

if __name__ == "__main__":
    run_from_shell()
