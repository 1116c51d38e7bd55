#!/usr/bin/env bash
# Builds the program and the page. Sourced by ./run and ./test, from the project's root.

# npm's packages of a folder as its lock file pins them, again only when that has changed. Not npm ci: the
# lock file may lack the binaries for other platforms, and npm ci would refuse it for that.
build_node_modules() { # FOLDER
  local stamp=$1/node_modules/.kinectlab-lock
  cmp -s "$1/package-lock.json" "$stamp" 2>/dev/null && return 0
  echo "== Fetching the npm packages of $1" >&2
  (cd "$1" && npm install --no-save --no-fund --no-audit --loglevel=error >&2) && cp "$1/package-lock.json" "$stamp"
}

# The page, again only when one of its sources is newer than what was built.
build_web() {
  local built=web/dist/index.html
  build_node_modules web || return 1
  if [ -f "$built" ] && [ -z "$(find web -path web/node_modules -prune -o -path web/dist -prune -o -type f -newer "$built" -print -quit)" ]; then
    return 0
  fi
  echo "== Building the page" >&2
  (cd web && npm run --silent build >&2)
}

build_program() { # PRESET [TARGET…]
  local preset=$1 log=build/$1/configure.log
  shift
  mkdir -p "build/$preset"
  if [ ! -f "build/$preset/build.ninja" ]; then
    echo "== Configuring build/$preset" >&2
    cmake --preset "$preset" > "$log" 2>&1 || { cat "$log" >&2; return 1; }
  fi
  echo "== Building build/$preset" >&2
  ninja -C "build/$preset" "$@" >&2
}
