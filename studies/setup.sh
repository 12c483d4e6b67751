# shellcheck shell=bash disable=SC2034
# What studies/run and tests/run share: Debian packages, builds, and telling what they do. Sourced by bash, from the
# source directory.

# What the program is built from.
program_packages=(cmake g++ libboost-dev libcli11-dev libcpp-httplib-dev libeigen3-dev libfmt-dev libhdf5-dev
  librandom123-dev libssl-dev libsundials-dev libtbb-dev ninja-build nlohmann-json3-dev pkg-config python3 python3-yaml)

# What `studies/run paper` draws with.
figure_packages=(python3-matplotlib)

logs=build/logs  # of everything that is not shown
runner=()        # what builds and tests are run under

# step TITLE: one line that says what begins.
step() { printf '\n== %s\n' "$*"; }

# logged NAME COMMAND...: runs it with its output in $logs/NAME.log, whose end is shown when it fails.
logged() {
  local log=$logs/$1.log
  shift
  mkdir -p "$logs"
  "$@" >"$log" 2>&1 </dev/null && return
  local code=$?
  tail -n 40 "$log" >&2
  echo "failed: $* (the whole log is in $PWD/$log)" >&2
  return "$code"
}

# missing_packages PACKAGE...: those that are not installed, one a line.
missing_packages() {
  local package
  for package in "$@"; do
    dpkg-query -W -f '${db:Status-Abbrev}\n' "$package" 2>/dev/null | grep -q '^ii' || echo "$package"
  done
}

# as_root COMMAND...
as_root() {
  if [ "$(id -u)" -eq 0 ]; then
    "$@"
  elif command -v sudo >/dev/null; then
    sudo "$@"
  else
    echo "installing packages needs root, and there is no sudo; run this as root, or install them: ${missing[*]}" >&2
    return 1
  fi
}

apt_get() { as_root env DEBIAN_FRONTEND=noninteractive apt-get -q "$@"; }

# install_missing PACKAGE...: installs those that are not there; asks apt nothing when all are.
install_missing() {
  local missing
  mapfile -t missing < <(missing_packages "$@")
  if [ ${#missing[@]} -eq 0 ]; then
    echo "all $# there"
    return
  fi
  if ! command -v apt-get >/dev/null; then
    echo "this is no Debian; install the like of: ${missing[*]}" >&2
    return 1
  fi
  echo "installing ${missing[*]}"
  if [ "$(id -u)" -ne 0 ] && command -v sudo >/dev/null; then sudo -v || return; fi  # asks for the password in sight
  logged apt-update apt_get update || return
  logged apt-install apt_get install -y --no-install-recommends "${missing[@]}"
}

# build PRESET [TARGET...]: configures build/PRESET where that was not done and builds, without output when nothing is
# to be done.
build() {
  local preset=$1
  shift
  if [ ! -f "build/$preset/build.ninja" ]; then
    logged "configure-$preset" cmake --preset "$preset" || return
  fi
  local command=("${runner[@]}" cmake --build --preset "$preset" --parallel "$(nproc)")
  [ $# -eq 0 ] || command+=(--target "$@")
  if [ -t 1 ]; then
    "${command[@]}"  # ninja counts on one line
  else
    logged "build-$preset" "${command[@]}"
  fi
}
