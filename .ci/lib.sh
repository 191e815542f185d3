# Shared by run, test and .ci/run; sourced, never started. The caller has set -euo pipefail and `me`
# (its own name, for messages).
# shellcheck shell=bash

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
build=$root/build
bin=$build/bin
node_home=$root/.cache/node
node_version=22.23.3 # installed only where Node is missing or older than the web tools need
npm_version=10.9.9
jobs=$(nproc)

# Compiled objects are shared between clones of the same sources.
export CCACHE_BASEDIR=$root CCACHE_NOHASHDIR=1

say() { printf '%s\n' "$*"; }

# One line with the cause, then out.
die() {
  printf '%s: %s\n' "${me:-roverd}" "$*" >&2
  exit 1
}

# logged TITLE LOG COMMAND…: shows and keeps the output; on failure one line with cause and log.
logged() {
  local title=$1 log=$2 cause
  shift 2
  mkdir -p "$(dirname "$log")"
  if ! "$@" 2>&1 </dev/null | tee "$log"; then
    cause=$(grep -m1 -E '(error|ERR!|^E: |fatal|Error:)' "$log" || tail -n 1 "$log")
    die "$title failed: ${cause:-no message} (log: $log)"
  fi
}

as_root() {
  if [ "$(id -u)" = 0 ]; then
    "$@"
  else
    command -v sudo >/dev/null || die "$1 needs root: start as root, or install sudo"
    sudo "$@"
  fi
}

# What apt would take away from this machine to install PACKAGE…, by a trial that changes nothing.
would_be_removed() {
  apt-get -s -q --no-install-recommends install "$@" 2>/dev/null | sed -n 's/^Remv \([^ ]*\).*/\1/p'
}

# install_packages LOG PACKAGE…: apt, without questions. It never takes away what the machine has.
install_packages() {
  local log=$1 victims
  shift
  command -v apt-get >/dev/null ||
    die "this is not a Debian system; please install by hand: $*"
  say "installing packages: $*"
  logged "apt-get update" "$log" as_root apt-get update -q
  mapfile -t victims < <(would_be_removed "$@")
  [ "${#victims[@]}" = 0 ] ||
    die "nothing was installed: these packages of this machine stand in the way and would be removed" \
      "(${#victims[@]}): ${victims[*]}; remove them yourself if you can do without, or use another machine"
  logged "apt-get install" "$log" as_root env DEBIAN_FRONTEND=noninteractive \
    apt-get install -y -q --no-remove --no-install-recommends "$@"
}

# need_packages LIST…: installs what is missing of the files .ci/packages.LIST; quick when all is there.
need_packages() {
  local list wanted=() missing=() name state
  for list in "$@"; do
    mapfile -t -O "${#wanted[@]}" wanted < <(grep -vE '^(#|$)' "$root/.ci/packages.$list")
  done
  declare -A installed=()
  while read -r name state; do
    [ "$state" = installed ] && installed[${name%%:*}]=1
  done < <(dpkg-query -W -f='${Package} ${db:Status-Status}\n' "${wanted[@]}" 2>/dev/null || true)
  for name in "${wanted[@]}"; do
    [ -n "${installed[$name]:-}" ] || missing+=("$name")
  done
  # In the same turn, for the page.
  ! page_is_old || node_is_new_enough || command -v npm >/dev/null || missing+=(nodejs npm)
  [ "${#missing[@]}" = 0 ] || install_packages "$build/logs/packages.log" "${missing[@]}"
}

node_is_new_enough() {
  local version major minor
  version=$(node --version 2>/dev/null) && command -v npm >/dev/null || return 1
  IFS=. read -r major minor _ <<<"${version#v}"
  [ "$major" -gt 22 ] || { [ "$major" = 22 ] && [ "$minor" -ge 12 ]; } ||
    { [ "$major" = 20 ] && [ "$minor" -ge 19 ]; }
}

# The web tools need Node 20.19 or 22.12 and later; Debian 12 has 18. A newer one then comes from npm
# into the project's own .cache.
need_node() {
  node_is_new_enough && return
  PATH=$node_home/node_modules/.bin:$PATH
  export PATH
  node_is_new_enough && return
  command -v npm >/dev/null || install_packages "$build/logs/packages.log" nodejs npm
  say "fetching Node $node_version into .cache/node"
  mkdir -p "$node_home"
  logged "fetching Node" "$build/logs/node.log" npm install --prefix "$node_home" --no-audit \
    --no-fund --loglevel=error "node@$node_version" "npm@$npm_version"
  hash -r
  node_is_new_enough || die "the fetched Node does not start (log: $build/logs/node.log)"
}

# newer_than STAMP PATH…: is there no stamp, or something changed (or gone) since?
newer_than() {
  local stamp=$1
  shift
  [ -e "$stamp" ] || return 0
  # The generated types change only with the document that they come from.
  [ -n "$(find "$@" -newer "$stamp" ! -name schema.d.ts -print -quit 2>&1)" ]
}

