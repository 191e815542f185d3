# The steps of ./test, cheapest first; sourced by it. A step prints what it does and lines
# "ok - …", "not ok - …", "skip - …", "again - …"; it fails by its exit code.
# shellcheck shell=bash
# shellcheck source=.ci/lib.sh
true

all_steps=(doors shell format readme web build unit mutate api command vehicles real can page asan tsan fuzz)
# A server builds and runs each test of the rooms once (ONCE=yes): what only computes, as it ships
# (programs, simulated), all others under the sanitizers. By name are these, and what depends on what
# else the machine does, or takes long.
# shellcheck disable=SC2034
named_steps=(programs simulated figures tidy bench soak)
# shellcheck disable=SC2034
quick_steps=(doors shell format web build unit)
# shellcheck disable=SC2034
declare -A titles=(
  [doors]="every include and import goes through a door"
  [shell]="the scripts are clean"
  [format]="the sources are in the project's format"
  [readme]="what the README names exists"
  [web]="page: lint, types, unit tests"
  [build]="release build without warnings; objects need what their rooms may use"
  [programs]="release build of the programs, and of the tests that only compute"
  [simulated]="what computes for long, and meets no bytes of others, threads or sockets"
  [unit]="rooms, and the loop in simulated time"
  [api]="the API over real sockets"
  [command]="./run: options, bad input, Ctrl-C, second start; who has control; roverd decode; NTRIP casters; power cuts and kills; stops in a full house; TLS; under attack; secrets; a robot that sees; openssl, sslscan, curl, requests and websockets as peers; the network"
  [vehicles]="the main job with every vehicle: ./run --vehicle NAME, judged by the true pose"
  [real]="recordings and mission files from the field"
  [can]="a real CAN interface in the user-mode kernel"
  [page]="the page in a browser, against the simulated robot"
  [figures]="figures, measured shortly (twice the promise allowed)"
  [tidy]="clang-tidy finds nothing"
  [mutate]="the gate: its tests run every line and notice every change"
  [asan]="unit, loop and API under address and undefined sanitizers"
  [tsan]="threaded rooms and API under the thread sanitizer"
  [fuzz]="every parser of foreign bytes against random input"
  [soak]="a thousand kills lose nothing; twenty minutes of faults, clients and stops"
  [bench]="all figures of the README, in full"
)

# sources PATTERN…: tracked and new files, zero-separated.
sources() { git -C "$root" ls-files -co --exclude-standard -z -- "$@"; }

fix() {
  need_packages run test
  need_web_packages
  need_node
  (cd "$root" && sources '*.cpp' '*.hpp' | xargs -0 -r clang-format -i)
  (cd "$root/web" && npm run types >/dev/null && npx eslint --fix . && npm run format)
  [ ! -x "$build/bin/roverd" ] || "$build/bin/roverd" failsafes --into "$root/docs/safety.md"
}

# ordinary COMMAND…: as an ordinary user would run it; where we are root and on a server, as nobody.
# Permissions hold for that one. Where nobody cannot come here (a checkout below /root), as we are.
ordinary() {
  local home as=(setpriv --reuid=65534 --regid=65534 --clear-groups --inh-caps=-all)
  if [ "$(id -u)" != 0 ] || [ "${CI:-}" != true ]; then
    "$@"
  elif ! "${as[@]}" test -r "$root/run" -a -x "$build" 2>/dev/null; then
    say "as root: an ordinary user may not read $root"
    "$@"
  else
    home=$(mktemp -d "${TMPDIR:-/tmp}/roverd-nobody.XXXXXX")
    chown 65534:65534 "$home"
    say "as user nobody"
    local code=0
    env HOME="$home" TMPDIR="$home" PATH=/usr/local/bin:/usr/bin:/bin PYTHONDONTWRITEBYTECODE=1 "${as[@]}" "$@" || code=$?
    rm -rf "$home"
    return "$code"
  fi
}

run_as=() # or ordinary

