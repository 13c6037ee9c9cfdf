# SPDX-License-Identifier: Apache-2.0
# Shared by ./run, ./test and .ci/run: installs what is missing, builds a preset. Everything it prints goes to stderr, so
# that the standard output of ./run is the program's alone. Each phase is announced, and how long it took.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)

# CPU seconds of a first build of each preset (without ccache) and of the suite, roughly: for the times that are printed.
declare -A first_build_s=([release]=500 [test]=1500 [asan-ubsan]=500 [package]=600)
suite_s=100

say() { printf '%s\n' "$*" >&2; }

# phase [NAME]: says how long the phase before took, and announces the next one.
phase_name=""
phase() {
  [ -z "$phase_name" ] || say "$(printf -- '-- %s: %d min %02d s' "$phase_name" $(((SECONDS - phase_began) / 60)) $(((SECONDS - phase_began) % 60)))"
  phase_name=${1:-} phase_began=$SECONDS
  [ -z "$phase_name" ] || say "== $phase_name"
}

# minutes CPU_SECONDS: how long that takes on this machine, in words.
minutes() {
  local cores m
  cores=$(nproc)
  m=$((($1 / cores + 30) / 60))
  [ "$m" -gt 0 ] || { echo "less than a minute on $cores cores"; return; }
  echo "about $m minute$([ "$m" -eq 1 ] || echo s) on $cores core$([ "$cores" -eq 1 ] || echo s)"
}

# install_missing FILE...: the Debian packages listed in the files, if they are not installed.
install_missing() {
  local wanted missing=() name
  wanted=$(cat "$@" | sed 's/#.*//' | tr -s ' \t\n' ' ')
  for name in $wanted; do
    # A Node.js of another source brings its npm along, and conflicts with Debian's.
    [ "$name" = npm ] && command -v npm >/dev/null && continue
    [ -e "/var/lib/dpkg/info/$name.list" ] || compgen -G "/var/lib/dpkg/info/$name:*.list" >/dev/null || missing+=("$name")
  done
  [ ${#missing[@]} -eq 0 ] && return 0
  local as_root=()
  if [ "$(id -u)" != 0 ]; then
    command -v sudo >/dev/null || { say "error: packages are missing and there is no sudo; as root: apt-get install ${missing[*]}"; exit 3; }
    as_root=(sudo)
  fi
  command -v apt-get >/dev/null || { say "error: this is not Debian; install the equivalents of: ${missing[*]}"; exit 3; }
  say "installing packages, once: ${missing[*]} (a minute or two, depending on the network)"
  local log="$root/build/install.log"
  mkdir -p "$root/build"
  { "${as_root[@]}" apt-get update -qq && "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive \
      apt-get install -y -qq --no-install-recommends "${missing[@]}"; } >"$log" 2>&1 ||
    { tail -n 20 "$log" >&2; say "error: installing packages failed; the whole log is in build/install.log"; exit 3; }
}

# tenths: of the lines of ninja, says each tenth of the work.
tenths() {
  local line done next=0
  while IFS= read -r line; do
    [[ $line =~ ^\[\ *([0-9]+)%\] ]] || continue
    done=${BASH_REMATCH[1]}
    if [ "$done" -ge "$next" ]; then say "$done %"; next=$((done - done % 10 + 10)); fi
  done
}

# build_preset PRESET TARGET...: configures once, then builds what changed. The first build shows its progress.
build_preset() {
  local preset=$1; shift
  local folder="$root/build/$preset" log="$root/build/$preset.log" quiet=(--quiet)
  mkdir -p "$root/build"
  if [ ! -e "$folder/build.ninja" ]; then
    (cd "$root" && cmake --preset "$preset") >"$log" 2>&1 ||
      { rm -f "$folder/build.ninja"; tail -n 30 "$log" >&2; say "error: configuring failed; the whole log is in build/$preset.log"; exit 3; }
  fi
  if [ ! -e "$folder/built" ]; then
    say "building build/$preset: $(minutes "${first_build_s[$preset]}"), once; later only what changed"
    quiet=()
  fi
  if [ -t 2 ]; then
    ninja -C "$folder" "${quiet[@]}" "$@" >&2 || { say "error: the build failed"; exit 3; }
  else
    # Without a terminal: a line for each tenth of the work.
    NINJA_STATUS='[%p] ' ninja -C "$folder" "$@" 2>&1 | tee "$log" | tenths ||
      { grep -E 'error|FAILED|warning' "$log" | head -n 40 >&2; tail -n 20 "$log" >&2; say "error: the build failed; the whole log is in build/$preset.log"; exit 3; }
  fi
  touch "$folder/built"
}