# The page's packages as package-lock.json says.
need_web_packages() {
  local lock=$root/web/package-lock.json stamp=$root/web/node_modules/.complete
  newer_than "$stamp" "$lock" || return 0
  need_node
  say "fetching the page's packages"
  logged "npm ci" "$build/logs/npm.log" npm --prefix "$root/web" ci --no-audit --no-fund --loglevel=error
  touch "$stamp"
}

web_sources() {
  find "$root/web" -mindepth 1 -maxdepth 1 ! -name node_modules ! -name dist ! -name '.*'
}

page_is_old() {
  local sources
  mapfile -t sources < <(web_sources)
  newer_than "$build/page.stamp" "${sources[@]}" "$root/server/api"
}

build_web() {
  local stamp=$build/page.stamp
  page_is_old || return 0
  need_web_packages
  need_node
  say "building the page"
  mkdir -p "$build"
  touch "$stamp.new"
  logged "building the page" "$build/logs/page.log" npm --prefix "$root/web" run build
  mv "$stamp.new" "$stamp"
}

# configure FOLDER OPTION…: the first time, and when the options are others than then; ninja repeats it
# when a CMakeLists.txt changed.
configure() {
  local folder=$1 launcher=()
  shift
  [ -e "$folder/build.ninja" ] && [ "$(cat "$folder/options" 2>/dev/null)" = "$*" ] && return
  command -v ccache >/dev/null && launcher=(-DCMAKE_CXX_COMPILER_LAUNCHER=ccache)
  logged "cmake" "$build/logs/cmake-$(basename "$folder").log" \
    cmake -S "$root" -B "$folder" -G Ninja "${launcher[@]}" "$@"
  printf '%s' "$*" >"$folder/options"
}

# Ninja's lines, with how long the rest will take if it goes on so.
with_estimate() {
  local line ready total passed_s left_s
  while IFS= read -r line; do
    if [[ $line =~ ^\[([0-9]+)/([0-9]+)\ ([0-9]+)[.0-9]*\]\ (.*) ]]; then
      ready=${BASH_REMATCH[1]} total=${BASH_REMATCH[2]} passed_s=${BASH_REMATCH[3]}
      line=${BASH_REMATCH[4]}
      left_s=$(((total - ready) * (passed_s + 1) / (ready > 0 ? ready : 1)))
      printf '[%d/%d, about %d:%02d left] %s\n' "$ready" "$total" $((left_s / 60)) $((left_s % 60)) "$line"
    else
      printf '%s\n' "$line"
    fi
  done
}

ninja_with_estimate() { NINJA_STATUS='[%f/%t %e] ' ninja "$@" | with_estimate; }

ninja_build() {
  local folder=$1
  shift
  logged "building" "$build/logs/ninja-$(basename "$folder").log" \
    ninja_with_estimate -C "$folder" -j "$jobs" "$@"
}

product_is_old() {
  newer_than "$build/product.stamp" "$root/server" "$root/drivers" "$root/migrations" \
    "$root/CMakeLists.txt" "$build/page.stamp" || [ ! -x "$bin/roverd" ] || [ ! -x "$bin/roverd-sim" ]
}

# Sources are compiled in groups, which takes half of the time; so names in the anonymous namespaces
# of a room must differ.
in_groups=(-DCMAKE_UNITY_BUILD=ON -DCMAKE_UNITY_BUILD_BATCH_SIZE=12)
release=(-DCMAKE_BUILD_TYPE=Release "-DCMAKE_CXX_FLAGS_RELEASE=-O2 -DNDEBUG" "${in_groups[@]}")

# What waits for the network, and what waits for the processor, side by side: the page's packages, and
# all of the programs that holds no page.
build_beside_the_page() {
  local page
  need_node
  say "building the page beside the programs (log: $build/logs/page-beside.log)"
  mkdir -p "$build/logs"
  # Made by the build; if it appeared only then, its folder would seem changed afterwards.
  [ -e "$root/web/src/link/schema.d.ts" ] || : >"$root/web/src/link/schema.d.ts"
  (build_web) >"$build/logs/page-beside.log" 2>&1 &
  page=$!
  configure "$build" "${release[@]}"
  ninja_build "$build" rooms
  wait "$page" || {
    tail -n 20 "$build/logs/page-beside.log"
    die "building the page failed (log: $build/logs/page-beside.log)"
  }
}

# The two programs and the page. Nothing but a look at time stamps when nothing changed: whoever may
# not write here may still start what others built.
build_product() {
  local stamp=$build/product.stamp
  page_is_old || product_is_old || return 0
  if ! mkdir -p "$build/logs" 2>/dev/null || ! { : >>"$build/.lock"; } 2>/dev/null; then
    die "cannot build: $(id -un) may not write in $build"
  fi
  need_packages run
  exec 9>"$build/.lock"
  flock -n 9 || {
    say "another build is running in $build; waiting for it"
    flock 9
  }
  if page_is_old && product_is_old; then
    build_beside_the_page
  fi
  build_web
  if product_is_old; then
    touch "$stamp.new"
    configure "$build" "${release[@]}"
    say "building roverd and roverd-sim"
    ninja_build "$build" roverd roverd-sim
    mv "$stamp.new" "$stamp"
  fi
  exec 9>&-
}