# run_ctest FOLDER LABELS RESULTS [CTEST OPTION…]: results of every case on stdout.
run_ctest() {
  local folder=$1 labels=$2 results=$3 code=0
  shift 3
  rm -rf "$results" "$results.xml"
  mkdir -p "$results" "$folder/Testing/Temporary"
  if [ "$(id -u)" = 0 ]; then # for what runs as an ordinary user
    chmod -R a+rwX "$results" "$folder/Testing"
    chmod a+rwx "$logs"
  fi
  GTEST_OUTPUT=xml:$results/ "${run_as[@]}" ctest --test-dir "$folder" -L "^($labels)\$" --no-tests=error \
    --output-on-failure --timeout 1200 --output-junit "$results.xml" "$@" || code=$?
  "$root/.ci/results" gtest "$results" "$results.xml"
  return "$code"
}

step_doors() {
  need_web_packages # the page's imports are judged by its own compilers
  "$root/.ci/doors" --self-test
  "$root/.ci/doors"
}

step_shell() {
  cd "$root"
  local scripts
  mapfile -d '' scripts < <(sources | xargs -0 grep -lZE -m1 '^#!/usr/bin/env (bash|sh)$')
  shellcheck -x -a "${scripts[@]}"
  mapfile -d '' scripts < <(sources | xargs -0 grep -lZE -m1 '^#!/usr/bin/env python3$')
  python3 - "${scripts[@]}" <<'PYTHON'
import sys
for name in sys.argv[1:]:
    compile(open(name, encoding="utf-8").read(), name, "exec")
PYTHON
}

step_format() {
  cd "$root"
  sources '*.cpp' '*.hpp' | xargs -0 -r clang-format --dry-run -Werror ||
    { say "./test --fix brings them into format" && return 1; }
}

step_readme() { "$root/.ci/readme"; }

step_web() {
  local code=0 results=$logs/vitest.json
  need_web_packages
  cd "$root/web"
  if npm run check; then say "ok - page types"; else say "not ok - page types" && code=1; fi
  if npm run lint; then say "ok - page lint"; else say "not ok - page lint" && code=1; fi
  rm -f "$results"
  npx vitest run --reporter=default --reporter=json --outputFile.json="$results" || code=$?
  "$root/.ci/results" vitest "$results"
  return "$code"
}

step_build() {
  build_product
  ninja_build "$build"
  built_well
}

step_programs() {
  build_product
  ninja_build "$build" rooms roverd simulated socketcan_test # the last one runs on a kernel with CAN
  built_well
}

built_well() {
  "$root/.ci/doors" --built "$build"
  "$root/.ci/hardened" "$bin/roverd" "$bin/roverd-sim" "$bin/roverd-study"
}

step_unit() {
  local run_as=(ordinary)
  run_ctest "$build" 'unit|loop' "$logs/unit" -j "$jobs"
}

step_simulated() {
  local run_as=(ordinary)
  run_ctest "$build" simulated "$logs/simulated" -j "$jobs"
}

step_api() { run_ctest "$build" api "$logs/api"; }

# side_by_side NAME…: command tests that mostly watch a robot drive, each of which takes a third of a
# core; each output in one piece. A server's processor may be somebody else's for seconds, so that a robot
# stops and says so: there what fails once of those that drive is tried once more, which is told.
side_by_side() {
  local code=0 name
  export -f ordinary say
  export root build logs
  # shellcheck disable=SC2016
  printf '%s\0' "$@" | xargs -0 -n 1 -P $((jobs + 1)) bash -euo pipefail -c \
    'case " program rows see marks place known_places tag_dock solid_map " in
       *" $1 "*) [ "${CI:-}" != true ] || export SECOND_TRY=yes ;;
     esac
     ordinary python3 "$root/tests/command/$1_test.py" >"$logs/command-$1.log" 2>&1' beside || code=$?
  for name in "$@"; do cat "$logs/command-$name.log"; done
  return "$code"
}

step_command() {
  local code=0 name
  "$root/tests/command/packages_test" || code=$?
  for name in decode arguments run control ntrip power_cut stop storage study drill gpsd memory tls abuse secrets peers lan; do
    ordinary python3 "$root/tests/command/${name}_test.py" || code=$?
  done
  # The longest first.
  side_by_side program rows see marks place known_places tag_dock resume learned bad_sight solid_map map ||
    code=$?
  ordinary python3 "$root/tests/soak/kills" --count 25 || code=$?
  return "$code"
}

step_vehicles() { python3 "$root/tests/command/vehicles_test.py"; }

