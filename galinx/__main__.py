"""``python3 -m galinx``: the command line."""

import sys

if __name__ == "__main__" and not sys.flags.safe_path:
    del sys.path[0]  # the current folder, where libraries are not to be looked for

from galinx.app import errors, process


def main() -> None:
    """Run the command line; a missing library and a signal are reported."""
    try:
        process.begin()
        from galinx.app.cli import run_from_shell

        run_from_shell()
    except ImportError as error:
        process.refuse(errors.unavailable(error))
    except process.Interrupted:
        process.end_stopped(process.NOTHING)


if __name__ == "__main__":
    main()
