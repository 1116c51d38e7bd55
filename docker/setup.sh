#!/usr/bin/env bash
# Installs the Debian packages of docker/packages.txt. Sourced by ./run and ./test, run by the image.
# Usage: docker/setup.sh STAGE…   (build, run, test)

setup_here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)

# Any Node from 18 on with npm serves; Debian's packages would clash with another vendor's.
setup_node_is_there() {
  command -v npm >/dev/null 2>&1 && node -e 'process.exit(+process.versions.node.split(".")[0] >= 18 ? 0 : 1)' >/dev/null 2>&1
}

setup_missing_packages() { # STAGE…
  local stage package wanted=" $* "
  while read -r stage package _; do
    case "$stage" in ''|\#*) continue ;; esac
    [[ "$wanted" == *" $stage "* ]] || continue
    case "$package" in nodejs|npm) setup_node_is_there && continue ;; esac
    [ "$(dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null)" = installed ] || printf '%s\n' "$package"
  done < "$setup_here/packages.txt"
}

setup_packages() { # STAGE…
  local missing as_root=()
  if ! command -v dpkg-query >/dev/null 2>&1; then
    echo "This needs Debian 12: its packages are listed in docker/packages.txt." >&2
    return 1
  fi
  mapfile -t missing < <(setup_missing_packages "$@")
  [ ${#missing[@]} -gt 0 ] || return 0
  if [ "$(id -u)" -ne 0 ]; then
    # sudo -v asks for the password only where somebody can type it.
    if command -v sudo >/dev/null 2>&1 && { sudo -n true 2>/dev/null || { [ -t 0 ] && sudo -v; }; }; then
      as_root=(sudo)
    else
      {
        echo "${#missing[@]} Debian packages are missing, and installing them needs root. Run this once, then start again:"
        echo
        echo "  su -c 'apt-get update && apt-get install -y --no-install-recommends ${missing[*]}'"
      } >&2
      return 1
    fi
  fi
  echo "== Installing ${#missing[@]} Debian packages (the first time: some 600 MB, a few minutes)" >&2
  "${as_root[@]}" apt-get update -q >&2 || return 1
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y -q --no-install-recommends "${missing[@]}" >&2
}

if [ "${BASH_SOURCE[0]}" = "$0" ]; then
  set -euo pipefail
  [ $# -gt 0 ] || { echo "usage: docker/setup.sh STAGE…   (build, run, test)" >&2; exit 2; }
  setup_packages "$@"
fi