step_real() {
  local code=0
  python3 "$root/tests/command/real_data_test.py" || code=$?
  python3 "$root/tests/command/second_decoder_test.py" || code=$?
  return "$code"
}

# The kernel within a process is slow where the processor is not its own: once more, and told.
step_can() {
  local code=0
  "$root/tests/can/run" >"$logs/can-first.log" 2>&1 || code=$?
  if [ "$code" = 0 ] || [ "${CI:-}" != true ]; then
    cat "$logs/can-first.log"
    return "$code"
  fi
  grep -q '^not ok - ' "$logs/can-first.log" || say "again - the CAN tests ended with $code and named no case"
  sed 's/^\(ok\|skip\) - /# \1 - /; s/^not ok - /again - /' "$logs/can-first.log"
  "$root/tests/can/run"
}

step_page() {
  local code=0 results=$logs/playwright.json
  need_web_packages
  cd "$root/web"
  rm -f "$results" "$results.alone"
  PLAYWRIGHT_JSON_OUTPUT_NAME=$results npm run test:page -- --reporter=list,json \
    --grep-invert @alone || code=$?
  # What needs the processor itself.
  PLAYWRIGHT_JSON_OUTPUT_NAME=$results.alone npm run test:page -- --reporter=list,json \
    --grep @alone --workers 1 || code=$?
  "$root/.ci/results" playwright "$results"
  "$root/.ci/results" playwright "$results.alone"
  return "$code"
}

# touched PATTERN…: tracked files of these kinds. With TOUCHED=yes only those that the work at hand
# changes: since it left main, or in the last commit where that is main itself.
touched() {
  local since
  [ "${TOUCHED:-}" = yes ] || { git -C "$root" ls-files -- "$@" && return; }
  since=$(git -C "$root" merge-base HEAD origin/main 2>/dev/null) || since=
  [ -n "$since" ] && [ "$since" != "$(git -C "$root" rev-parse HEAD)" ] ||
    since=$(git -C "$root" rev-parse --verify -q HEAD~1) ||
    { git -C "$root" ls-files -- "$@" && return; } # a clone without a past
  git -C "$root" diff --name-only --diff-filter=d "$since" -- "$@"
}

step_mutate() {
  local changed
  mapfile -t changed < <(touched drivers/gate tests/unit/gate server/base .ci/mutate)
  [ "${#changed[@]}" -gt 0 ] || { say "ok - nothing of the gate was changed" && return; }
  configure "$build" "${release[@]}"
  "$root/.ci/mutate" --lines "$build"
}

tidy_most=30 # of a change: about five minutes

step_tidy() {
  local files
  cd "$root"
  mapfile -t files < <(touched 'server/*.cpp' 'drivers/*.cpp')
  [ "${#files[@]}" -gt 0 ] || { say "ok - no source was changed" && return; }
  if [ "${TOUCHED:-}" = yes ] && [ "${#files[@]}" -gt "$tidy_most" ]; then
    say "of ${#files[@]} changed files the $tidy_most longest; all of them: ./test tidy"
    mapfile -t files < <(wc -l "${files[@]}" | grep -v ' total$' | sort -rn |
      head -n "$tidy_most" | awk '{ print $2 }')
  fi
  build_product # for what is generated
  # One by one, as they are written.
  configure "$build/tidy" -DCMAKE_BUILD_TYPE=Release -DCMAKE_UNITY_BUILD=OFF
  # Only the warnings' own lines: run-clang-tidy prints each command as well.
  local code=0
  run-clang-tidy-14 -p "$build/tidy" -quiet -j "$jobs" "${files[@]/#/$root/}" \
    >"$logs/tidy-all.log" 2>&1 || code=$?
  grep -vE '^(clang-tidy|[0-9]+ warnings? (generated|treated)|$)' "$logs/tidy-all.log" || true
  [ "$code" = 0 ] && say "ok - ${#files[@]} files"
  return "$code"
}

# One tree, by clang, for the address sanitizer's tests and for the fuzz targets: they share every room.
by_clang() {
  configure "$build/clang" -DCMAKE_CXX_COMPILER=clang++ -DCMAKE_BUILD_TYPE=Sanitized \
    -DCMAKE_CXX_FLAGS="-O1 -g1" -DROVERD_FUZZ=ON "${in_groups[@]}"
}

