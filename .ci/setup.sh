# SPDX-License-Identifier: Apache-2.0
# Shared by ./run, ./test and .ci/run: install what is missing, build a preset. Everything it says goes to stderr,
# so that the standard output of ./run is the program's alone.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)

say() { printf '%s\n' "$*" >&2; }

# install_missing FILE...: the Debian packages listed in the files, when not there yet.
install_missing() {
  local wanted missing=() name
  wanted=$(cat "$@" | sed 's/#.*//' | tr -s ' \t\n' ' ')
  for name in $wanted; do
    [ -e "/var/lib/dpkg/info/$name.list" ] || compgen -G "/var/lib/dpkg/info/$name:*.list" >/dev/null || missing+=("$name")
  done
  [ ${#missing[@]} -eq 0 ] && return 0
  local as_root=()
  if [ "$(id -u)" != 0 ]; then
    command -v sudo >/dev/null || { say "error: packages are missing and there is no sudo; as root: apt-get install ${missing[*]}"; exit 3; }
    as_root=(sudo)
  fi
  command -v apt-get >/dev/null || { say "error: this is not Debian; install the equivalents of: ${missing[*]}"; exit 3; }
  say "installing: ${missing[*]}"
  local log="$root/build/install.log"
  mkdir -p "$root/build"
  { "${as_root[@]}" apt-get update -qq && "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive \
      apt-get install -y -qq --no-install-recommends "${missing[@]}"; } >"$log" 2>&1 ||
    { tail -n 20 "$log" >&2; say "error: installing packages failed; the whole log is in build/install.log"; exit 3; }
}

# build_preset PRESET TARGET...: configures once, then builds what changed.
build_preset() {
  local preset=$1; shift
  local log="$root/build/$preset.log"
  mkdir -p "$root/build"
  if [ ! -e "$root/build/$preset/build.ninja" ]; then
    (cd "$root" && cmake --preset "$preset") >"$log" 2>&1 ||
      { rm -f "$root/build/$preset/build.ninja"; tail -n 30 "$log" >&2; say "error: configuring failed; the whole log is in build/$preset.log"; exit 3; }
    say "building build/$preset (once; later only what changed)"
  fi
  if [ -t 2 ]; then
    ninja -C "$root/build/$preset" --quiet "$@" >&2 || { say "error: the build failed"; exit 3; }
  else
    ninja -C "$root/build/$preset" "$@" >"$log" 2>&1 ||
      { grep -E 'error|FAILED|warning' "$log" | head -n 40 >&2; tail -n 20 "$log" >&2; say "error: the build failed; the whole log is in build/$preset.log"; exit 3; }
  fi
}
