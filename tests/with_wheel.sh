#!/usr/bin/env bash
# The tests that meet dolfinx, with that of PyPI (0.11, MPICH of its own), in a virtual environment, that
# is made and first used as docs/install.md says: without finite elements, then with them.
#   tests/with_wheel.sh [--install] [FOLDER]     default: a folder in the user's cache; --install runs no tests
# Says that it is skipped, and ends well, where no Python of 3.12 or newer is found.
set -euo pipefail
home=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
install=
if [ "${1:-}" = --install ]; then
  install=only
  shift
fi
# As run.sh does: more BLAS threads are slower, and much slower where other processes run.
export OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1
# Of all that is installed a part is imported, and compiled then, once: pip compiles nothing.
unset PYTHONDONTWRITEBYTECODE
folder=${1:-${XDG_CACHE_HOME:-$HOME/.cache}/galinx/wheel}

newest() { # the newest Python that the wheel is made for and that can make environments
  local candidate
  for candidate in python3.14 python3.13 python3.12 "$HOME"/.pyenv/versions/3.1[2-4]*/bin/python python3; do
    if "$candidate" -c 'import sys, venv, ensurepip; sys.exit(sys.version_info < (3, 12))' 2>/dev/null; then
      command -v "$candidate"
      return
    fi
  done
  return 1
}

# Made again when what is needed has changed, or where it was interrupted.
if ! cmp --silent "$home/pyproject.toml" "$folder/made_for.toml"; then
  if ! found=$(newest); then
    echo "skipped: the wheel of dolfinx needs Python 3.12 or newer, none was found"
    exit 0
  fi
  "$found" -m venv --clear "$folder"
  work=$(mktemp -d)
  trap 'rm -rf "$work"' EXIT
  cd "$work"
  "$folder/bin/pip" install --quiet --no-compile "$home"
  "$folder/bin/galinx" init tables4_5
  "$folder/bin/galinx" run tables4_5.toml --set 'solve.methods = ["closed_form"]'
  "$folder/bin/pip" install --quiet --no-compile "$home[fem]"
  "$folder/bin/galinx" paper
  cd "$home"
  "$folder/bin/pip" install --quiet --no-compile "$home[test,docs]"
  "$folder/bin/pip" uninstall --quiet --yes galinx
  cp "$home/pyproject.toml" "$folder/made_for.toml"
fi
export GALINX_PYTHON="$folder/bin/python"
[ -z "$install" ] || exit 0
echo "with $("$folder/bin/pip" list 2>/dev/null | grep -i '^dolfinx' | tr -s ' ')"
"$home/run.sh" test -m fem "${@:2}"