asan_tree() {
  local targets=(all)
  [ "${ONCE:-}" != yes ] || targets=(sanitized fuzz)
  by_clang
  ninja_build "$build/clang" "${targets[@]}"
}

step_asan() {
  local run_as=(ordinary) labels='unit|loop|api'
  [ "${ONCE:-}" != yes ] || labels=sanitized
  asan_tree
  ASAN_OPTIONS=detect_stack_use_after_return=1:strict_string_checks=1 \
    UBSAN_OPTIONS=print_stacktrace=1 run_ctest "$build/clang" "$labels" "$logs/asan" -j "$jobs"
}

threaded='^(base|services|supervise|net|store|link|robot|net_socket|api_socket)_test$'

tsan_tree() {
  local targets
  # Asio uses fences, of which GCC warns that the thread sanitizer does not see them.
  configure "$build/tsan" -DCMAKE_BUILD_TYPE=Sanitized -DCMAKE_CXX_FLAGS="-O1 -g1 -Wno-tsan" \
    "${in_groups[@]}" -DROVERD_SANITIZE=thread
  cmake "$build/tsan" # knows tests that are new
  mapfile -t targets < <(ctest --test-dir "$build/tsan" -N -R "$threaded" |
    sed -n 's/^ *Test *#[0-9]*: //p')
  ninja_build "$build/tsan" roverd roverd-sim "${targets[@]}"
}

step_tsan() {
  tsan_tree
  # Without address randomisation: newer kernels' layout is unknown to this sanitizer's runtime.
  TSAN_OPTIONS=halt_on_error=1:second_deadlock_stack=1 \
    setarch -R ctest --test-dir "$build/tsan" -j "$jobs" -R "$threaded" --no-tests=error --output-on-failure \
    --timeout 600 --output-junit "$logs/tsan.xml"
  "$root/.ci/results" ctest "$logs/tsan.xml"
}

# The trees of the sanitizers, built while steps before them mostly wait: for sockets, for simulated
# robots. Of the idle class, so that a robot that wants the processor has it at once. What goes wrong
# here is told by the step that builds the same once more.
waiting_steps=' api command real '
starving_steps=' vehicles can page ' # no file more is compiled beside them: what else runs is felt there
trees_ahead() {
  local step
  chrt --idle --pid 0 $BASHPID || true
  for step in "$@"; do
    case $step in
      asan) asan_tree ;;
      tsan) tsan_tree ;;
    esac || true
  done
}

fuzz_one() {
  local name found log
  name=$(basename "$1" _fuzz)
  log=$logs/fuzz-$name.log
  found=$build/clang/corpus/$name # what it learns is kept for the next run
  mkdir -p "$found" "$root/tests/data/fuzz/$name"
  if "$1" -max_total_time="${FUZZ_SECONDS:-5}" -timeout=10 -rss_limit_mb=2048 -verbosity=0 \
    -print_final_stats=1 -artifact_prefix="$logs/$name-" "$found" "$root/tests/data/fuzz/$name" \
    >"$log" 2>&1; then
    say "ok - fuzz $name"
  else
    tail -n 30 "$log"
    say "not ok - fuzz $name: the input that breaks it is $logs/$name-…"
    return 1
  fi
}

step_fuzz() {
  by_clang
  ninja_build "$build/clang" fuzz
  export -f fuzz_one say
  export build root logs
  # shellcheck disable=SC2016
  printf '%s\0' "$build/clang/bin/"*_fuzz |
    xargs -0 -n 1 -P "$jobs" bash -euo pipefail -c 'fuzz_one "$1"' fuzz
}

build_benchmarks() {
  build_product
  cmake -DROVERD_BENCH=ON "$build"
  ninja_build "$build" benchmarks roverd-load
}

step_figures() {
  build_benchmarks
  "$root/tests/bench/run" --short
}

step_soak() {
  local code=0
  build_product
  python3 "$root/tests/soak/kills" --count "${SOAK_KILLS:-1000}" || code=$?
  python3 "$root/tests/soak/soak" --minutes "${SOAK_MINUTES:-20}" || code=$?
  return "$code"
}

step_bench() {
  build_benchmarks
  "$root/tests/bench/run"
}
