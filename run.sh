#!/usr/bin/env bash
# galinx: sets up what is missing, then reproduces the study, runs the tests or a command.
#   ./run.sh                           reproduce the study into results/
#   ./run.sh test                      run all tests, those on two ranks included
#   ./run.sh bench [-o DIR]            measure run time against error
#   ./run.sh bench big [UNKNOWNS]      linear solvers on meshes of up to so many unknowns
#   ./run.sh bench scaling             every step on one rank and on two
#   ./run.sh bench assemblers          matrices by tensor products and by dolfinx
#   ./run.sh bench accuracy [TABLE]    tables of docs/verification.md, computed again
#   ./run.sh stress [-o DIR]           extremes of every parameter: do the promises hold?
#   ./run.sh docs                      build the documentation into site/
#   ./run.sh [-n RANKS] COMMAND ...    init, plan, run, show, report, ...; --help tells more
set -euo pipefail
fail() { # end with a status, and say why to whoever listens
  echo "error: $2" >&2 || true
  exit "$1"
}
trap 'fail 3 interrupted' INT TERM HUP
home=$(cd "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")" && pwd)
# The cores that this process may use; asked before, and without, the threads that each is to have.
cores=$(env -u OMP_NUM_THREADS -u OMP_THREAD_LIMIT nproc)
# Another Python, with dolfinx of its own, and the mpirun beside it; nothing is installed for that one.
python=${GALINX_PYTHON:-/usr/bin/python3}
if [ -n "${GALINX_PYTHON:-}" ] &&
  ! "$python" -c 'import sys; sys.exit(sys.version_info < (3, 11))' >/dev/null 2>&1; then
  fail 3 "GALINX_PYTHON is $python, expected a Python of version 3.11 or newer"
fi
python=$(command -v "$python")
mpirun=mpirun
[ ! -x "$(dirname "$python")/mpirun" ] || mpirun=$(dirname "$python")/mpirun

# The programs, then what only the tests need.
packages=(python3-dolfinx python3-petsc4py python3-mpi4py python3-gmsh python3-h5py python3-numpy
  python3-scipy python3-matplotlib python3-pint python3-click python3-rich
  python3-jinja2 python3-tomlkit python3-xarray python3-plotly
  libopenblas0-serial openmpi-bin gcc libc6-dev)
docs_packages=(mkdocs libjs-mathjax)
test_packages=(python3-pytest python3-pytest-xdist python3-hypothesis python3-sympy python3-mpmath python3-jsonschema
  python3-vtk9 chromium python3-pip python3-setuptools python3-wheel
  "${docs_packages[@]}")

missing() { # the packages of the arguments that are not installed
  local installed package
  # dpkg-query fails where it knows a package by no name.
  installed=$(dpkg-query -W -f='${Package} ${Status}\n' "$@" 2>/dev/null || true)
  for package in "$@"; do
    [[ $'\n'$installed$'\n' == *$'\n'"$package install ok installed"$'\n'* ]] || echo "$package"
  done
}

