# Sourced by the other scripts: installs what is missing, builds, and sets up the ROS environment.
# Everything it prints goes to standard error, so that standard output belongs to the caller.

haptex_root="$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd -P)"

haptex_die() {
  echo "$(basename "$0"): $*" >&2
  exit 1
}

haptex_as_root() {
  if [ "$(id -u)" -eq 0 ]; then
    "$@"
  elif command -v sudo >/dev/null; then
    sudo "$@"
  else
    haptex_die "missing packages have to be installed by root, and there is no sudo: $*"
  fi
}

# haptex_install_packages [LIST]: installs the packages of scripts/packages.txt, or of another list there, that are not
# installed yet.
haptex_install_packages() {
  local list="$haptex_root/scripts/${1:-packages.txt}"
  local package
  local missing=()
  while read -r package; do
    [ "$(dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null)" = installed ] ||
      missing+=("$package")
  done < <(sed -e 's/#.*//' -e '/^[[:space:]]*$/d' "$list")
  [ "${#missing[@]}" -eq 0 ] && return
  echo "Installing ${#missing[@]} Debian packages: ${missing[*]}" >&2
  haptex_as_root apt-get update >&2 || haptex_die "apt-get update failed"
  haptex_as_root env DEBIAN_FRONTEND=noninteractive \
    apt-get install --yes --no-install-recommends "${missing[@]}" >&2 ||
    haptex_die "these packages could not be installed: ${missing[*]}"
}

# haptex_logged LOG COMMAND...: runs the command into the log and shows its end if it fails.
haptex_logged() {
  local log="$1"
  shift
  if ! "$@" >>"$log" 2>&1; then
    tail -n 40 "$log" >&2
    echo "failed: $*" >&2
    echo "The whole log: $log" >&2
    return 1
  fi
}

# haptex_configure DIRECTORY [CMAKE_ARGUMENT...]: configures into a build directory of the package.
# One that was made for another place is made anew: its paths are wrong.
haptex_configure() {
  local build="$haptex_root/$1"
  shift
  local cache="$build/CMakeCache.txt"
  if [ -e "$cache" ] && ! { grep -qxF "CMAKE_HOME_DIRECTORY:INTERNAL=$haptex_root" "$cache" &&
    grep -qxF "CMAKE_CACHEFILE_DIR:INTERNAL=$build" "$cache"; }; then
    rm -rf "$build"
  fi
  # catkin caches the environment in which it runs the tests while it configures, and leaves out
  # directories that are not there yet: without this one our messages would be missing from the
  # Python of the first build's rostests.
  mkdir -p "$build/devel/lib/python3/dist-packages"
  : >"$build/build.log"
  # Debian's ROS belongs to Debian's Python, which need not be the first on PATH.
  haptex_logged "$build/build.log" cmake -S "$haptex_root" -B "$build" \
    -DCMAKE_BUILD_TYPE=Release -DHAPTEX_SANITIZE= -DPYTHON_EXECUTABLE=/usr/bin/python3 \
    -DCATKIN_DEVEL_PREFIX="$build/devel" -DCMAKE_INSTALL_PREFIX="$build/install" "$@"
}

# haptex_compile DIRECTORY [TARGET...]
haptex_compile() {
  local build="$haptex_root/$1"
  shift
  haptex_logged "$build/build.log" cmake --build "$build" -j "$(nproc)" --target "${@:-all}"
}

# haptex_link_programs: links in bin/ to the programs of build/, which lies where rosrun never looks
# (PACKAGE/build). It finds the scripts without them, and in a catkin workspace the programs.
haptex_link_programs() {
  local program
  rm -rf "${haptex_root:?}/bin"
  mkdir "$haptex_root/bin"
  for program in "$haptex_root"/build/devel/lib/haptex/*; do
    # The others are catkin's relays of the scripts.
    [ "$(head -c 4 "$program" | tail -c 3)" = ELF ] || continue
    case "$(basename "$program")" in
      test_* | bench_*) ;;
      *) ln -s "../build/devel/lib/haptex/$(basename "$program")" "$haptex_root/bin/" ;;
    esac
  done
}

# haptex_environment SETUP_FILE: ROS's own setup files read variables that may be unset.
haptex_environment() {
  local setup_file="$1"
  set --
  set +u
  # shellcheck disable=SC1090
  source "$setup_file" >&2
  set -u
}

# Shows the per cent of a build that its output on standard input tells: in one line of a terminal,
# or a line for every ten.
haptex_progress() {
  local line percent shown=0
  while read -r line; do
    [[ "$line" =~ ^\[\ *([0-9]+)%\] ]] || continue
    percent="${BASH_REMATCH[1]}"
    if [ -t 2 ]; then
      printf '\rBuilding: %3d %%' "$percent" >&2
    elif [ "$percent" -ge "$((shown + 10))" ]; then
      shown="$percent"
      echo "Building: $percent %" >&2
    fi
  done
  if [ -t 2 ]; then echo >&2; fi
}

# haptex_setup [TARGET...]: installs what is missing, builds everything or some targets, and enters
# the devel space.
haptex_setup() {
  haptex_install_packages
  echo "Building in $haptex_root/build" >&2
  haptex_configure build || haptex_die "configuring failed"
  cmake --build "$haptex_root/build" -j "$(nproc)" --target "${@:-all}" 2>&1 |
    tee -a "$haptex_root/build/build.log" | haptex_progress || {
    tail -n 40 "$haptex_root/build/build.log" >&2
    haptex_die "building failed; the whole log: $haptex_root/build/build.log"
  }
  haptex_link_programs
  haptex_environment "$haptex_root/build/devel/setup.bash"
}

# A TCP port that nothing listens on, for a ROS master.
haptex_free_port() {
  /usr/bin/python3 -c 'import socket; s = socket.socket(); s.bind(("", 0)); print(s.getsockname()[1])'
}