set_up() {
  local wanted
  [ -z "${GALINX_PYTHON:-}" ] || return 0
  mapfile -t wanted < <(missing "$@")
  [ ${#wanted[@]} -gt 0 ] || return 0
  if [ "$(id -u)" -ne 0 ]; then
    fail 3 "Debian packages are missing; ask an administrator to run
  apt-get update && apt-get install --no-install-recommends ${wanted[*]}"
  fi
  echo "installing: ${wanted[*]}" >&2 || true
  if ! { apt-get update -q && DEBIAN_FRONTEND=noninteractive apt-get install -q -y \
    --no-install-recommends "${wanted[@]}"; } >&2; then
    fail 3 "apt-get could not install ${wanted[*]}; see its messages above"
  fi
}

PYTHONPATH="$home${PYTHONPATH:+:$PYTHONPATH}"
# An empty entry, as PYTHONPATH=$PYTHONPATH:... leaves it, would mean the current folder.
while [[ $PYTHONPATH = *::* ]]; do PYTHONPATH=${PYTHONPATH//::/:}; done
export PYTHONPATH=${PYTHONPATH%:}
# How messages name this command: through bin/galinx it is called galinx.
GALINX_COMMAND=${0##*/}
[ "$GALINX_COMMAND" != run.sh ] || GALINX_COMMAND=./run.sh
export GALINX_COMMAND
# One BLAS thread a rank: more are slower at these sizes.
export OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
# All ranks are on this machine: looking for fast networks, or starting a daemon for a single process,
# would take a quarter of a second each time.
export OMPI_MCA_btl="${OMPI_MCA_btl:-self,vader}" OMPI_MCA_pml="${OMPI_MCA_pml:-ob1}"
export OMPI_MCA_ess_singleton_isolated="${OMPI_MCA_ess_singleton_isolated:-1}"
# What another mpirun told its ranks is nothing to those that are started here.
unset PMIX_RANK PMIX_NAMESPACE "${!OMPI_COMM_WORLD_@}" "${!PMI_@}" "${!PMIX_SERVER_@}"

allow_ranks() { # let mpirun start so many ranks
  if [ "$1" -gt "$cores" ]; then
    # As Open MPI 4 and 5 want to be told; MPICH allows it anyway. Ranks that wait then give way, so it
    # would cost time where each rank has a core.
    export OMPI_MCA_rmaps_base_oversubscribe=1 PRTE_MCA_rmaps_default_mapping_policy=:oversubscribe
  fi
}

if [ "${1:-}" = test ]; then
  shift
  set_up "${packages[@]}" "${test_packages[@]}"
  cd "$home"
  # Files of tests side by side, one more than there are cores: tests wait for what they start.
  suite=("$python" -m pytest -n "$((cores + 1))" --dist loadfile)
  for argument in "$@"; do # tests that are named are run alone
    [ ! -e "${argument%%::*}" ] || exec "${suite[@]}" "$@"
  done
  # What compares ranks compares nothing on one.
  "${suite[@]}" --ignore tests/mpi "$@" || [ $? -eq 5 ] # none, where -k selects no others
  allow_ranks 2
  exec "$mpirun" -n 2 "$python" -m mpi4py -m pytest tests/mpi "$@"
fi

if [ "${1:-}" = bench ]; then
  shift
  set_up "${packages[@]}"
  script=measure
  if [ -f "$home/benchmarks/${1:-}.py" ]; then
    script=$1
    shift
  fi
  exec "$python" "$home/benchmarks/$script.py" "$@"
fi

if [ "${1:-}" = stress ]; then
  set_up "${packages[@]}"
  exec "$python" "$home/benchmarks/stress" "$@"
fi

if [ "${1:-}" = docs ]; then
  set_up "${packages[@]}" "${docs_packages[@]}"
  cd "$home"
  "$python" docs/make.py
  exec mkdocs build --strict --quiet --site-dir site
fi

ranks=
if [ "${1:-}" = -n ]; then
  # More on a core would only fill the machine; and bash counts in 64 bits.
  most=$((16 * cores))
  if ! [[ "${2:-}" =~ ^[1-9][0-9]{0,5}$ ]] || [ "$2" -gt "$most" ]; then
    fail 2 "-n ${2:-}: expected a number of ranks up to $most, as in ./run.sh -n 2 run SCENE.toml"
  fi
  ranks=$2
  shift 2
fi
set_up "${packages[@]}"
[ $# -gt 0 ] || set -- paper -o results
# -P: no file of the current folder is taken for a library. Signals wait until Python can take them.
started=(env --block-signal=INT,TERM,HUP "$python" -P -m galinx)
if [ -z "$ranks" ]; then
  exec "${started[@]}" "$@"
fi

allow_ranks "$ranks"
# Where one process is killed, those that it started do not outlive it.
tied=()
! command -v setpriv >/dev/null || tied=(setpriv --pdeathsig)
# Ranks say themselves why they end, and mpirun what it cannot do; it keeps files of its own, too.
export OMPI_MCA_orte_execute_quiet=1
[ ! -t 2 ] || export GALINX_TERMINAL=1
# What ranks end with instead of 1, the verdict FAIL, for mpirun's own failures are 1.
export GALINX_FAIL=9
[ -d "${TMPDIR:-/tmp}" ] || unset TMPDIR
# In a session of its own: Ctrl-C is for this script to hand on, to rank 0, which ends in order.
setsid ${tied:+"${tied[@]}" TERM} "$mpirun" -n "$ranks" ${tied:+"${tied[@]}" KILL} \
  "${started[@]}" "$@" </dev/null &
job=$!
stop() {
  local root _
  read -r root _ <"/proc/$job/task/$job/children" || true
  kill -TERM "${root:-$job}" || true
}
trap stop INT TERM HUP
# A trap ends a wait early; ranks that ended before it are waited for, too, or their status were lost.
while :; do
  status=0
  wait $job 2>/dev/null || status=$?
  kill -0 $job 2>/dev/null || break
done
case $status in
  0 | 2 | 3) exit $status ;;
  "$GALINX_FAIL") exit 1 ;;
  *) fail 3 "ranks could not be started, or were killed (did the machine lack memory?); a run goes on with --resume" ;;
esac
